// Describe -> build: plain data to the immutable scene. One step a function, in the order in which
// they run.

#include "renderer/scene/scene.h"

#include <algorithm>
#include <chrono>
#include <map>

#include <fmt/format.h>

#include "renderer/core/log.h"
#include "renderer/core/parallel.h"
#include "renderer/film/blame.h"
#include "renderer/geometry/find_creases.h"
#include "renderer/scene/bake.h"
#include "renderer/scene/emitters.h"
#include "renderer/scene/flatten.h"
#include "renderer/scene/hash.h"
#include "renderer/scene/map_file.h"
#include "renderer/scene/name_collector.h"
#include "renderer/scene/opacity.h"
#include "renderer/scene/placement.h"
#include "renderer/scene/subdivision.h"

namespace tessera {

class SceneBuilder {
public:
    SceneBuilder(SceneDesc&& desc, const BuildOptions& options)
        : desc_(std::move(desc)),
          options_(options),
          problems_(options.strictness),
          scene_(std::make_shared<Scene>()) {}

    ScenePtr build() {
        scene_->hash_ = scene_hash(desc_);
        scene_->film_ = desc_.film;
        scene_->settings_ = desc_.render;
        instances_ = flatten(desc_, problems_);
        find_used_materials();
        compile_materials();
        choose_passes();
        place_origin();
        if (any_subdivided(desc_, instances_)) subdivide();
        const auto goes_by_names = [](const MaterialDesc& m) { return wants_name_ids(m); };
        if (wants_name_ids(scene_->passes_) ||
            std::any_of(desc_.materials.begin(), desc_.materials.end(), goes_by_names))
            names_.emplace(desc_);
        place_shapes();
        make_lights();
        if (desc_.camera.projection != Projection::perspective && desc_.camera.aperture_radius > 0)
            problems_.warn(desc_.camera.loc,
                           "camera: only a perspective camera has a lens, aperture_radius is not "
                           "used");
        if (desc_.camera.projection == Projection::latlong &&
            desc_.film.width != 2 * std::int64_t{desc_.film.height})
            problems_.note(desc_.camera.loc,
                           "camera: a latlong picture that is not 2:1 is no map that can be told "
                           "by its shape");
        scene_->camera_ = Camera(desc_.camera, desc_.film.width, desc_.film.height, scene_->origin_,
                                 scene_->bounds_min_, scene_->bounds_max_);
        problems_.throw_if_any();
        if (names_)
            scene_->name_ids_ = std::make_unique<NameIds>(names_->finish(scene_->geometry_));
        choose_kernel();
        build_accel();
        account();
        return scene_;
    }

private:
    void find_used_materials() {
        used_.assign(desc_.materials.size(), false);
        const auto use = [&](int m) {
            if (m >= 0) used_[m] = true;
        };
        for (const FlatInstance& i : instances_) {
            if (i.material >= 0) {
                use(i.material);
            } else if (i.kind == ShapeKind::mesh) {
                for (int m : desc_.meshes[i.index].materials) use(m);
            } else {
                use(i.kind == ShapeKind::sphere ? desc_.spheres[i.index].material
                                                : desc_.discs[i.index].material);
            }
        }
    }

    // Reads only the textures that a used material can show.
    void compile_materials() {
        // Shapes without a material get the default one, which stands last.
        desc_.materials.push_back(MaterialDesc{});
        used_.push_back(true);
        const std::size_t n = desc_.textures.size();
        std::vector<TextureUse> use(n, TextureUse::color);
        std::vector<bool> read(n, false);
        std::vector<std::vector<std::string>> users(n);
        const std::vector<bool> displaced = displaced_materials(desc_, instances_, problems_);
        for (std::size_t i = 0; i < desc_.materials.size(); ++i) {
            if (!used_[i]) continue;
            const MaterialDesc& m = desc_.materials[i];
            for (const auto [texture, as] : textures_of(m, displaced[i])) {
                if (!read[texture]) use[texture] = as;
                read[texture] = true;
                std::vector<std::string>& names = users[texture];
                if (names.empty() || names.back() != m.name) names.push_back(m.name);
            }
        }
        std::vector<TextureRequest> requests;
        std::vector<int> remap(n, -1);
        for (std::size_t i = 0; i < n; ++i) {
            if (!read[i]) continue;
            remap[i] = static_cast<int>(requests.size());
            requests.push_back({&desc_.textures[i], use[i], std::move(users[i])});
        }
        if (!requests.empty()) {
            colors();
            const TextureOptions textures{options_.texture_memory, options_.auto_tx,
                                          options_.tx_cache};
            scene_->textures_ = std::make_unique<TextureStore>(requests, *scene_->colors_,
                                                               problems_, nullptr, textures);
        }
        textures_left_out_ = n - requests.size();
        CurveCache curves;
        for (std::size_t i = 0; i < desc_.materials.size(); ++i) {
            MaterialDesc m = remapped(desc_.materials[i], remap);
            if (scene_->textures_) forget_missing_shapes(m, *scene_->textures_);
            scene_->programs_.emplace_back(m, curves);
            scene_->material_names_.push_back(m.name);
            displacements_.push_back(displaced[i] ? Displacement(m) : Displacement());
        }
    }

