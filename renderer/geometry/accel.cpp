#include "renderer/geometry/accel.h"

#include <immintrin.h>

#include <cstddef>
#include <cstring>
#include <map>
#include <mutex>
#include <new>
#include <vector>

#include "renderer/api/error.h"
#include "renderer/geometry/embree.h"

namespace tessera {
namespace {

static_assert(sizeof(RayPacket) == sizeof(RTCRay16) && sizeof(HitPacket) == sizeof(RTCRayHit16));
static_assert(offsetof(RayPacket, t_max) == offsetof(RTCRay16, tfar));
static_assert(offsetof(RayPacket, id) == offsetof(RTCRay16, id));
static_assert(offsetof(HitPacket, prim) == offsetof(RTCRayHit16, hit.primID));
static_assert(offsetof(HitPacket, inst) == offsetof(RTCRayHit16, hit.instID));

// What a cut-out's filter needs to know of the call it is in.
struct CallContext : embree::Context {
    OpacityTest opacity;
    const std::uint32_t* seeds = nullptr;  // by ray.id
};

void filter_opacity(const RTCFilterFunctionNArguments* args) {
    const auto* call = static_cast<const CallContext*>(embree::context_of(args));
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] != -1) continue;
        Hit hit;
        hit.prim = RTCHitN_primID(args->hit, args->N, i);
        hit.geom = RTCHitN_geomID(args->hit, args->N, i);
        hit.inst = RTCHitN_instID(args->hit, args->N, i, 0);
        hit.u = RTCHitN_u(args->hit, args->N, i);
        hit.v = RTCHitN_v(args->hit, args->N, i);
        const Vec3f ng{RTCHitN_Ng_x(args->hit, args->N, i), RTCHitN_Ng_y(args->hit, args->N, i),
                       RTCHitN_Ng_z(args->hit, args->N, i)};
        const Vec3f d{RTCRayN_dir_x(args->ray, args->N, i), RTCRayN_dir_y(args->ray, args->N, i),
                      RTCRayN_dir_z(args->ray, args->N, i)};
        hit.far_side = dot(ng, d) > 0.0f;
        const std::uint32_t seed = call->seeds[RTCRayN_id(args->ray, args->N, i)];
        if (!call->opacity.stops(call->opacity.scene, hit, d, seed)) args->valid[i] = 0;
    }
}

void expand(LaneMask lanes, int (&valid)[kLanes]) {
    for (int i = 0; i < kLanes; ++i) valid[i] = (lanes >> i) & 1u ? -1 : 0;
}

// Embree reads origin and direction as vectors of four: stored as such, they are forwarded without
// a stall.
void fill(RTCRay& r, const Ray& ray) {
    static_assert(offsetof(RTCRay, tnear) == offsetof(RTCRay, org_x) + 12 &&
                  offsetof(RTCRay, time) == offsetof(RTCRay, dir_x) + 12);
    _mm_store_ps(&r.org_x, _mm_setr_ps(ray.o.x, ray.o.y, ray.o.z, 0.0f));
    _mm_store_ps(&r.dir_x, _mm_setr_ps(ray.d.x, ray.d.y, ray.d.z, 0.0f));
    r.tfar = ray.t_max;
    r.mask = ray.mask, r.id = 0, r.flags = 0;
}

}  // namespace

