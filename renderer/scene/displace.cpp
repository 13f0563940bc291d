#include "renderer/scene/displace.h"

#include <algorithm>
#include <cmath>

#include "renderer/scene/mesh_normals.h"

namespace tessera {
namespace {

constexpr std::uint32_t kNone = 0xffffffffu;
constexpr int kChunk = 4096;

class Displacer {
public:
    Displacer(const DisplaceInput& in, Diced&& diced, DisplaceReport& report)
        : in_(in),
          diced_(std::move(diced)),
          report_(report),
          unit_(unit_of(in.to_world)),
          moves_(std::any_of(in.by_slot.begin(), in.by_slot.end(),
                             [](const Displacement* d) { return d != nullptr; })) {}

    MeshDesc run(Workers& workers) {
        evaluate(workers);
        move();
        turn_quads();
        copy_faces();
        if (moves_) take_normals();
        return std::move(out_);
    }

private:
    std::size_t count() const { return diced_.sites.size(); }

    void evaluate(Workers& workers) {
        surface_.resize(count());
        offset_.resize(moves_ ? count() : 0);
        out_.normals.resize(3 * count());
        if (!in_.mesh.uvs.empty()) out_.uvs.resize(2 * count());
        if (!in_.mesh.colors.empty()) out_.colors.resize(3 * count());
        const int chunks = static_cast<int>((count() + kChunk - 1) / kChunk);
        workers.for_each(chunks, [&](int c) {
            const std::size_t first = std::size_t(c) * kChunk;
            for (std::size_t v = first; v < std::min(first + kChunk, count()); ++v) evaluate(v);
        });
    }

    void evaluate(std::size_t v) {
        const DiceSite& site = diced_.sites[v];
        const LimitPoint at = in_.surface.at(site);
        surface_[v] = at.p;
        put(out_.normals, v, at.n);
        if (!out_.uvs.empty()) out_.uvs[2 * v] = at.uv.x, out_.uvs[2 * v + 1] = at.uv.y;
        const Color color = out_.colors.empty() ? Color(1.0f) : color_at(site);
        if (!out_.colors.empty()) put(out_.colors, v, color);
        if (moves_) offset_[v] = offset_at(site, at, color);
    }

    static void put(std::vector<float>& to, std::size_t v, Vec3f x) {
        to[3 * v] = x.x, to[3 * v + 1] = x.y, to[3 * v + 2] = x.z;
    }

    const Cage::Face& face_of(const DiceSite& site) const { return in_.cage.faces[site.face]; }

    Color color_at(const DiceSite& site) const {
        const Cage::Face& f = face_of(site);
        const CornerWeights at = corner_weights(f.corners, site.patch, site.s, site.t);
        Color sum;
        for (std::uint32_t k = 0; k < f.corners; ++k) {
            const std::size_t i = in_.mesh.position_index[in_.cage.source[f.first + k]];
            const float* c = &in_.mesh.colors[3 * i];
            sum += Color{c[0], c[1], c[2]} * at.w[k];
        }
        return sum;
    }

    // How far apart neighbours are, on the surface and in texture coordinates: from the cage, whose
    // sides do not vanish where derivatives do.
    void footprint(const DiceSite& site, ShadeInput& in) const {
        const Cage::Face& f = face_of(site);
        const PatchRates rates = patch_rates(in_.cage, in_.rates, site);
        const float pieces =
            static_cast<float>(std::min(rates.s, rates.t) * (f.corners == 3 ? 2 : 1));
        float length_2 = 0, uv_2 = 0;
        for (std::uint32_t k = 0; k < f.corners; ++k) {
            const std::uint32_t n = in_.cage.next(f, k);
            length_2 = std::max(length_2, length2(in_.cage.at(f, n) - in_.cage.at(f, k)));
            if (in_.mesh.uvs.empty()) continue;
            const float* a =
                &in_.mesh.uvs[2 * std::size_t(uv_entry(in_.mesh, in_.cage.source[f.first + k]))];
            const float* b =
                &in_.mesh.uvs[2 * std::size_t(uv_entry(in_.mesh, in_.cage.source[f.first + n]))];
            uv_2 = std::max(uv_2, sqr(b[0] - a[0]) + sqr(b[1] - a[1]));
        }
        in.p_width = std::sqrt(length_2) / pieces * static_cast<float>(unit_);
        in.uv_width = std::sqrt(uv_2) / pieces;
    }

    // The tangent along the texture's u, the other towards its v.
    static Frame tangent_frame(const LimitPoint& at) {
        const float area = at.uv_ds.x * at.uv_dt.y - at.uv_dt.x * at.uv_ds.y;
        const Vec3f along_u = (at.ds * at.uv_dt.y - at.dt * at.uv_ds.y) * (area < 0 ? -1.0f : 1.0f);
        const float l = length(along_u);
        Frame f = frame_along(at.n, l > 0.0f ? along_u / l : along_u);
        if (area < 0.0f) f.t = -f.t;
        return f;
    }

