#include "renderer/geometry/subdivide.h"

#include <atomic>
#include <vector>

#include "renderer/geometry/embree.h"

namespace tessera {
namespace {

RTCSubdivisionMode mode_of(SubdivisionBoundary boundary) {
    switch (boundary) {
        case SubdivisionBoundary::smooth:
            return RTC_SUBDIVISION_MODE_SMOOTH_BOUNDARY;
        case SubdivisionBoundary::pin:
            return RTC_SUBDIVISION_MODE_PIN_BOUNDARY;
        case SubdivisionBoundary::pin_corners:
            break;
    }
    return RTC_SUBDIVISION_MODE_PIN_CORNERS;
}

bool degenerate(Vec3f n, Vec3f ds, Vec3f dt) {
    return !(length2(n) > 1e-8f * length2(ds) * length2(dt));
}

}  // namespace

struct LimitSurface::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RTCGeometry geometry = nullptr;
    std::vector<std::uint32_t> face_size, uv_index;
    std::vector<float> uvs;  // two more than there are: Embree reads 16 bytes
    std::atomic<std::int64_t> bytes{0};

    ~Impl() {
        if (geometry) rtcReleaseGeometry(geometry);
        if (scene) rtcReleaseScene(scene);
        if (device) rtcReleaseDevice(device);
    }

    void check() const {
        const RTCError error = rtcGetDeviceError(device);
        if (error == RTC_ERROR_NONE) return;
        const bool memory = error == RTC_ERROR_OUT_OF_MEMORY;
        throw Error(memory ? ExitCode::memory : ExitCode::bug,
                    "embree: subdivision: error " + std::to_string(error));
    }

    void buffer(RTCBufferType type, unsigned slot, RTCFormat format, const void* data,
                std::size_t stride, std::size_t count) const {
        rtcSetSharedGeometryBuffer(geometry, type, slot, format, data, 0, stride, count);
    }

    void build(const MeshDesc& mesh, const Cage& cage, int threads, const std::string& isa) {
        std::string config = "threads=" + std::to_string(threads);
        if (!isa.empty()) config += ",isa=" + isa;
        device = rtcNewDevice(config.c_str());
        if (!device) throw Error(ExitCode::bug, "embree: no device for '" + config + "'");
        rtcSetDeviceMemoryMonitorFunction(
            device,
            [](void* self, ssize_t n, bool) { return static_cast<Impl*>(self)->bytes += n, true; },
            this);
        geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_SUBDIVISION);
        for (const Cage::Face& f : cage.faces) face_size.push_back(f.corners);
        buffer(RTC_BUFFER_TYPE_FACE, 0, RTC_FORMAT_UINT, face_size.data(), sizeof(std::uint32_t),
               face_size.size());
        buffer(RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT, cage.place.data(), sizeof(std::uint32_t),
               cage.place.size());
        buffer(RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, cage.places.data(), sizeof(Vec3f),
               cage.places.size() - 1);
        rtcSetGeometrySubdivisionMode(geometry, 0, mode_of(mesh.subdivision.boundary));
        if (!mesh.uvs.empty()) add_uvs(mesh, cage);
        rtcSetGeometryTessellationRate(geometry, 1);
        rtcCommitGeometry(geometry);
        scene = rtcNewScene(device);  // only a scene's commit makes ready to interpolate
        rtcAttachGeometry(scene, geometry);
        rtcCommitScene(scene);
        check();
    }

    // An entry that more faces share than can be evaluated: each gets its own.
    void split_uvs() {
        std::vector<std::uint32_t> faces(uvs.size() / 2, 0);
        for (const std::uint32_t i : uv_index) ++faces[i];
        for (std::uint32_t& i : uv_index) {
            if (faces[i] <= kMaxValence) continue;
            uvs.insert(uvs.end(), {uvs[2 * std::size_t(i)], uvs[2 * std::size_t(i) + 1]});
            i = static_cast<std::uint32_t>(uvs.size() / 2) - 1;
            faces.push_back(0);
        }
    }

    // Smooth inside of a chart, its outline kept straight: charts meet as they did on the cage.
    void add_uvs(const MeshDesc& mesh, const Cage& cage) {
        for (const std::uint32_t corner : cage.source) uv_index.push_back(uv_entry(mesh, corner));
        uvs = mesh.uvs;
        split_uvs();
        const std::size_t count = uvs.size() / 2;
        uvs.insert(uvs.end(), {0.0f, 0.0f});
        rtcSetGeometryTopologyCount(geometry, 2);
        rtcSetGeometryVertexAttributeCount(geometry, 1);
        buffer(RTC_BUFFER_TYPE_INDEX, 1, RTC_FORMAT_UINT, uv_index.data(), sizeof(std::uint32_t),
               uv_index.size());
        buffer(RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, RTC_FORMAT_FLOAT2, uvs.data(),
               2 * sizeof(float), count);
        rtcSetGeometryVertexAttributeTopology(geometry, 0, 1);
        rtcSetGeometrySubdivisionMode(geometry, 1, RTC_SUBDIVISION_MODE_PIN_BOUNDARY);
    }
};