    // A map that is missing shows in magenta; one that would bend, move or cut the surface is
    // nothing.
    static void forget_missing_shapes(MaterialDesc& m, const TextureStore& store) {
        const auto missing = [&](int texture) { return texture >= 0 && store.is_missing(texture); };
        if (missing(m.geometry_normal.texture)) m.geometry_normal = {};
        if (missing(m.geometry_coat_normal.texture)) m.geometry_coat_normal = {};
        if (missing(m.geometry_opacity.texture)) m.geometry_opacity.texture = -1;
        if (missing(m.bump.texture)) m.bump = {0};
        if (missing(m.displacement.texture)) m.displacement = {0};
        if (missing(m.vector_displacement.texture)) m.vector_displacement = {};
    }

    // Names of all lights first: passes may be of groups of them.
    void choose_passes() {
        LightTags& tags = scene_->light_tags_;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            const MaterialDesc& m = desc_.materials[i];
            if (used_[i] && scene_->programs_[i].facts().emissive)
                tags.tag_material(static_cast<int>(i), m.light_group, m.name);
        }
        for (const LightDesc& light : desc_.lights) tags.add(light.light_group, light.name);
        if (desc_.environment) tags.add(desc_.environment->light_group, "environment");
        if (desc_.sky) tags.add(desc_.sky->light_group, "sky");
        const SourceLoc& loc = desc_.film.aovs_loc;
        scene_->passes_ = tessera::choose_passes(desc_.film.aovs, tags.groups(), loc);
        if (needs_path(scene_->passes_) && desc_.render.integrator != Integrator::path)
            throw Error(blame(loc), loc,
                        "film.aovs: passes of light, shadow and lobes need render.integrator = "
                        "'path'");
        scene_->light_paths_ = LightPaths(scene_->passes_, tags.tags(), loc);
        warn_of_hopeless_passes(loc);
    }

    void warn_of_hopeless_passes(const SourceLoc& loc) {
        int number = 0;
        for (const Pass& p : scene_->passes_) {
            if (p.source != PassSource::light_paths) continue;
            if (!scene_->light_paths_.is_taken(number++) && p.group < 0)
                problems_.warn(loc, "pass '" + p.name + "': no light can come by '" + p.expression +
                                        "', it stays black (a path begins with C and ends with "
                                        "L, O or B)");
        }
    }

    // By the camera that frames what is there before: what it frames in the end is not known yet.
    void subdivide() {
        const Camera camera(desc_.camera, desc_.film.width, desc_.film.height, scene_->origin_,
                            scene_->bounds_min_, scene_->bounds_max_);
        scene_->statistics_.subdivision = subdivide_meshes(
            {desc_, instances_, displacements_, scene_->textures_.get(),
             view_scale(camera, scene_->origin_), options_.threads, options_.isa, problems_});
        place_origin();
    }

    const ColorSpaces& colors() {
        if (!scene_->colors_)
            scene_->colors_ = std::make_unique<ColorSpaces>(desc_.film.working_space);
        return *scene_->colors_;
    }

    bool has_environment_image() const {
        return desc_.environment && has_image(*desc_.environment);
    }

    int default_material() const { return static_cast<int>(desc_.materials.size()) - 1; }
    const ProgramFacts& facts(int material) const {
        return scene_->programs_[material >= 0 ? material : default_material()].facts();
    }

