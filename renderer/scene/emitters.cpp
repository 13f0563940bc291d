#include "renderer/scene/emitters.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "materials/lobe.h"
#include "renderer/scene/environment.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

Color color_of(Float3 c) { return {c[0], c[1], c[2]}; }

struct EmitterBuilder {
    const EmitterInput& in;
    Geometry& geometry;
    std::vector<Light> lights;
    std::vector<double> powers;
    std::vector<LightLabel> labels;
    // By shape and replacing material.
    std::map<std::pair<std::uint32_t, std::int32_t>, std::shared_ptr<EmissiveFaces>> shared;

    double radius() const { return 0.5 * length(in.bounds_max - in.bounds_min); }
    Vec3f point(const Double3& p) const { return Vec3f(Vec3d(p) - in.origin); }
    int next() const { return static_cast<int>(lights.size()); }

    void add(Light light, LightLabel label, double mesh_emission = 0) {
        labels.push_back(label);
        powers.push_back(light_power(light, radius(), mesh_emission));
        lights.push_back(std::move(light));
    }

    void place_body(PlacedKind kind, std::size_t shape, bool visible) {
        Placement placed;
        placed.kind = kind;
        placed.shape = static_cast<std::uint32_t>(shape);
        placed.light = next();
        placed.camera_visible = visible;
        geometry.placements.push_back(placed);
    }

    LightLabel lamp(const LightDesc& desc) const {
        return {LightType::light, in.tags.add(desc.light_group, desc.name)};
    }
    // What shines by its material; of the faces of a mesh each is asked for its own.
    LightLabel surface(std::int32_t material) const {
        return {LightType::object, in.tags.of_material(material)};
    }

    void described(const LightDesc& desc) {
        std::visit([&](const auto& l) { make(l, desc); }, desc.shape);
    }

    void make(const PointLightDesc& l, const LightDesc& desc) {
        add(PointLight{point(l.position), color_of(l.intensity)}, lamp(desc));
    }

    void make(const SpotLightDesc& l, const LightDesc& desc) {
        SpotLight s;
        s.position = point(l.position);
        s.direction = Vec3f(normalize(Vec3d(l.direction)));
        s.intensity = color_of(l.intensity);
        s.cos_outer = static_cast<float>(std::cos(l.cone_deg * kPiD / 180));
        s.cos_inner = static_cast<float>(std::cos(l.cone_deg * (1 - l.blend) * kPiD / 180));
        add(s, lamp(desc));
    }

    void make(const DistantLightDesc& l, const LightDesc& desc) {
        add(make_distant_light(Vec3f(-normalize(Vec3d(l.direction))), color_of(l.irradiance),
                               l.angle_deg, desc.visible),
            lamp(desc));
    }

    void make(const QuadLightDesc& l, const LightDesc& desc) {
        const QuadLight q = make_quad_light(Vec3d(l.corner) - in.origin, Vec3d(l.edges[0]),
                                            Vec3d(l.edges[1]), color_of(l.radiance), l.two_sided);
        if (!(q.area > 0.0f)) {
            in.problems.error(
                desc.loc,
                fmt::format("light '{}': the edges are parallel or zero, the quad has no area",
                            desc.name));
            return;
        }
        Mesh body;
        for (const Vec3f corner :
             {q.corner, q.corner + q.edge_u, q.corner + q.edge_u + q.edge_v, q.corner + q.edge_v}) {
            body.add_vertex(corner);
        }
        body.finish_vertices();
        body.index = {0, 1, 2, 3};
        body.quads = 1;
        body.parts = {{0, 1, true, false}};
        body.materials = {-1};
        place_body(PlacedKind::mesh, geometry.meshes.size(), desc.visible);
        geometry.meshes.push_back(std::move(body));
        add(q, lamp(desc));
    }