struct Accel::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    std::map<std::pair<PlacedKind, std::uint32_t>, RTCScene> shape_scenes;
    std::atomic<std::int64_t> bytes{0};
    RTCError error = RTC_ERROR_NONE;
    std::string message;
    std::mutex mutex;  // of the two above: Embree reports from its build threads
    OpacityTest opacity;

    ~Impl() {
        if (scene) rtcReleaseScene(scene);
        for (auto& [key, shape] : shape_scenes) rtcReleaseScene(shape);
        if (device) rtcReleaseDevice(device);
    }

    void open(const AccelOptions& options) {
        std::string config = "threads=" + std::to_string(options.threads);
        if (!options.isa.empty()) config += ",isa=" + options.isa;
        device = rtcNewDevice(config.c_str());
        if (!device) {
            const RTCError why = rtcGetDeviceError(nullptr);
            throw Error(
                why == RTC_ERROR_OUT_OF_MEMORY ? ExitCode::memory : ExitCode::bug,
                "embree: no device for '" + config + "' (error " + std::to_string(why) + ")");
        }
        rtcSetDeviceErrorFunction(
            device,
            [](void* self, RTCError code, const char* text) {
                auto* impl = static_cast<Impl*>(self);
                const std::lock_guard lock(impl->mutex);
                if (impl->error == RTC_ERROR_NONE)
                    impl->error = code, impl->message = text ? text : "";
            },
            this);
        rtcSetDeviceMemoryMonitorFunction(
            device,
            [](void* self, ssize_t n, bool) { return static_cast<Impl*>(self)->bytes += n, true; },
            this);
    }

    void check(const char* what) const {
        if (error == RTC_ERROR_NONE) return;
        const bool memory = error == RTC_ERROR_OUT_OF_MEMORY;
        throw Error(memory ? ExitCode::memory : ExitCode::bug,
                    std::string("embree: ") + what + ": " + message);
    }

    RTCScene new_scene() const {
        RTCScene s = rtcNewScene(device);
        rtcSetSceneFlags(s, RTC_SCENE_FLAG_ROBUST);
        rtcSetSceneBuildQuality(s, RTC_BUILD_QUALITY_MEDIUM);
        return s;
    }

    void attach(RTCScene s, RTCGeometry g, unsigned id, bool camera_visible) const {
        rtcSetGeometryBuildQuality(g, RTC_BUILD_QUALITY_MEDIUM);
        rtcSetGeometryMask(g, camera_visible ? kNone : ~kCameraRays);
        rtcCommitGeometry(g);
        rtcAttachGeometryByID(s, g, id);
        rtcReleaseGeometry(g);
    }

    static void test_opacity(RTCGeometry g) {
        rtcSetGeometryIntersectFilterFunction(g, filter_opacity);
        rtcSetGeometryOccludedFilterFunction(g, filter_opacity);
    }

    RTCGeometry mesh_part(const Mesh& mesh, const MeshPart& part) const {
        RTCGeometry g = rtcNewGeometry(
            device, part.quads ? RTC_GEOMETRY_TYPE_QUAD : RTC_GEOMETRY_TYPE_TRIANGLE);
        const std::size_t corners = part.quads ? 4 : 3;
        rtcSetSharedGeometryBuffer(g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                   mesh.vertices.data(), 0, mesh.stride * sizeof(float),
                                   mesh.vertex_count());
        rtcSetSharedGeometryBuffer(
            g, RTC_BUFFER_TYPE_INDEX, 0, part.quads ? RTC_FORMAT_UINT4 : RTC_FORMAT_UINT3,
            mesh.index.data(), mesh.corner(part.first_face) * sizeof(std::uint32_t),
            corners * sizeof(std::uint32_t), part.faces);
        if (part.cutout) test_opacity(g);
        return g;
    }

    RTCGeometry sphere(const Sphere& s) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
        auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
        if (v) v[0] = s.center.x, v[1] = s.center.y, v[2] = s.center.z, v[3] = s.radius;
        if (s.cutout) test_opacity(g);
        return g;
    }

    RTCGeometry disc(const Disc& d) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_ORIENTED_DISC_POINT);
        auto* v = static_cast<float*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT4, 4 * sizeof(float), 1));
        auto* n = static_cast<float*>(rtcSetNewGeometryBuffer(
            g, RTC_BUFFER_TYPE_NORMAL, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), 1));
        if (v) v[0] = d.center.x, v[1] = d.center.y, v[2] = d.center.z, v[3] = d.radius;
        if (n) n[0] = d.normal.x, n[1] = d.normal.y, n[2] = d.normal.z;
        if (d.cutout) test_opacity(g);
        return g;
    }

    // Attaches every geometry of a shape from id `first`; returns how many there were.
    unsigned attach_shape(const Geometry& geometry, const Placement& placed, RTCScene s,
                          unsigned first) const {
        switch (placed.kind) {
            case PlacedKind::sphere:
                attach(s, sphere(geometry.spheres[placed.shape]), first, placed.camera_visible);
                return 1;
            case PlacedKind::disc:
                attach(s, disc(geometry.discs[placed.shape]), first, placed.camera_visible);
                return 1;
            case PlacedKind::mesh:
                break;
        }
        const Mesh& mesh = geometry.meshes[placed.shape];
        unsigned id = first;
        for (const MeshPart& part : mesh.parts)
            attach(s, mesh_part(mesh, part), id++, placed.camera_visible);
        return id - first;
    }

    RTCScene shape_scene(const Geometry& geometry, const Placement& placed) {
        RTCScene& s = shape_scenes[{placed.kind, placed.shape}];
        if (!s) {
            s = new_scene();
            attach_shape(geometry, placed, s, 0);
            rtcCommitScene(s);
            check("build");
        }
        return s;
    }

    RTCGeometry instance(RTCScene of, const Affinef& m) const {
        RTCGeometry g = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(g, of);
        const float columns[12] = {m.x.x, m.x.y, m.x.z, m.y.x, m.y.y, m.y.z,
                                   m.z.x, m.z.y, m.z.z, m.p.x, m.p.y, m.p.z};
        rtcSetGeometryTransform(g, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        return g;
    }

    static std::string isa_name(RTCDevice, const std::string& asked) {
        if (!asked.empty()) return asked;
        __builtin_cpu_init();
        if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl"))
            return "avx512";
        if (__builtin_cpu_supports("avx2")) return "avx2";
        return __builtin_cpu_supports("avx") ? "avx" : "sse";
    }
};