    // The scene's own origin: the world's, unless everything lies far from it.
    void place_origin() {
        Bounds world;
        for (const FlatInstance& i : instances_) world.add(instance_bounds(desc_, i));
        for (const LightDesc& l : desc_.lights) world.add(light_bounds(l));
        if (world.empty()) {
            problems_.warn({}, "the scene has no shapes: the picture is its background");
            if (desc_.environment || desc_.sky || !desc_.lights.empty())
                world.add({{-1, -1, -1}, {1, 1, 1}});
            else
                world.add({{0, 0, 0}, {0, 0, 0}});
        }
        constexpr double kFar = 8;  // diagonals away
        const Vec3d center = (world.lo + world.hi) * 0.5;
        scene_->origin_ = length(center) > kFar * length(world.hi - world.lo) ? center : Vec3d{};
        scene_->bounds_min_ = world.lo - scene_->origin_;
        scene_->bounds_max_ = world.hi - scene_->origin_;
        const double reach = std::max(max_component(abs(scene_->bounds_min_)),
                                      max_component(abs(scene_->bounds_max_)));
        if (reach > 1e17)
            problems_.error(
                {},
                fmt::format("the scene is {:.3g} units large, at most 1e17 can be traced", reach));
        problems_.throw_if_any();
    }

    // A shape placed once is moved into the scene's space; one placed often is kept once and
    // instanced.
    void place_shapes() {
        std::map<std::pair<ShapeKind, int>, ShapeUse> uses;
        for (const FlatInstance& i : instances_) {
            ShapeUse& use = uses[{i.kind, i.index}];
            ++use.count;
            use.cutout_override |= i.material >= 0 && facts(i.material).cutout;
            if (i.material >= 0)
                use.crease_angle_deg =
                    std::min(use.crease_angle_deg, facts(i.material).crease_angle_deg);
        }
        for (const FlatInstance& i : instances_) {
            Placement placed;
            placed.material = i.material;
            placed.objects_are_at(translation(-scene_->origin_) * i.to_world);
            ShapeUse& use = uses[{i.kind, i.index}];
            place_shape(i, use, placed);
            add_placement(i, placed);
        }
        for (MeshDesc& mesh : desc_.meshes) mesh = MeshDesc{};
    }

    void place_shape(const FlatInstance& i, ShapeUse& use, Placement& placed) {
        const Affined to_scene = translation(-scene_->origin_) * i.to_world;
        switch (i.kind) {
            case ShapeKind::mesh:
                return place_mesh(i, to_scene, use, placed);
            case ShapeKind::sphere:
                return place_sphere(i, to_scene, placed);
            case ShapeKind::disc:
                return place_disc(i, to_scene, placed);
            case ShapeKind::group:
                return;  // flattened
        }
    }

    void place_mesh(const FlatInstance& i, const Affined& to_scene, ShapeUse& use,
                    Placement& placed) {
        placed.kind = PlacedKind::mesh;
        const bool instanced = use.count > 1;
        if (use.shape < 0) {
            if (instanced) use.own_origin = mesh_center(desc_.meshes[i.index]);
            use.shape = bake(i.index, instanced ? translation(-use.own_origin) : to_scene, use);
        }
        placed.shape = static_cast<std::uint32_t>(use.shape);
        if (instanced) placed.instance_at(to_scene * translation(use.own_origin));
    }

    // Spheres and discs keep their form only under similarities; any other map goes through an
    // instance of the shape at its own origin.
    void place_sphere(const FlatInstance& i, const Affined& to_scene, Placement& placed) {
        const SphereDesc& desc = desc_.spheres[i.index];
        Sphere s;
        s.radius = static_cast<float>(desc.radius);
        s.material = desc.material < 0 ? default_material() : desc.material;
        if (keeps_form(to_scene, i, s.material)) {
            s.center = Vec3f(to_scene.point(Vec3d(desc.center)));
            s.radius = static_cast<float>(desc.radius * length(to_scene.x));
        } else {
            placed.instance_at(to_scene * translation(Vec3d(desc.center)));
        }
        s.cutout = quadric_cutout(i, s.material, desc.loc);
        add_shape(PlacedKind::sphere, s, scene_->geometry_.spheres, placed);
    }

