#pragma once
// A material compiled once: constants folded, what cannot matter dropped, facts known. Run at every
// hit.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "materials/surface/openpbr.h"
#include "renderer/api/scene_desc.h"
#include "renderer/image/texture.h"

namespace tessera {

/// What a material can do; decides which kernel and which data a scene needs.
struct ProgramFacts {
    bool cutout = false;  // opacity can be below 1
    bool opacity_textured = false;
    bool emissive = false;
    bool emission_textured = false;
    bool specular = false;  // any lobe other than Lambert's
    bool transmission = false;
    bool textured = false;  // reads an image while shading
    bool uv = false;        // reads texture coordinates
    bool tangent = false;   // reads dpdu
    bool vertex_color = false;
};

/// What a program may ask of the point it shades.
struct ShadeInput {
    Vec2f uv;
    float uv_width = 0;  // footprint in uv units
    Color vertex_color{1.0f};
};

class ShaderProgram {
public:
    /// desc's texture indices are those of the TextureStore (see remapped).
    explicit ShaderProgram(const MaterialDesc& desc);

    const ProgramFacts& facts() const noexcept { return facts_; }

    /// Calls use(const Surface&) with the surface at a point. store may be null if nothing is
    /// textured.
    template <class Use>
    void with_surface(const ShadeInput& in, const TextureStore* store, Use use) const noexcept {
        if (facts_.textured || facts_.vertex_color)
            use(Surface(varied(in, store)));
        else
            use(constant_);
    }
    /// surface().base_color alone: all that a Lambertian surface has.
    Color base_color(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// Radiance leaving the surface by itself.
    Color emission(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// Emission times opacity: what of it is there on average, for light sampling, whose shadow
    /// rays end before the surface and are not asked.
    Color visible_emission(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// Mean emission over the texture, for choosing lights.
    Color mean_emission(const TextureStore* store) const noexcept;
    /// 1: light stops here.
    float opacity(Vec2f uv, const TextureStore* store) const noexcept;
    /// The constant that the opacity's texture is multiplied by.
    float opacity_factor() const noexcept { return m_.geometry_opacity.value; }
    bool has_normal_map() const noexcept { return m_.geometry_normal >= 0; }
    /// Normal in the tangent frame from the normal map; none if there is no map.
    std::optional<Vec3f> normal(const ShadeInput& in, const TextureStore* store) const noexcept;

private:
    SurfaceParams varied(const ShadeInput& in, const TextureStore* store) const noexcept;

    MaterialDesc m_;
    Surface constant_{SurfaceParams()};  // what does not vary
    ProgramFacts facts_;
    std::shared_ptr<const ReflectionAlbedoCurve>
        boundary_;  // shared: programs are copied into place
};

/// The description with its texture indices taken through `to` (-1: not loaded because nothing
/// reads it).
MaterialDesc remapped(MaterialDesc desc, std::span<const int> to);

/// Which textures a material reads, and as what.
void collect_textures(const MaterialDesc& desc, std::vector<TextureUse>& use,
                      std::vector<bool>& read);

}  // namespace tessera
