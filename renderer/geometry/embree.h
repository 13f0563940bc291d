#pragma once
// Embree 3 or 4 behind one face. Included by accel.cpp only.
//
// Packets are never flagged coherent: Embree 3.13's any-hit packets then read memory that nothing
// wrote and may not come back (docs/decisions/002-no-coherent-packets.md).

#if TESSERA_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace tessera::embree {

// The per-call context: Embree 3 knows RTCIntersectContext, Embree 4 a query context plus
// arguments.
#if TESSERA_EMBREE >= 4
struct Context : RTCRayQueryContext {
    Context() { rtcInitRayQueryContext(this); }
};
struct IntersectArgs : RTCIntersectArguments {
    explicit IntersectArgs(Context& query) {
        rtcInitIntersectArguments(this);
        context = &query;
    }
};
struct OccludedArgs : RTCOccludedArguments {
    explicit OccludedArgs(Context& query) {
        rtcInitOccludedArguments(this);
        context = &query;
    }
};
inline void intersect16(const int* valid, RTCScene s, Context& c, RTCRayHit16* r) {
    IntersectArgs args(c);
    rtcIntersect16(valid, s, r, &args);
}
inline void intersect1(RTCScene s, Context& c, RTCRayHit* r) {
    IntersectArgs args(c);
    rtcIntersect1(s, r, &args);
}
inline void occluded16(const int* valid, RTCScene s, Context& c, RTCRay16* r) {
    OccludedArgs args(c);
    rtcOccluded16(valid, s, r, &args);
}
inline void occluded1(RTCScene s, Context& c, RTCRay* r) {
    OccludedArgs args(c);
    rtcOccluded1(s, r, &args);
}
#else
struct Context : RTCIntersectContext {
    Context() { rtcInitIntersectContext(this); }
};
inline void intersect16(const int* valid, RTCScene s, Context& c, RTCRayHit16* r) {
    rtcIntersect16(valid, s, &c, r);
}
inline void intersect1(RTCScene s, Context& c, RTCRayHit* r) { rtcIntersect1(s, &c, r); }
inline void occluded16(const int* valid, RTCScene s, Context& c, RTCRay16* r) {
    rtcOccluded16(valid, s, &c, r);
}
inline void occluded1(RTCScene s, Context& c, RTCRay* r) { rtcOccluded1(s, &c, r); }
#endif
inline Context* context_of(const RTCFilterFunctionNArguments* a) {
    return static_cast<Context*>(a->context);
}

}  // namespace tessera::embree