    void place_disc(const FlatInstance& i, const Affined& to_scene, Placement& placed) {
        const DiscDesc& desc = desc_.discs[i.index];
        Disc d;
        d.radius = static_cast<float>(desc.radius);
        d.normal = Vec3f(normalize(Vec3d(desc.normal)));
        d.material = desc.material < 0 ? default_material() : desc.material;
        if (keeps_form(to_scene, i, d.material)) {
            d.center = Vec3f(to_scene.point(Vec3d(desc.center)));
            d.normal = Vec3f(normalize(to_scene.normal(Vec3d(desc.normal))));
            d.radius = static_cast<float>(desc.radius * length(to_scene.x));
        } else {
            placed.instance_at(to_scene * translation(Vec3d(desc.center)));
        }
        d.cutout = quadric_cutout(i, d.material, desc.loc);
        add_shape(PlacedKind::disc, d, scene_->geometry_.discs, placed);
    }

    template <class Shape>
    static void add_shape(PlacedKind kind, const Shape& shape, std::vector<Shape>& shapes,
                          Placement& placed) {
        placed.kind = kind;
        placed.shape = static_cast<std::uint32_t>(shapes.size());
        shapes.push_back(shape);
    }

    // Whether a sphere or disc can be moved into place by centre and radius alone. Texture
    // coordinates turn with the shape, which only an instance does.
    bool keeps_form(const Affined& m, const FlatInstance& i, int own_material) const {
        if (!is_similarity(m)) return false;
        const ProgramFacts& f = facts(i.material >= 0 ? i.material : own_material);
        return is_scaling(m) || !(f.uv || f.tangent);
    }

    bool quadric_cutout(const FlatInstance& i, int own_material, const SourceLoc& loc) {
        const ProgramFacts& f = facts(i.material >= 0 ? i.material : own_material);
        if (f.opacity_textured)
            problems_.warn(loc,
                           "spheres and discs take a constant opacity, the texture of "
                           "geometry_opacity is ignored");
        return f.cutout;
    }

    int bake(int index, const Affined& place, const ShapeUse& use) {
        MeshDesc& desc = desc_.meshes[index];
        if (desc.materials.size() > 65536)
            problems_.error(desc.loc, "mesh '" + desc.name + "': more than 65536 materials");
        BakeNeeds needs;
        needs.cutout = [&](int m) { return facts(m).cutout; };
        needs.any_cutout_override = use.cutout_override;
        needs.uvs = std::any_of(scene_->passes_.begin(), scene_->passes_.end(),
                                [](const Pass& p) { return p.source == PassSource::uv; });
        needs.colors = false;
        needs.objects = names_.has_value();
        for (std::size_t m = 0; m < scene_->programs_.size(); ++m) {
            // Any used material may stand on it through an override; finer bookkeeping would save
            // little.
            if (!used_[m]) continue;
            const ProgramFacts& f = scene_->programs_[m].facts();
            needs.uvs |= f.uv || f.tangent;
            needs.colors |= f.vertex_color;
        }
        scene_->geometry_.meshes.push_back(bake_mesh(desc, place, needs, bake_report_));
        if (names_) names_->add_mesh(desc);
        Mesh& mesh = scene_->geometry_.meshes.back();
        float crease_angle_deg = use.crease_angle_deg;
        for (auto& m : mesh.materials) {
            if (m < 0) m = default_material();
            crease_angle_deg = std::min(crease_angle_deg, facts(m).crease_angle_deg);
        }
        if (crease_angle_deg < kInfinity)
            mesh.creases = CreaseTree(find_creases(desc, crease_angle_deg * (kPi / 180.0f)));
        return static_cast<int>(scene_->geometry_.meshes.size()) - 1;
    }

    void add_placement(const FlatInstance& i, const Placement& placed) {
        const Geometry& g = scene_->geometry_;
        if (placed.kind == PlacedKind::mesh && g.meshes[placed.shape].parts.empty()) return;
        scene_->geometry_.placements.push_back(placed);
        if (names_) names_->add_placement(i, placed);
    }

    void make_lights() {
        EmitterInput in{desc_,
                        scene_->origin_,
                        scene_->bounds_min_,
                        scene_->bounds_max_,
                        scene_->programs_,
                        scene_->textures_.get(),
                        nullptr,
                        scene_->light_tags_,
                        problems_};
        if (desc_.sky || has_environment_image()) in.colors = &colors();
        read_reflection_maps();
        scene_->lights_ = make_emitters(in, scene_->geometry_);
        scene_->emission_can_be_hit_ = scene_->lights_.hittable();
        for (std::size_t i = 0; i < used_.size(); ++i) {
            scene_->emission_can_be_hit_ |= used_[i] && scene_->programs_[i].facts().emissive;
        }
    }