LimitSurface::LimitSurface(const MeshDesc& mesh, const Cage& cage, int threads,
                           const std::string& isa)
    : mesh_(mesh), cage_(cage) {
    if (mesh.subdivision.scheme != Subdivision::catmull_clark) return;
    impl_ = std::make_unique<Impl>();
    impl_->build(mesh, cage, threads, isa);
}

LimitSurface::~LimitSurface() = default;

std::int64_t LimitSurface::bytes() const noexcept {
    if (!impl_) return 0;
    return impl_->bytes.load() +
           static_cast<std::int64_t>((impl_->face_size.capacity() + impl_->uv_index.capacity()) *
                                         sizeof(std::uint32_t) +
                                     impl_->uvs.capacity() * sizeof(float));
}

LimitPoint LimitSurface::at(const DiceSite& site) const noexcept {
    if (!impl_) return straight(site);
    LimitPoint out = limit(site);
    Vec3f n = cross(out.ds, out.dt);
    if (degenerate(n, out.ds, out.dt)) {
        // Where derivatives vanish, those of a point a little further in.
        const auto in = [](float x) { return x + (0.5f - x) * 1e-2f; };
        const LimitPoint near = limit({site.face, site.patch, in(site.s), in(site.t)});
        out.ds = near.ds, out.dt = near.dt;
        n = cross(out.ds, out.dt);
    }
    const float l = length(n);
    out.n = l > 0.0f ? n / l : Vec3f{0, 0, 0};
    return out;
}

LimitPoint LimitSurface::limit(const DiceSite& site) const noexcept {
    // Embree's name for a point of a face that is no quad: the patch in the whole part.
    const bool quad = cage_.faces[site.face].corners == 4;
    const float u = quad ? site.s : 2.0f * static_cast<float>(site.patch) + site.s + 0.5f;
    const float v = quad ? site.t : site.t + 0.5f;
    LimitPoint out;
    alignas(16) float p[4], du[4], dv[4];
    rtcInterpolate1(impl_->geometry, site.face, u, v, RTC_BUFFER_TYPE_VERTEX, 0, p, du, dv, 3);
    out.p = {p[0], p[1], p[2]};
    out.ds = {du[0], du[1], du[2]};
    out.dt = {dv[0], dv[1], dv[2]};
    if (mesh_.uvs.empty()) return out;
    rtcInterpolate1(impl_->geometry, site.face, u, v, RTC_BUFFER_TYPE_VERTEX_ATTRIBUTE, 0, p, du,
                    dv, 2);
    out.uv = {p[0], p[1]};
    out.uv_ds = {du[0], du[1]};
    out.uv_dt = {dv[0], dv[1]};
    return out;
}

LimitPoint LimitSurface::straight(const DiceSite& site) const noexcept {
    const Cage::Face& f = cage_.faces[site.face];
    const CornerWeights at = corner_weights(f.corners, site.patch, site.s, site.t);
    const auto slope = [&](CornerWeights high, CornerWeights low) {
        for (int k = 0; k < 4; ++k) high.w[k] -= low.w[k];
        return high;
    };
    const auto weights = [&](float s, float t) {
        return corner_weights(f.corners, site.patch, s, t);
    };
    const CornerWeights along_s = slope(weights(1, site.t), weights(0, site.t)),
                        along_t = slope(weights(site.s, 1), weights(site.s, 0));
    LimitPoint out;
    Vec3f normal;
    for (std::uint32_t k = 0; k < f.corners; ++k) {
        const Vec3f p = cage_.at(f, k);
        out.p += p * at.w[k];
        out.ds += p * along_s.w[k];
        out.dt += p * along_t.w[k];
        const std::uint32_t corner = cage_.source[f.first + k];
        if (!mesh_.normals.empty()) {
            const float* n = &mesh_.normals[3 * std::size_t(normal_entry(mesh_, corner))];
            normal += Vec3f{n[0], n[1], n[2]} * at.w[k];
        }
        if (!mesh_.uvs.empty()) {
            const float* t = &mesh_.uvs[2 * std::size_t(uv_entry(mesh_, corner))];
            const Vec2f uv{t[0], t[1]};
            out.uv = out.uv + uv * at.w[k];
            out.uv_ds = out.uv_ds + uv * along_s.w[k];
            out.uv_dt = out.uv_dt + uv * along_t.w[k];
        }
    }
    if (!(length2(normal) > 1e-12f)) normal = cross(out.ds, out.dt);
    const float l = length(normal);
    out.n = l > 0.0f ? normal / l : Vec3f{0, 0, 0};
    return out;
}

}  // namespace tessera
