#pragma once
// Embree 3 or 4 behind one face. Included by accel.cpp and replay.cpp only.

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
    IntersectArgs(Context& context, bool coherent) {
        rtcInitIntersectArguments(this);
        this->context = &context;
        flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
struct OccludedArgs : RTCOccludedArguments {
    OccludedArgs(Context& context, bool coherent) {
        rtcInitOccludedArguments(this);
        this->context = &context;
        flags = coherent ? RTC_RAY_QUERY_FLAG_COHERENT : RTC_RAY_QUERY_FLAG_INCOHERENT;
    }
};
inline void intersect16(const int* valid, RTCScene s, Context& c, RTCRayHit16* r, bool coherent) {
    IntersectArgs args(c, coherent);
    rtcIntersect16(valid, s, r, &args);
}
inline void intersect1(RTCScene s, Context& c, RTCRayHit* r) {
    IntersectArgs args(c, false);
    rtcIntersect1(s, r, &args);
}
inline void occluded16(const int* valid, RTCScene s, Context& c, RTCRay16* r, bool coherent) {
    OccludedArgs args(c, coherent);
    rtcOccluded16(valid, s, r, &args);
}
inline void occluded1(RTCScene s, Context& c, RTCRay* r) {
    OccludedArgs args(c, false);
    rtcOccluded1(s, r, &args);
}
inline Context* context_of(const RTCFilterFunctionNArguments* a) {
    return static_cast<Context*>(a->context);
}
#else
struct Context : RTCIntersectContext {
    Context() { rtcInitIntersectContext(this); }
};
inline RTCIntersectContextFlags coherence(bool coherent) {
    return coherent ? RTC_INTERSECT_CONTEXT_FLAG_COHERENT : RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT;
}
inline void intersect16(const int* valid, RTCScene s, Context& c, RTCRayHit16* r, bool coherent) {
    c.flags = coherence(coherent);
    rtcIntersect16(valid, s, &c, r);
}
inline void intersect1(RTCScene s, Context& c, RTCRayHit* r) { rtcIntersect1(s, &c, r); }
inline void occluded16(const int* valid, RTCScene s, Context& c, RTCRay16* r, bool coherent) {
    c.flags = coherence(coherent);
    rtcOccluded16(valid, s, &c, r);
}
inline void occluded1(RTCScene s, Context& c, RTCRay* r) { rtcOccluded1(s, &c, r); }
inline Context* context_of(const RTCFilterFunctionNArguments* a) {
    return static_cast<Context*>(a->context);
}
#endif

}  // namespace tessera::embree