    void read_reflection_maps() {
        auto& maps = scene_->reflection_maps_;
        for (std::size_t i = 0; i < used_.size(); ++i) {
            if (!used_[i] || !desc_.materials[i].reflection_map) continue;
            maps.resize(used_.size());
            maps[i] = make_reflection_map(desc_.materials[i], scene_->origin_, colors(), problems_);
        }
    }

    void choose_kernel() {
        Features& f = scene_->features_;
        f.apart = !scene_->reflection_maps_.empty() || scene_->lights_.own_reflection();
        for (std::size_t i = 0; i < scene_->programs_.size(); ++i) {
            if (!used_[i] || (static_cast<int>(i) == default_material() && !default_used()))
                continue;
            const ProgramFacts& facts = scene_->programs_[i].facts();
            f.specular |= facts.specular;
            f.layers |= facts.layers;
            f.transmission |= facts.transmission;
            f.textures |= facts.textured;
            f.vertex_colors |= facts.vertex_color;
        }
        for (const Placement& p : scene_->geometry_.placements) {
            f.quadrics |= p.kind != PlacedKind::mesh;
            f.instances |= p.instanced;
        }
        f.lens = scene_->camera_.has_lens();
        for (const KernelRow& row : kKernels) {
            if (!row.features.covers(f)) {
                if (options_.kernel == row.name) {
                    throw Error(
                        ExitCode::usage,
                        fmt::format("--kernel {}: the scene needs more than that kernel has",
                                    row.name));
                }
                continue;
            }
            if (options_.kernel.empty() || options_.kernel == row.name) {
                scene_->kernel_ = row.name;
                return;
            }
        }
        throw Error(
            ExitCode::usage,
            fmt::format("--kernel {}: unknown, must be basic, surface or full", options_.kernel));
    }

    bool default_used() const {
        const Geometry& g = scene_->geometry_;
        for (const Placement& p : g.placements) {
            if (p.material >= 0) continue;
            if (p.kind == PlacedKind::sphere && g.spheres[p.shape].material == default_material())
                return true;
            if (p.kind == PlacedKind::disc && g.discs[p.shape].material == default_material())
                return true;
            if (p.kind != PlacedKind::mesh) continue;
            for (int m : g.meshes[p.shape].materials) {
                if (m == default_material()) return true;
            }
        }
        return false;
    }

    void build_accel() {
        Workers workers(options_.threads);
        AccelOptions accel;
        accel.threads = workers.threads();
        accel.isa = options_.isa;
        accel.opacity = {scene_.get(), &opacity_stops};
        workers.execute(
            [&] { scene_->accel_ = std::make_unique<Accel>(scene_->geometry_, accel); });
    }

    void account() {
        Statistics& s = scene_->statistics_;
        const Geometry& g = scene_->geometry_;
        s.version = TESSERA_VERSION;
        s.scene = desc_.path;
        s.kernel = scene_->kernel_;
        s.isa = scene_->accel_->isa();
        s.integrator = desc_.render.integrator == Integrator::path ? "path" : "whitted";
        s.width = desc_.film.width;
        s.height = desc_.film.height;
        s.spp = desc_.render.spp;
        s.seed = desc_.render.seed;
        for (const Mesh& m : g.meshes) {
            s.triangles_stored += m.triangles + 2 * std::uint64_t(m.quads);
            s.memory_geometry += m.bytes();
            s.memory_creases += m.creases.bytes();
        }
        for (const Placement& p : g.placements) {
            s.instances += p.instanced;
            if (p.kind == PlacedKind::mesh)
                s.triangles_instanced +=
                    g.meshes[p.shape].triangles + 2 * std::uint64_t(g.meshes[p.shape].quads);
        }
        s.memory_geometry += g.placements.capacity() * sizeof(Placement);
        if (scene_->name_ids_) s.memory_geometry += scene_->name_ids_->bytes();
        s.memory_bvh =
            static_cast<std::uint64_t>(std::max<std::int64_t>(0, scene_->accel_->bytes()));
        s.texture_limit = static_cast<std::uint64_t>(options_.texture_memory);
        count_textures(*scene_, s);
        s.memory_lights = scene_->lights_.bytes();
        for (const auto& map : scene_->reflection_maps_) s.memory_lights += map ? map->bytes() : 0;
        s.lights = static_cast<std::uint64_t>(scene_->lights_.size());
        if (bake_report_.degenerate > 0) {
            problems_.note({},
                           fmt::format("{} faces have no area in single precision and were dropped",
                                       bake_report_.degenerate));
        }
        s.warnings = desc_.warnings;
        s.warnings.insert(s.warnings.end(), problems_.warnings().begin(),
                          problems_.warnings().end());
        s.notes = desc_.notes;
        s.notes.insert(s.notes.end(), problems_.notes().begin(), problems_.notes().end());
        list_left_out(s);
    }