Accel::Accel(const Geometry& geometry, const AccelOptions& options)
    : impl_(std::make_unique<Impl>()) {
    impl_->open(options);
    impl_->opacity = options.opacity;
    impl_->scene = impl_->new_scene();
    isa_ = Impl::isa_name(impl_->device, options.isa);
    unsigned id = 0;
    for (std::uint32_t i = 0; i < geometry.placements.size(); ++i) {
        const Placement& placed = geometry.placements[i];
        if (placed.instanced) {
            impl_->attach(impl_->scene,
                          impl_->instance(impl_->shape_scene(geometry, placed), placed.to_world),
                          id++, placed.camera_visible);
            slots_.push_back({i, 0});
        } else {
            const unsigned parts = impl_->attach_shape(geometry, placed, impl_->scene, id);
            for (std::uint32_t part = 0; part < parts; ++part) slots_.push_back({i, part});
            id += parts;
        }
        impl_->check("geometry");
    }
    rtcCommitScene(impl_->scene);
    impl_->check("build");
}

Accel::~Accel() = default;

void Accel::intersect(const Ray& ray, std::uint32_t seed, Hit& hit) const noexcept {
    RTCRayHit rh;
    fill(rh.ray, ray);
    rh.hit.geomID = rh.hit.primID = rh.hit.instID[0] = kNone;
    CallContext call;
    call.opacity = impl_->opacity;
    call.seeds = &seed;
    embree::intersect1(impl_->scene, call, &rh);
    hit.prim = rh.hit.primID, hit.geom = rh.hit.geomID, hit.inst = rh.hit.instID[0];
    hit.u = rh.hit.u, hit.v = rh.hit.v, hit.t = rh.ray.tfar;
}

void Accel::intersect(HitPacket& rays, LaneMask lanes,
                      const std::uint32_t (&seeds)[kLanes]) const noexcept {
    alignas(64) int valid[kLanes];
    expand(lanes, valid);
    std::memset(rays.geom, 0xff, sizeof rays.geom);
    std::memset(rays.inst, 0xff, sizeof rays.inst);
    CallContext call;
    call.opacity = impl_->opacity;
    call.seeds = seeds;
    embree::intersect16(valid, impl_->scene, call, reinterpret_cast<RTCRayHit16*>(&rays));
}

bool Accel::occluded(const Ray& ray, std::uint32_t seed) const noexcept {
    RTCRay r;
    fill(r, ray);
    CallContext call;
    call.opacity = impl_->opacity;
    call.seeds = &seed;
    embree::occluded1(impl_->scene, call, &r);
    return r.tfar < 0.0f;
}

LaneMask Accel::occluded(RayPacket& rays, LaneMask lanes,
                         const std::uint32_t (&seeds)[kLanes]) const noexcept {
    alignas(64) int valid[kLanes];
    expand(lanes, valid);
    CallContext call;
    call.opacity = impl_->opacity;
    call.seeds = seeds;
    embree::occluded16(valid, impl_->scene, call, reinterpret_cast<RTCRay16*>(&rays));
    LaneMask blocked = 0;
    for (int i = 0; i < kLanes; ++i) blocked |= static_cast<LaneMask>(rays.t_max[i] < 0.0f) << i;
    return blocked & lanes;
}

std::int64_t Accel::bytes() const noexcept { return impl_->bytes.load(); }

std::string Accel::version() {
    return std::to_string(RTC_VERSION_MAJOR) + "." + std::to_string(RTC_VERSION_MINOR) + "." +
           std::to_string(RTC_VERSION_PATCH);
}

}  // namespace tessera