    void make(const DiscLightDesc& l, const LightDesc& desc) {
        const DiscLight d{point(l.center), Vec3f(normalize(Vec3d(l.normal))),
                          static_cast<float>(l.radius), color_of(l.radiance), l.two_sided};
        place_body(PlacedKind::disc, geometry.discs.size(), desc.visible);
        geometry.discs.push_back({d.center, d.normal, d.radius, -1});
        add(d, lamp(desc));
    }

    void make(const SphereLightDesc& l, const LightDesc& desc) {
        const SphereLight s{point(l.center), static_cast<float>(l.radius), color_of(l.radiance)};
        place_body(PlacedKind::sphere, geometry.spheres.size(), desc.visible);
        geometry.spheres.push_back({s.center, s.radius, -1});
        add(s, lamp(desc));
    }

    // Emissive materials on shapes.
    void surfaces(std::size_t placements) {
        for (std::size_t i = 0; i < placements; ++i) {
            Placement& placed = geometry.placements[i];
            if (placed.kind == PlacedKind::mesh) {
                mesh_light(placed);
            } else {
                const std::int32_t own = placed.kind == PlacedKind::sphere
                                             ? geometry.spheres[placed.shape].material
                                             : geometry.discs[placed.shape].material;
                quadric_light(placed, placed.material >= 0 ? placed.material : own);
            }
        }
    }

    void quadric_light(Placement& placed, std::int32_t material) {
        const ShaderProgram& program = in.programs[material];
        const ProgramFacts& facts = program.facts();
        if (!facts.emissive) return;
        if (facts.emission_textured || facts.cutout || placed.instanced) {
            in.problems.warn({},
                             "an emissive sphere or disc that is textured, partly transparent or "
                             "stretched is found by "
                             "chance only: expect noise (a [[light]] is sampled)");
            return;
        }
        const Color radiance = program.mean_emission(in.textures);
        const std::int32_t asked = facts.emission_covered ? material : -1;
        placed.light = next();
        if (placed.kind == PlacedKind::sphere) {
            const Sphere& s = geometry.spheres[placed.shape];
            add(SphereLight{s.center, s.radius, radiance, asked}, surface(material));
        } else {
            const Disc& d = geometry.discs[placed.shape];
            add(DiscLight{d.center, d.normal, d.radius, radiance, true, asked}, surface(material));
        }
    }

    void mesh_light(Placement& placed) {
        const Mesh& mesh = geometry.meshes[placed.shape];
        const auto emits = [&](std::int32_t m) {
            return m >= 0 && in.programs[m].facts().emissive;
        };
        if (placed.material >= 0
                ? !emits(placed.material)
                : std::none_of(mesh.materials.begin(), mesh.materials.end(), emits))
            return;
        MeshLight light;
        // A map that can be undone leaves the faces in their own space, once for all instances.
        constexpr double kTame = 1e4, kLeast = 1e-30, kMost = 1e30;
        const double determinant = Affined(placed.to_world).determinant();
        if (placed.instanced && static_cast<double>(placed.condition) < kTame &&
            std::abs(determinant) > kLeast && std::abs(determinant) < kMost) {
            light.placed = true;
            light.to_world = placed.to_world;
            light.determinant = static_cast<float>(determinant);
            light.condition = placed.condition;
            auto& faces = shared[{placed.shape, placed.material}];
            if (!faces) faces = emissive_faces(mesh, placed.material, Affined());
            light.faces = faces;
        } else {
            light.faces = emissive_faces(mesh, placed.material,
                                         placed.instanced ? Affined(placed.to_world) : Affined());
        }
        if (light.faces->triangles.empty()) return;
        light.placement = static_cast<std::uint32_t>(&placed - geometry.placements.data());
        placed.light = next();
        const double emission = emission_of(light);
        add(std::move(light), {LightType::object, 0}, emission);
    }

    double brightness(std::int32_t material) const {
        return static_cast<double>(luminance(in.programs[material].mean_emission(in.textures)));
    }

