#pragma once
// A material compiled once: constants folded, what cannot matter dropped, facts known. Run at every
// hit.

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "materials/graph.h"
#include "materials/medium.h"
#include "materials/shade_input.h"
#include "materials/surface/surface.h"
#include "renderer/api/scene_desc.h"
#include "renderer/image/texture.h"

namespace tessera {

/// What a material can do; decides which kernel and which data a scene needs.
struct ProgramFacts {
    bool cutout = false;  // opacity can be below 1
    bool opacity_textured = false;
    bool opacity_geometry = false;   // reads more than texture coordinates
    bool emission_geometry = false;  // as well
    bool emission_by_hit = false;    // or what only a hit knows: light sampling cannot ask
    bool emissive = false;
    bool emission_textured = false;
    bool emission_covered = false;  // by a coat or fuzz: it depends on the direction
    bool specular = false;          // any lobe other than Lambert's
    bool coat = false;
    bool layers = false;  // fuzz, coat, film, rough or translucent body
    bool transmission = false;
    bool glass = false;       // solid: refracts, encloses a medium
    bool subsurface = false;  // solid: light walks through it
    bool dispersion = false;
    bool textured = false;  // reads an image while shading
    bool uv = false;        // reads texture coordinates
    bool tangent = false;   // reads dpdu
    bool geometry = false;  // reads position, normal or instance
    bool vertex_color = false;
    bool bends_normal = false, bends_coat_normal = false;
    bool turns_tangent = false, turns_coat_tangent = false;
    float crease_angle_deg = kInfinity;  // of the creases that it asks for, at least
    bool creases() const noexcept { return crease_angle_deg < kInfinity; }
};

class alignas(64) ShaderProgram {
public:
    /// desc's texture indices are those of the TextureStore (see remapped).
    explicit ShaderProgram(const MaterialDesc& desc);
    /// Shares what other programs made with the same cache have computed.
    ShaderProgram(const MaterialDesc& desc, CurveCache& cache);

    const ProgramFacts& facts() const noexcept { return facts_; }

    /// Calls use(const Surface&) with the surface at a point, and returns its result. store may be
    /// null if nothing is textured.
    template <class Use>
    auto with_surface(const ShadeInput& in, const TextureStore* store, Use use) const noexcept {
        if (varies_) return use(varied(in, store));
        return use(constant_);
    }
    /// surface().base_color alone: all that a Lambertian surface has.
    Color base_color(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// Radiance leaving the surface by itself. outward: cosine between its geometric normal and the
    /// way to the viewer, below zero where it is seen from behind.
    Color emission(const ShadeInput& in, const TextureStore* store, float outward) const noexcept;
    /// Emission times opacity: what of it is there on average, for light sampling, whose shadow
    /// rays end before the surface and are not asked.
    Color visible_emission(const ShadeInput& in, const TextureStore* store,
                           float outward) const noexcept;
    /// Mean emission over the texture, uncovered, for choosing lights.
    Color mean_emission(const TextureStore* store) const noexcept;
    /// 1: light stops here.
    float opacity(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// The constant that the opacity's texture is multiplied by.
    float opacity_factor() const noexcept { return m_.geometry_opacity.value; }
    bool bends_normal() const noexcept { return facts_.bends_normal; }
    bool bends_coat_normal() const noexcept { return facts_.bends_coat_normal; }
    bool turns_tangent() const noexcept { return facts_.turns_tangent; }
    bool turns_coat_tangent() const noexcept { return facts_.turns_coat_tangent; }
    /// Unit normals on in.n's side, in the world; in.n if the material says nothing of them.
    Vec3f normal(const ShadeInput& in, const TextureStore* store) const noexcept;
    Vec3f coat_normal(const ShadeInput& in, const TextureStore* store) const noexcept;
    /// Which way highlights stretch, in the world; of any length, zero too.
    Vec3f tangent(const ShadeInput& in, const TextureStore* store) const noexcept;
    Vec3f coat_tangent(const ShadeInput& in, const TextureStore* store) const noexcept;
    const Graph& graph() const noexcept { return graph_; }
    /// Parameters that do not vary; what does is as if its images were white.
    const SurfaceParams& constant() const noexcept { return constant_.p; }
    /// What fills a body of it, taken at a point of its surface.
    Medium transmission(const ShadeInput& in, const TextureStore* store) const noexcept;
    Medium subsurface(const ShadeInput& in, const TextureStore* store) const noexcept;
    int dielectric_priority() const noexcept { return m_.dielectric_priority; }

private:
    /// An input that has an image or a node, and where its value goes; one of the two kinds is
    /// there.
    struct Varying {
        ColorInput MaterialDesc::*color = nullptr;
        Color SurfaceParams::*color_param = nullptr;
        FloatInput MaterialDesc::*scalar = nullptr;
        float SurfaceParams::*scalar_param = nullptr;
        float low = 0, high = 1;
        Wire wire = {};
        bool wired = false;
    };
    void note_varying(ColorInput MaterialDesc::*input, Color SurfaceParams::*param);
    void note_varying(FloatInput MaterialDesc::*input, float SurfaceParams::*param);
    void add_varying(Varying v, int node, int output);
    SurfaceParams params(const ShadeInput& in, const TextureStore* store) const noexcept;
    Surface varied(const ShadeInput& in, const TextureStore* store) const noexcept;
    Color bare_emission(const ShadeInput& in, const TextureStore* store) const noexcept;
    void compile_covering();
    Color mean_emission_of_graph(const TextureStore* store) const noexcept;
    void compile(CurveCache& cache);
    void compile_relief();
    void compile_opacity();
    void compile_emission();
    Vec3f mapped_normal(const NormalInput& input, const Wire& wire, const ShadeInput& in,
                        const TextureStore* store) const noexcept;

    // What every hit asks for, in one cache line; then what most do.
    ProgramFacts facts_;
    bool varies_ = false;
    bool emission_varies_ = false, covering_varies_ = false;
    Color constant_emission_{0.0f};
    Surface constant_{SurfaceParams()};  // what does not vary
    MaterialDesc m_;
    std::vector<Varying> varying_;
    Graph graph_;
    // What is asked for apart from the surface.
    Graph relief_, opacity_graph_, emission_graph_;
    Wire normal_, coat_normal_, tangent_, coat_tangent_, bump_;
    Wire opacity_, emission_color_, emission_luminance_;
    Medium transmission_, subsurface_;             // constant_'s
    std::shared_ptr<const SurfaceCurves> curves_;  // shared: programs are copied into place
};

/// The description with its texture indices taken through `to` (-1: not loaded because nothing
/// reads it).
MaterialDesc remapped(MaterialDesc desc, std::span<const int> to);

struct TextureRead {
    int texture;
    TextureUse as;
};
/// Which textures a material reads, some of them twice. displaced: its displacement is asked for
/// too.
std::vector<TextureRead> textures_of(const MaterialDesc& desc, bool displaced = false);

}  // namespace tessera