    void list_left_out(Statistics& s) const {
        const Features& f = scene_->features_;
        const auto leave = [&](bool absent, const char* what, std::string why) {
            if (absent) s.left_out.push_back({what, std::move(why)});
        };
        leave(!f.specular, "specular lobes", "every material is Lambertian");
        leave(!f.layers, "layers",
              "no material has fuzz, coat, film or a rough or translucent body");
        leave(!f.transmission, "transmission", "no material lets light through");
        leave(!f.textures, "texture look-ups", "no image is read while shading");
        leave(!scene_->textures_, "texture system", "no used material reads an image");
        leave(textures_left_out_ > 0, "textures",
              fmt::format("{} of {} images cannot reach the picture", textures_left_out_,
                          desc_.textures.size()));
        leave(!scene_->colors_ || !scene_->colors_->awake(), "OpenColorIO",
              "no image needs more than the sRGB curve");
        leave(!desc_.sky && !has_environment_image(), "environment table",
              desc_.environment ? "the environment is constant" : "there is no environment");
        leave(bake_report_.dropped_uvs > 0, "texture coordinates",
              fmt::format("nothing reads them ({} bytes)", bake_report_.dropped_uvs));
        leave(bake_report_.dropped_colors > 0, "vertex colours",
              fmt::format("nothing reads them ({} bytes)", bake_report_.dropped_colors));
        leave(!scene_->name_ids_, "names of things", "no pass and no node asks for them");
        leave(!f.instances, "instance transforms",
              "every shape stands once and was moved into place");
        leave(!f.lens, "lens", "the aperture is zero");
        leave(!f.apart, "reflection maps", "what mirrors shows the scene itself");
        bool cutout = false;
        for (const Mesh& m : scene_->geometry_.meshes) {
            for (const MeshPart& p : m.parts) cutout |= p.cutout;
        }
        leave(!cutout, "opacity tests", "every surface is opaque");
        leave(scene_->lights_.empty() || !scene_->lights_.sampled(), "light sampling",
              scene_->lights_.empty() ? "there is no light" : "the only light is a constant sky");
        const auto unused = std::count(used_.begin(), used_.end(), false);
        leave(unused > 0, "materials", fmt::format("{} are on no shape", unused));
    }

    SceneDesc desc_;
    BuildOptions options_;
    Problems problems_;
    std::shared_ptr<Scene> scene_;
    std::vector<FlatInstance> instances_;
    std::vector<bool> used_;
    std::vector<Displacement> displacements_;  // per material
    std::optional<NameCollector> names_;       // if a pass asks
    std::size_t textures_left_out_ = 0;
    BakeReport bake_report_;
};

ScenePtr build_scene(SceneDesc&& desc, const BuildOptions& options) {
    const auto start = std::chrono::steady_clock::now();
    SceneBuilder builder(std::move(desc), options);
    ScenePtr scene = builder.build();
    const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
    const_cast<Statistics&>(scene->statistics()).build_s = spent.count();
    return scene;
}

void count_textures(const Scene& scene, Statistics& s) {
    if (!scene.textures()) return;
    const TextureCounts c = scene.textures()->counts();
    s.memory_textures = static_cast<std::uint64_t>(c.memory_bytes);
    s.textures_in_core = static_cast<std::uint64_t>(c.in_core);
    s.textures_cached = static_cast<std::uint64_t>(c.cached);
    s.texture_bytes_read = static_cast<std::uint64_t>(c.bytes_read);
    s.texture_failures = static_cast<std::uint64_t>(c.failures);
}

Statistics describe(const Scene& scene) { return scene.statistics(); }

}  // namespace tessera