    // In place: brightness times area.
    double emission_of(const MeshLight& light) const {
        const Affined m = light.placed ? Affined(light.to_world) : Affined();
        double sum = 0;
        for (const auto& t : light.faces->triangles) {
            const double area = 0.5 * length(cross(m.vector(Vec3d(t.ab)), m.vector(Vec3d(t.ac))));
            sum += area * brightness(t.material);
        }
        return sum;
    }

    std::shared_ptr<EmissiveFaces> emissive_faces(const Mesh& mesh, std::int32_t material,
                                                  const Affined& to_world) {
        auto out = std::make_shared<EmissiveFaces>();
        std::map<std::int32_t, double> bright;
        std::vector<double> weights;
        double sum = 0;
        bool by_hit = false;
        for (std::uint32_t face = 0; face < mesh.faces(); ++face) {
            const std::int32_t m =
                material >= 0 ? material : mesh.materials[mesh.material_slot(face)];
            if (m < 0 || !in.programs[m].facts().emissive) continue;
            if (in.programs[m].facts().emission_by_hit) {
                by_hit = true;
                continue;
            }
            const auto known = bright.find(m);
            const double b = known != bright.end() ? known->second : (bright[m] = brightness(m));
            if (!(b > 0)) continue;
            add_face(mesh, face, to_world, m, *out, [&](double area) {
                weights.push_back(area * b);
                sum += weights.back();
            });
        }
        for (const auto& [m, b] : bright) {
            if (b > 0) out->density.push_back({m, static_cast<float>(b / sum)});
        }
        if (!weights.empty()) out->pick = AliasTable(weights);
        if (by_hit)
            in.problems.warn({},
                             "an emissive mesh whose graph reads normals, tangents or vertex "
                             "colours is found by chance only: expect noise");
        return out;
    }

    template <class Added>
    static void add_face(const Mesh& mesh, std::uint32_t face, const Affined& to_world,
                         std::int32_t material, EmissiveFaces& out, Added added) {
        const std::size_t first = mesh.corner(face);
        const bool quad = face >= mesh.triangles;
        constexpr int kQuadHalves[2][3] = {{0, 1, 3}, {2, 3, 1}};
        constexpr int kTriangle[3] = {0, 1, 2};
        for (int half = 0; half < (quad ? 2 : 1); ++half) {
            const int* k = quad ? kQuadHalves[half] : kTriangle;
            Vec3f p[3];
            Vec2f t[3];
            for (int c = 0; c < 3; ++c) {
                const std::uint32_t vertex = mesh.index[first + k[c]];
                p[c] = Vec3f(to_world.point(Vec3d(mesh.position(vertex))));
                if (mesh.uv_at > 0) t[c] = mesh.uv(vertex);
            }
            const double area =
                0.5 * length(cross(Vec3d(p[1]) - Vec3d(p[0]), Vec3d(p[2]) - Vec3d(p[0])));
            if (!(area > 0)) continue;
            out.triangles.push_back(
                {p[0], p[1] - p[0], p[2] - p[0], t[0], t[1] - t[0], t[2] - t[0], material});
            added(area);
        }
    }
};

}  // namespace

LightSet make_emitters(const EmitterInput& in, Geometry& geometry) {
    EmitterBuilder b{in, geometry, {}, {}, {}, {}};
    const auto around = [&](const std::string& group, const char* name) {
        return LightLabel{LightType::surroundings, in.tags.add(group, name)};
    };
    b.surfaces(geometry.placements.size());
    for (const LightDesc& light : in.desc.lights) b.described(light);
    if (in.desc.environment)
        if (auto light = make_environment(*in.desc.environment, in))
            b.add(std::move(*light), around(in.desc.environment->light_group, "environment"));
    if (in.desc.sky)
        for (Light& light : make_sky(*in.desc.sky, in))
            b.add(std::move(light), around(in.desc.sky->light_group, "sky"));
    return LightSet(std::move(b.lights), b.powers, std::move(b.labels));
}

}  // namespace tessera
