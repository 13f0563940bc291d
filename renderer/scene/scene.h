#pragma once
// The scene ready to trace. Immutable once built; shared between threads.

#include <memory>
#include <string>
#include <vector>

#include "materials/program.h"
#include "renderer/api/render.h"
#include "renderer/film/light_paths.h"
#include "renderer/geometry/accel.h"
#include "renderer/geometry/interpolate.h"
#include "renderer/image/colour_space.h"
#include "renderer/lights/light_set.h"
#include "renderer/lights/reflection_map.h"
#include "renderer/scene/camera.h"
#include "renderer/scene/features.h"
#include "renderer/scene/light_tags.h"
#include "renderer/scene/name_ids.h"

namespace tessera {

class Scene {
public:
    const Accel& accel() const noexcept { return *accel_; }
    const Geometry& geometry() const noexcept { return geometry_; }
    const Camera& camera() const noexcept { return camera_; }
    const LightSet& lights() const noexcept { return lights_; }
    const ShaderProgram& program(int material) const noexcept { return programs_[material]; }
    const std::string& material_name(int material) const noexcept {
        return material_names_[static_cast<std::size_t>(material)];
    }
    /// What a material mirrors in place of the scene; null: nothing.
    const ReflectionMap* reflection_map(int material) const noexcept {
        return reflection_maps_.empty() ? nullptr : reflection_maps_[material].get();
    }
    /// What lights are called in light path expressions, and the groups that there are, "default"
    /// first.
    const LightTags& light_tags() const noexcept { return light_tags_; }
    /// What is asked for beyond beauty, and the expressions of it compiled.
    const Passes& passes() const noexcept { return passes_; }
    const LightPaths& light_paths() const noexcept { return light_paths_; }
    /// The names of what is hit; null unless a pass asks for them.
    const NameIds* name_ids() const noexcept { return name_ids_.get(); }
    const TextureStore* textures() const noexcept { return textures_.get(); }
    /// Whether a ray can run into something that shines.
    bool emission_can_be_hit() const noexcept { return emission_can_be_hit_; }
    const Features& features() const noexcept { return features_; }
    std::string_view kernel() const noexcept { return kernel_; }
    const FilmDesc& film() const noexcept { return film_; }
    const RenderDesc& settings() const noexcept { return settings_; }
    /// Where this space's origin lies in the world, for the P pass.
    Vec3d origin() const noexcept { return origin_; }
    Vec3d bounds_min() const noexcept { return bounds_min_; }
    Vec3d bounds_max() const noexcept { return bounds_max_; }
    /// Hash of the description, for the file's header.
    const std::string& hash() const noexcept { return hash_; }
    /// Statistics of the build, to which a render adds its own.
    const Statistics& statistics() const noexcept { return statistics_; }

private:
    friend class SceneBuilder;
    Geometry geometry_;
    std::vector<ShaderProgram> programs_;
    std::vector<std::string> material_names_;                            // as programs_
    std::vector<std::shared_ptr<const ReflectionMap>> reflection_maps_;  // by material, or none
    std::unique_ptr<ColorSpaces> colors_;
    std::unique_ptr<TextureStore> textures_;
    LightTags light_tags_;
    Passes passes_;
    LightPaths light_paths_;
    std::unique_ptr<const NameIds> name_ids_;
    LightSet lights_;
    bool emission_can_be_hit_ = false;
    Camera camera_;
    std::unique_ptr<Accel> accel_;
    Features features_;
    std::string kernel_;
    FilmDesc film_;
    RenderDesc settings_;
    Vec3d origin_, bounds_min_, bounds_max_;
    std::string hash_;
    Statistics statistics_;
};

/// What the textures hold and have read by now.
void count_textures(const Scene& scene, Statistics& s);

}  // namespace tessera
