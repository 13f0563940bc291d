#include "renderer/scene/subdivision.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

#include <fmt/format.h>

namespace tessera {
namespace {

constexpr double kFarthest = 100;  // that a vertex may be moved, sizes of its mesh

bool is_subdivided(const SceneDesc& desc, const FlatInstance& i) {
    return i.kind == ShapeKind::mesh &&
           desc.meshes[i.index].subdivision.scheme != Subdivision::none;
}

std::vector<int> materials_of(const SceneDesc& desc, const FlatInstance& i) {
    if (i.material >= 0) return {i.material};
    if (i.kind == ShapeKind::sphere) return {desc.spheres[i.index].material};
    if (i.kind == ShapeKind::disc) return {desc.discs[i.index].material};
    return desc.meshes[i.index].materials;
}

void warn_unmoved(const SceneDesc& desc, const FlatInstance& i, int material, Problems& problems) {
    const std::string& name = desc.materials[material].name;
    if (i.kind == ShapeKind::mesh) {
        const MeshDesc& mesh = desc.meshes[i.index];
        problems.warn(mesh.loc, fmt::format("mesh '{}': material '{}' has displacement, which "
                                            "needs subdivision = \"catmull_clark\" or \"linear\" "
                                            "on the mesh; not displaced",
                                            mesh.name, name));
    } else {
        const bool sphere = i.kind == ShapeKind::sphere;
        problems.warn(sphere ? desc.spheres[i.index].loc : desc.discs[i.index].loc,
                      fmt::format("material '{}' has displacement, which {} do not take; not "
                                  "displaced",
                                  name, sphere ? "spheres" : "discs"));
    }
}

std::array<Double3, 2> corners(const Bounds& b) {
    return {Double3{b.lo.x, b.lo.y, b.lo.z}, Double3{b.hi.x, b.hi.y, b.hi.z}};
}

class Subdivider {
public:
    explicit Subdivider(const SubdivisionInput& in) : in_(in), workers_(in.threads) {}

    std::vector<SubdivisionStatistics> run() {
        for (const auto& [mesh, users] : users_by_mesh()) {
            make(mesh, users);
            in_.problems.throw_if_any();
        }
        return std::move(out_);
    }

private:
    using Users = std::vector<std::size_t>;  // instances

    // What displaces an instance: -1 the mesh's own materials, -2 nothing.
    int displaced_by(const FlatInstance& i) const {
        for (const int m : materials_of(in_.desc, i))
            if (m >= 0 && in_.displacements[m].moves()) return i.material;
        return -2;
    }

    // Instances that are moved alike share a mesh; the others get copies of it.
    std::map<int, Users> users_by_mesh() {
        std::map<std::pair<int, int>, int> copies;
        std::map<int, Users> users;
        std::set<int> taken;
        for (std::size_t k = 0; k < in_.instances.size(); ++k) {
            FlatInstance& i = in_.instances[k];
            if (!is_subdivided(in_.desc, i)) continue;
            const auto [copy, is_new] = copies.try_emplace({i.index, displaced_by(i)}, i.index);
            if (is_new && !taken.insert(i.index).second) {
                copy->second = static_cast<int>(in_.desc.meshes.size());
                in_.desc.meshes.push_back(MeshDesc(in_.desc.meshes[i.index]));
            }
            i.index = copy->second;
            users[i.index].push_back(k);
        }
        return users;
    }

    void make(int index, const Users& users) {
        const auto start = std::chrono::steady_clock::now();
        MeshDesc& mesh = in_.desc.meshes[index];
        const SubdivisionDesc sub = mesh.subdivision;
        const Cage cage = make_cage(mesh, sub.scheme == Subdivision::linear);
        if (cage.faces.empty() || !can_evaluate(mesh, cage)) return;
        std::vector<Affined> placements;
        for (const std::size_t k : users) placements.push_back(in_.instances[k].to_world);
        const Affined& first = placements.front();
        const EdgeRates rates = edge_rates(cage, sub, unit_of(first),
                                           nearest_placement(cage, placements, in_.view), in_.view);
        const std::uint64_t triangles = diced_triangles(cage, rates.rates);
        if (triangles > static_cast<std::uint64_t>(sub.max_triangles)) {
            in_.problems.error(
                sub.loc,
                fmt::format("mesh '{}': subdivision would make {} triangles, at most {} are "
                            "allowed (subdivision_max_triangles); lengthen edge_length_px or "
                            "edge_length, or lower subdivision_rate",
                            mesh.name, triangles, sub.max_triangles));
            return;
        }
        if (rates.limited > 0) {
            in_.problems.note(
                sub.loc, fmt::format("mesh '{}': {} of {} edges are cut into {} "
                                     "pieces (subdivision_max_rate), fewer than "
                                     "their length asks for",
                                     mesh.name, rates.limited, cage.edges.size(), sub.max_rate));
        }
        const int threads = workers_.threads();
        std::unique_ptr<LimitSurface> surface;
        workers_.execute(
            [&] { surface = std::make_unique<LimitSurface>(mesh, cage, threads, in_.isa); });
        DisplaceInput input{mesh,         cage, rates.rates, *surface, slots(mesh, users.front()),
                            in_.textures, first};
        if (!has_tangents(mesh, input.by_slot)) return;
        Diced diced = dice(cage, rates.rates);
        DisplaceReport report;
        SubdivisionStatistics s;
        s.mesh = mesh.name;
        s.cage_faces = cage.faces.size();
        s.triangles = triangles;
        s.vertices = diced.sites.size();
        s.bytes_dicing = cage.bytes() + diced.bytes();
        MeshDesc made = displaced_mesh(input, std::move(diced), workers_, report);
        s.bytes_surface = static_cast<std::uint64_t>(surface->bytes());
        check_reach(mesh, cage, input, report);
        s.non_finite = report.non_finite;
        s.before = corners(report.before);
        s.after = corners(report.after);
        surface.reset();
        mesh = std::move(made);
        const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
        s.seconds = spent.count();
        out_.push_back(std::move(s));
    }

