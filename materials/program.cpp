#include "materials/program.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "materials/lobe.h"
#include "materials/surface/params_of.h"
#include "materials/texel.h"
#include "renderer/api/openpbr_inputs.h"

namespace tessera {
namespace {

Color color_of(Float3 c) { return {c[0], c[1], c[2]}; }

Color read(const ColorInput& input, const ShadeInput& in, const TextureStore* store) {
    Color c = color_of(input.value);
    if (input.texture >= 0) {
        const Texel t = store->sample(input.texture, in.uv.x, in.uv.y, in.uv_width);
        c *= Color{t[0], t[1], t[2]};
    }
    return c;
}

// Opacity comes from alpha where an image has one.
Channel opacity_channel(const FloatInput& input, const TextureStore* store) {
    if (input.channel != Channel::automatic) return input.channel;
    return store->has_alpha(input.texture) ? Channel::a : Channel::luminance;
}

float read(const FloatInput& input, const ShadeInput& in, const TextureStore* store) {
    if (input.texture < 0) return input.value;
    const Texel t = store->sample(input.texture, in.uv.x, in.uv.y, in.uv_width);
    const float v = channel_of(t, input.channel);
    return input.value * (input.invert ? 1.0f - v : v);
}

Color constant_of(const ColorInput& input) { return color_of(input.value); }
float constant_of(const FloatInput& input) { return input.value; }

bool zero(const FloatInput& input) { return input.value == 0.0f; }
bool one(const FloatInput& input) { return input.value == 1.0f && !input.varies(); }

// Calls visit(texture index, use) for every input; Material is MaterialDesc, const or not.
template <class Material, class Visit>
void visit_textures(Material& m, Visit visit) {
    const auto read_as = [&](TextureUse color) {
        return [&visit, &m, color](auto member, const OpenPbrInput&) {
            auto& input = m.*member;
            constexpr bool kColor =
                std::is_same_v<std::remove_cvref_t<decltype(input)>, ColorInput>;
            visit(input.texture, kColor ? color : TextureUse::data);
        };
    };
    visit_openpbr(read_as(TextureUse::color));
    visit_displacement(read_as(TextureUse::data));
    visit(m.geometry_normal, TextureUse::data);
    visit(m.geometry_coat_normal, TextureUse::data);
    for (auto& node : m.nodes)
        visit(node.texture, node.color ? TextureUse::color : TextureUse::data);
}

void mark(const MaterialDesc& m, int node, std::vector<bool>& used) {
    if (node < 0 || used[static_cast<std::size_t>(node)]) return;
    used[static_cast<std::size_t>(node)] = true;
    for (const NodeValue& v : m.nodes[static_cast<std::size_t>(node)].inputs) mark(m, v.node, used);
}

// Nodes that no input asks for lose their images.
void forget_unused_nodes(MaterialDesc& m) {
    std::vector<bool> used(m.nodes.size(), false);
    visit_inputs([&](auto member, const OpenPbrInput&) { mark(m, (m.*member).node, used); });
    for (std::size_t i = 0; i < used.size(); ++i)
        if (!used[i]) m.nodes[i].texture = -1;
}

template <class... Inputs>
void drop(Inputs&... inputs) {
    ((inputs.texture = inputs.node = -1), ...);
}

// Inputs that cannot reach the result lose their textures: they are then never loaded. Displacement
// is over before anything is shaded.
MaterialDesc folded(MaterialDesc m, bool displaced = false) {
    if (!displaced) drop(m.displacement, m.vector_displacement);
    if (zero(m.emission_luminance) || max_component(color_of(m.emission_color.value)) == 0.0f) {
        m.emission_luminance = {0};
        drop(m.emission_color);
    }
    const bool metal = one(m.base_metalness), clear = one(m.transmission_weight);
    if (metal) m.transmission_weight = m.subsurface_weight = m.base_diffuse_roughness = {0};
    if (zero(m.transmission_weight))
        drop(m.transmission_color, m.transmission_depth, m.transmission_scatter,
             m.transmission_scatter_anisotropy, m.transmission_dispersion_scale,
             m.transmission_dispersion_abbe_number);
    if (clear && zero(m.base_metalness)) drop(m.base_color, m.base_weight);
    if (clear) m.subsurface_weight = m.base_diffuse_roughness = {0};
    if (zero(m.subsurface_weight))
        drop(m.subsurface_color, m.subsurface_radius, m.subsurface_radius_scale,
             m.subsurface_scatter_anisotropy);
    if (zero(m.coat_weight)) {
        drop(m.coat_color, m.coat_roughness, m.coat_roughness_anisotropy, m.coat_ior,
             m.coat_darkening);
        m.geometry_coat_normal = -1;
    }
    if (zero(m.fuzz_weight)) drop(m.fuzz_color, m.fuzz_roughness);
    if (zero(m.thin_film_weight)) drop(m.thin_film_thickness, m.thin_film_ior);
    const bool same_index = m.specular_ior.value == 1.0f && !m.specular_ior.varies();
    const bool dielectric_boundary = !zero(m.specular_weight) && !same_index;
    if (!dielectric_boundary && zero(m.base_metalness) && zero(m.transmission_weight)) {
        drop(m.specular_color, m.specular_roughness, m.specular_roughness_anisotropy);
        m.thin_film_weight = {0};
    }
    forget_unused_nodes(m);
    return m;
}

// Within limits; what is no number is the lower one.
float kept(float x, float low, float high) { return x >= low ? std::min(x, high) : low; }
Vec3f kept(Vec3f v, float low, float high) {
    return {kept(v.x, low, high), kept(v.y, low, high), kept(v.z, low, high)};
}

template <class Input>
std::pair<float, float> limits_of(Input MaterialDesc::*wanted) {
    OpenPbrInput found{};
    visit_openpbr([&]<class Other>(Other MaterialDesc::*member, const OpenPbrInput& info) {
        if constexpr (std::is_same_v<Other, Input>) {
            if (member == wanted) found = info;
        }
    });
    return {static_cast<float>(found.low), static_cast<float>(found.high)};
}

}  // namespace

MaterialDesc remapped(MaterialDesc desc, std::span<const int> to) {
    visit_textures(desc, [&](int& texture, TextureUse) {
        if (texture >= 0) texture = to[texture];
    });
    return desc;
}

void collect_textures(const MaterialDesc& desc, std::vector<TextureUse>& use,
                      std::vector<bool>& read, bool displaced) {
    const MaterialDesc kept = folded(desc, displaced);
    visit_textures(kept, [&](int texture, TextureUse as) {
        if (texture < 0) return;
        if (!read[texture]) use[texture] = as;
        read[texture] = true;
    });
}

ShaderProgram::ShaderProgram(const MaterialDesc& desc) : m_(folded(desc)) {
    visit_textures(m_, [&](int texture, TextureUse) { facts_.textured |= texture >= 0; });
    facts_.opacity_textured = m_.geometry_opacity.texture >= 0;
    facts_.cutout = facts_.opacity_textured || m_.geometry_opacity.value < 1.0f;
    facts_.emissive = !zero(m_.emission_luminance);
    facts_.emission_textured = m_.emission_luminance.texture >= 0 || m_.emission_color.texture >= 0;
    facts_.transmission = !zero(m_.transmission_weight);
    const bool boundary =
        !zero(m_.specular_weight) && (m_.specular_ior.value != 1.0f || m_.specular_ior.varies());
    facts_.coat = !zero(m_.coat_weight);
    facts_.layers = !zero(m_.fuzz_weight) || facts_.coat || !zero(m_.thin_film_weight) ||
                    !zero(m_.base_diffuse_roughness) || !zero(m_.subsurface_weight);
    facts_.specular = facts_.transmission || !zero(m_.base_metalness) || boundary || facts_.layers;
    facts_.glass = facts_.transmission && !m_.geometry_thin_walled;
    facts_.subsurface = !zero(m_.subsurface_weight) && !m_.geometry_thin_walled;
    facts_.dispersion = facts_.glass && !zero(m_.transmission_dispersion_scale);
    facts_.uv = facts_.textured;
    facts_.tangent = m_.geometry_normal >= 0 || m_.geometry_coat_normal >= 0 ||
                     !zero(m_.specular_roughness_anisotropy) ||
                     (!zero(m_.coat_weight) && !zero(m_.coat_roughness_anisotropy));
    facts_.vertex_color = m_.use_vertex_color;

    SurfaceParams p;
    visit_params([&](auto input, auto param) {
        p.*param = constant_of(m_.*input);
        if ((m_.*input).varies()) note_varying(input, param);
    });
    for (const Varying& v : varying_) {
        // A graph that comes to a constant is one.
        if (!v.wired || v.wire.op >= 0) continue;
        const Vec3f value = kept(v.wire.constant, v.low, v.high);
        if (v.color)
            p.*v.color_param = value;
        else
            p.*v.scalar_param = value.x;
    }
    std::erase_if(varying_, [](const Varying& v) { return v.wired && v.wire.op < 0; });
    facts_.textured |= !graph_.empty();
    facts_.uv |= graph_.reads_uv();
    facts_.geometry = graph_.reads_geometry();
    facts_.vertex_color |= graph_.reads_vertex_color();
    varies_ = !varying_.empty() || m_.use_vertex_color;
    p.thin_walled = m_.geometry_thin_walled;
    constant_ = Surface(p);
    transmission_ = transmission_medium(p);
    subsurface_ = subsurface_medium(p);
    bool same_boundaries = true;
    for (const FloatInput* input :
         {&m_.specular_roughness, &m_.specular_roughness_anisotropy, &m_.specular_weight,
          &m_.specular_ior, &m_.coat_weight, &m_.coat_roughness, &m_.coat_roughness_anisotropy,
          &m_.coat_ior})
        same_boundaries &= !input->varies();
    if (same_boundaries && facts_.specular) {
        curves_ = std::make_shared<SurfaceCurves>(constant_.make_curves());
        constant_.curves = curves_.get();
    }
}

void ShaderProgram::note_varying(ColorInput MaterialDesc::*input, Color SurfaceParams::*param) {
    const auto [low, high] = limits_of(input);
    add_varying({.color = input, .color_param = param, .low = low, .high = high}, (m_.*input).node,
                (m_.*input).output);
}

void ShaderProgram::note_varying(FloatInput MaterialDesc::*input, float SurfaceParams::*param) {
    const auto [low, high] = limits_of(input);
    add_varying({.scalar = input, .scalar_param = param, .low = low, .high = high},
                (m_.*input).node, (m_.*input).output);
}

void ShaderProgram::add_varying(Varying v, int node, int output) {
    v.wired = node >= 0;
    if (v.wired) v.wire = graph_.add(m_.nodes, node, output);
    varying_.push_back(v);
}

SurfaceParams ShaderProgram::params(const ShadeInput& in,
                                    const TextureStore* store) const noexcept {
    SurfaceParams p = constant_.p;
    GraphRun run(graph_, in, store);
    for (const Varying& v : varying_) {
        if (v.color) {
            const Color c = v.wired ? run.value(v.wire) : read(m_.*v.color, in, store);
            p.*v.color_param = kept(c, v.low, v.high);
        } else {
            const float x = v.wired ? run.value(v.wire).x : read(m_.*v.scalar, in, store);
            p.*v.scalar_param = kept(x, v.low, v.high);
        }
    }
    if (m_.use_vertex_color) p.base_color *= in.vertex_color;
    return p;
}

Surface ShaderProgram::varied(const ShadeInput& in, const TextureStore* store) const noexcept {
    Surface s(params(in, store));
    s.curves = constant_.curves;
    return s;
}

Medium ShaderProgram::transmission(const ShadeInput& in, const TextureStore* store) const noexcept {
    return varying_.empty() ? transmission_ : transmission_medium(params(in, store));
}

Medium ShaderProgram::subsurface(const ShadeInput& in, const TextureStore* store) const noexcept {
    return varying_.empty() ? subsurface_ : subsurface_medium(params(in, store));
}

Color ShaderProgram::base_color(const ShadeInput& in, const TextureStore* store) const noexcept {
    if (!varies_) return constant_.p.base_color * constant_.p.base_weight;
    const SurfaceParams p = params(in, store);
    return p.base_color * p.base_weight;
}

Color ShaderProgram::emission(const ShadeInput& in, const TextureStore* store) const noexcept {
    const float radiance = read(m_.emission_luminance, in, store) * (1.0f / kLumensPerWatt);
    return max(read(m_.emission_color, in, store) * radiance, Color(0.0f));
}

Color ShaderProgram::visible_emission(const ShadeInput& in,
                                      const TextureStore* store) const noexcept {
    const Color c = emission(in, store);
    return facts_.cutout ? c * opacity(in.uv, store) : c;
}

Color ShaderProgram::mean_emission(const TextureStore* store) const noexcept {
    Color c =
        color_of(m_.emission_color.value) * (m_.emission_luminance.value * (1.0f / kLumensPerWatt));
    for (const auto& [texture, grey] : {std::pair{m_.emission_color.texture, false},
                                        std::pair{m_.emission_luminance.texture, true}}) {
        if (texture < 0) continue;
        const Texel t = store->mean(texture);
        c *= grey ? Color(channel_of(t, m_.emission_luminance.channel)) : Color{t[0], t[1], t[2]};
    }
    return max(c, Color(0.0f));
}

float ShaderProgram::opacity(Vec2f uv, const TextureStore* store) const noexcept {
    const FloatInput& o = m_.geometry_opacity;
    if (o.texture < 0) return o.value;
    const float v =
        channel_of(store->sample(o.texture, uv.x, uv.y, 0.0f), opacity_channel(o, store));
    return clamp01(o.value * (o.invert ? 1.0f - v : v));
}

Vec3f ShaderProgram::normal(const ShadeInput& in, const TextureStore* store) const noexcept {
    return mapped_normal(m_.geometry_normal, m_.geometry_normal_scale, in, store);
}

Vec3f ShaderProgram::coat_normal(const ShadeInput& in, const TextureStore* store) const noexcept {
    return mapped_normal(m_.geometry_coat_normal, m_.geometry_coat_normal_scale, in, store);
}

Vec3f ShaderProgram::mapped_normal(int texture, float scale, const ShadeInput& in,
                                   const TextureStore* store) const noexcept {
    const Texel t = store->sample(texture, in.uv.x, in.uv.y, in.uv_width);
    const Vec3f n{(2.0f * t[0] - 1.0f) * scale, (2.0f * t[1] - 1.0f) * scale,
                  std::max(2.0f * t[2] - 1.0f, 1e-3f)};
    return normalize(n);
}

}  // namespace tessera