    // In units of the mesh.
    Vec3f offset_at(const DiceSite& site, const LimitPoint& at, Color color) const {
        const std::uint32_t source = face_of(site).source;
        const std::uint32_t slot =
            in_.mesh.face_material.empty() ? 0 : in_.mesh.face_material[source];
        const Displacement* displacement = in_.by_slot[slot];
        if (!displacement) return {};
        ShadeInput in;
        in.uv = at.uv;
        in.vertex_color = color;
        const Vec3d p = Vec3d(at.p) + in_.cage.origin;
        in.p_object = Vec3f(p);
        in.p_world = Vec3f(in_.to_world.point(p));
        const Vec3d n = in_.to_world.normal(Vec3d(at.n));
        const double l = length(n);
        in.n = l > 0 ? Vec3f(n / l) : at.n;
        const Frame tangent = tangent_frame(at);
        in.dpdu = Vec3f(in_.to_world.vector(Vec3d(tangent.s)));
        in.dpdv = Vec3f(in_.to_world.vector(Vec3d(tangent.t)));
        in.handed = dot(cross(tangent.s, tangent.t), tangent.n) < 0.0f ? -1.0f : 1.0f;
        in.object_scale = static_cast<float>(1.0 / unit_);
        footprint(site, in);
        const Vec3f moved = displacement->offset(in, tangent, in_.textures);
        return moved * static_cast<float>(1.0 / unit_);
    }

    // The mean of what is asked of a place by all that meet there.
    void move() {
        std::vector<std::uint32_t> first(diced_.places, kNone);
        std::vector<Vec3f> sum(moves_ ? diced_.places : 0);
        std::vector<float> shares(moves_ ? diced_.places : 0);
        for (std::size_t v = 0; v < count(); ++v) {
            const std::uint32_t place = diced_.place[v];
            if (first[place] == kNone) first[place] = static_cast<std::uint32_t>(v);
            if (!moves_) continue;
            Vec3f moved = offset_[v];
            if (!is_finite(moved)) {
                ++report_.non_finite;
                moved = {};
            }
            const double far = length(Vec3d(moved));
            if (far > report_.farthest)
                report_.farthest = far, report_.farthest_face = diced_.sites[v].face;
            sum[place] += moved;
            shares[place] += 1.0f;
        }
        offset_ = {};
        out_.positions.resize(3 * count());
        for (std::size_t v = 0; v < count(); ++v) {
            const std::uint32_t place = diced_.place[v];
            const Vec3d before = Vec3d(surface_[first[place]]) + in_.cage.origin;
            Vec3d p = before;
            if (moves_) p = p + Vec3d(sum[place] / shares[place]);
            report_.before.add(before);
            report_.after.add(p);
            out_.positions[3 * v] = p.x, out_.positions[3 * v + 1] = p.y;
            out_.positions[3 * v + 2] = p.z;
        }
        surface_ = {};
    }

    Vec3f position(std::uint32_t v) const {
        const double* p = &out_.positions[3 * std::size_t(v)];
        return Vec3f(Vec3d{p[0], p[1], p[2]} - in_.cage.origin);
    }

    // A quad is traced as two triangles that meet between its second and fourth corner: let that be
    // the shorter way across.
    void turn_quads() {
        for (std::size_t q = 0; q < diced_.quads.size(); q += 4) {
            std::uint32_t* v = &diced_.quads[q];
            const float now = length2(position(v[1]) - position(v[3])),
                        turned = length2(position(v[0]) - position(v[2]));
            if (turned < now) std::rotate(v, v + 1, v + 4);
        }
    }

    void copy_faces() {
        const MeshDesc& mesh = in_.mesh;
        out_.name = mesh.name;
        out_.loc = mesh.loc;
        out_.materials = mesh.materials;
        out_.object_names = mesh.object_names;
        out_.triangles = static_cast<std::uint32_t>(diced_.triangle_face.size());
        out_.quads = static_cast<std::uint32_t>(diced_.quad_face.size());
        const auto spread = [&](const std::vector<std::uint32_t>& per_face,
                                std::vector<std::uint32_t>& to) {
            if (per_face.empty()) return;
            to.reserve(out_.triangles + out_.quads);
            for (const auto* faces : {&diced_.triangle_face, &diced_.quad_face})
                for (const std::uint32_t f : *faces)
                    to.push_back(per_face[in_.cage.faces[f].source]);
        };
        spread(mesh.face_material, out_.face_material);
        spread(mesh.face_object, out_.face_object);
        diced_.triangle_face = diced_.quad_face = {};
        out_.position_index = std::move(diced_.triangles);
        out_.position_index.insert(out_.position_index.end(), diced_.quads.begin(),
                                   diced_.quads.end());
        diced_.quads = {};
    }

    // Across a texture seam the normal is one; across a hard edge of a linear cage it is not.
    void take_normals() {
        const bool smooth = in_.mesh.subdivision.scheme == Subdivision::catmull_clark;
        make_normals(out_, diced_.place, diced_.places, smooth);
    }

    const DisplaceInput& in_;
    Diced diced_;
    DisplaceReport& report_;
    double unit_;
    bool moves_;
    std::vector<Vec3f> surface_, offset_;
    MeshDesc out_;
};

}  // namespace

double unit_of(const Affined& m) { return std::cbrt(std::abs(m.determinant())); }

MeshDesc displaced_mesh(const DisplaceInput& in, Diced&& diced, Workers& workers,
                        DisplaceReport& report) {
    return Displacer(in, std::move(diced), report).run(workers);
}

}  // namespace tessera