    bool can_evaluate(const MeshDesc& mesh, const Cage& cage) const {
        const std::uint32_t valence = cage.valence();
        if (mesh.subdivision.scheme != Subdivision::catmull_clark ||
            valence <= LimitSurface::kMaxValence)
            return true;
        in_.problems.error(
            mesh.subdivision.loc,
            fmt::format("mesh '{}': {} faces meet at one vertex, catmull_clark takes at most {} "
                        "(use \"linear\", or fewer faces about a pole)",
                        mesh.name, valence, LimitSurface::kMaxValence));
        return false;
    }

    std::vector<const Displacement*> slots(const MeshDesc& mesh, std::size_t user) const {
        const int override_material = in_.instances[user].material;
        std::vector<int> materials = mesh.materials;
        if (materials.empty()) materials.push_back(-1);
        std::vector<const Displacement*> out;
        for (const int own : materials) {
            const int m = override_material >= 0 ? override_material : own;
            const bool moves = m >= 0 && in_.displacements[m].moves();
            out.push_back(moves ? &in_.displacements[m] : nullptr);
        }
        return out;
    }

    bool has_tangents(const MeshDesc& mesh, const std::vector<const Displacement*>& slots) const {
        const bool needed = std::any_of(slots.begin(), slots.end(), [](const Displacement* d) {
            return d && d->needs_tangent();
        });
        if (!needed || !mesh.uvs.empty()) return true;
        in_.problems.error(mesh.subdivision.loc,
                           fmt::format("mesh '{}': vector_displacement in tangent space needs "
                                       "texture coordinates, the mesh has none (see "
                                       "displacement_space = \"object\")",
                                       mesh.name));
        return false;
    }

    void check_reach(const MeshDesc& mesh, const Cage& cage, const DisplaceInput& input,
                     const DisplaceReport& report) const {
        if (report.non_finite > 0)
            in_.problems.warn(mesh.subdivision.loc,
                              fmt::format("mesh '{}': displacement is not finite at {} vertices, "
                                          "they stay where they are",
                                          mesh.name, report.non_finite));
        const double size = length(report.before.hi - report.before.lo);
        if (report.farthest <= kFarthest * size) return;
        const std::uint32_t face = cage.faces[report.farthest_face].source;
        const std::uint32_t slot = mesh.face_material.empty() ? 0 : mesh.face_material[face];
        int material = slot < mesh.materials.size() ? mesh.materials[slot] : -1;
        for (std::size_t m = 0; m < in_.displacements.size(); ++m)
            if (&in_.displacements[m] == input.by_slot[slot]) material = static_cast<int>(m);
        const MaterialDesc& m = in_.desc.materials[material];
        in_.problems.error(
            m.displacement_loc.file ? m.displacement_loc : m.loc,
            fmt::format("material '{}': displacement moves mesh '{}' by {:.3g} of its units, more "
                        "than {} times its size; lower displacement_scale",
                        m.name, mesh.name, report.farthest, kFarthest));
    }

    const SubdivisionInput& in_;
    Workers workers_;
    std::vector<SubdivisionStatistics> out_;
};

}  // namespace

std::vector<bool> displaced_materials(const SceneDesc& desc,
                                      const std::vector<FlatInstance>& instances,
                                      Problems& problems) {
    std::vector<bool> out(desc.materials.size(), false);
    for (const FlatInstance& i : instances) {
        for (const int m : materials_of(desc, i)) {
            if (m < 0 || !displaces(desc.materials[m])) continue;
            if (is_subdivided(desc, i))
                out[m] = true;
            else
                warn_unmoved(desc, i, m, problems);
        }
    }
    return out;
}

bool any_subdivided(const SceneDesc& desc, const std::vector<FlatInstance>& instances) {
    return std::any_of(instances.begin(), instances.end(),
                       [&](const FlatInstance& i) { return is_subdivided(desc, i); });
}

std::vector<SubdivisionStatistics> subdivide_meshes(const SubdivisionInput& in) {
    return Subdivider(in).run();
}

}  // namespace tessera
