#include "materials/program.h"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "materials/lobe.h"
#include "materials/relief.h"
#include "materials/surface/params_of.h"
#include "materials/texel.h"
#include "renderer/api/openpbr_inputs.h"
#include "renderer/core/sampler.h"

namespace tessera {
namespace {

Color color_of(Float3 c) { return {c[0], c[1], c[2]}; }

Color read(const ColorInput& input, const ShadeInput& in, const TextureStore* store) {
    Color c = color_of(input.value);
    if (input.texture >= 0) {
        const Texel t = store->sample(input.texture, in.uv.x, in.uv.y, in.uv_width, in.seed);
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
    const Texel t = store->sample(input.texture, in.uv.x, in.uv.y, in.uv_width, in.seed);
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
    visit(m.geometry_normal.texture, TextureUse::data);
    visit(m.geometry_coat_normal.texture, TextureUse::data);
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
    for (const NormalInput* input : {&m.geometry_normal, &m.geometry_coat_normal,
                                     &m.geometry_tangent, &m.geometry_coat_tangent})
        mark(m, input->node, used);
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
        m.geometry_coat_normal = m.geometry_coat_tangent = {};
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

std::vector<TextureRead> textures_of(const MaterialDesc& desc, bool displaced) {
    std::vector<TextureRead> reads;
    const MaterialDesc kept = folded(desc, displaced);
    visit_textures(kept, [&](int texture, TextureUse as) {
        if (texture >= 0) reads.push_back({texture, as});
    });
    return reads;
}

ShaderProgram::ShaderProgram(const MaterialDesc& desc) : m_(folded(desc)) {
    CurveCache own;
    compile(own);
}

ShaderProgram::ShaderProgram(const MaterialDesc& desc, CurveCache& cache) : m_(folded(desc)) {
    compile(cache);
}

void ShaderProgram::compile(CurveCache& cache) {
    visit_textures(m_, [&](int texture, TextureUse) { facts_.textured |= texture >= 0; });
    compile_opacity();
    compile_emission();
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
    facts_.tangent = !zero(m_.specular_roughness_anisotropy) ||
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
    compile_relief();
    for (const Graph* graph : {&graph_, &relief_, &opacity_graph_, &emission_graph_}) {
        facts_.textured |= !graph->empty();
        facts_.uv |= graph->reads_uv();
        facts_.geometry |= graph->reads_geometry();
        facts_.tangent |= graph->reads_tangent();
        facts_.crease_angle_deg = std::min(facts_.crease_angle_deg, graph->crease_angle_deg());
        facts_.vertex_color |= graph->reads_vertex_color();
    }
    varies_ = !varying_.empty() || m_.use_vertex_color;
    compile_covering();
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
        auto& known = cache[constant_.curve_key()];
        if (!known) known = std::make_shared<const SurfaceCurves>(constant_.make_curves());
        curves_ = known;
        constant_.curves = curves_.get();
    }
}

void ShaderProgram::compile_relief() {
    const auto add = [&](const auto& input) {
        return input.node >= 0 ? relief_.add(m_.nodes, input.node, input.output) : Wire{};
    };
    normal_ = add(m_.geometry_normal);
    coat_normal_ = add(m_.geometry_coat_normal);
    tangent_ = add(m_.geometry_tangent);
    coat_tangent_ = add(m_.geometry_coat_tangent);
    bump_ = add(m_.bump);
    // A height that is the same everywhere is none.
    if (m_.bump.node >= 0 && bump_.op < 0) m_.bump = {0};
    facts_.bends_normal = m_.geometry_normal.given() || m_.bump.varies();
    facts_.bends_coat_normal = m_.geometry_coat_normal.given();
    facts_.turns_tangent = m_.geometry_tangent.given();
    facts_.turns_coat_tangent = m_.geometry_coat_tangent.given();
    const bool bends = bends_normal() || bends_coat_normal(),
               turns = turns_tangent() || turns_coat_tangent();
    facts_.tangent |= bends || turns;
    facts_.geometry |= turns || m_.bump.varies();
    facts_.textured |= bends || turns;
}

void ShaderProgram::compile_opacity() {
    const FloatInput& input = m_.geometry_opacity;
    if (input.node >= 0) opacity_ = opacity_graph_.add(m_.nodes, input.node, input.output);
    facts_.opacity_textured = input.varies();
    facts_.opacity_geometry = opacity_graph_.reads_geometry() || opacity_graph_.reads_tangent() ||
                              opacity_graph_.reads_vertex_color();
    facts_.cutout = facts_.opacity_textured || input.value < 1.0f;
}

void ShaderProgram::compile_emission() {
    const FloatInput& luminance = m_.emission_luminance;
    const ColorInput& color = m_.emission_color;
    if (luminance.node >= 0)
        emission_luminance_ = emission_graph_.add(m_.nodes, luminance.node, luminance.output);
    if (color.node >= 0) emission_color_ = emission_graph_.add(m_.nodes, color.node, color.output);
    facts_.emissive = !zero(luminance);
    facts_.emission_by_hit =
        emission_graph_.reads_attributes() || (facts_.cutout && opacity_graph_.reads_attributes());
    emission_varies_ = luminance.varies() || color.varies();
    if (!emission_varies_) constant_emission_ = bare_emission({}, nullptr);
    facts_.emission_textured = emission_varies_;
    facts_.emission_geometry = emission_graph_.reads_geometry() ||
                               emission_graph_.reads_tangent() ||
                               emission_graph_.reads_vertex_color();
}

// Both ways of finding the light must see it through the same layers: what light sampling cannot
// read of them makes the emission one that is found by hits alone.
void ShaderProgram::compile_covering() {
    facts_.emission_covered = facts_.emissive && (facts_.coat || !zero(m_.fuzz_weight));
    if (!facts_.emission_covered) return;
    covering_varies_ = m_.coat_color.varies();
    for (const FloatInput* input :
         {&m_.coat_weight, &m_.coat_roughness, &m_.coat_roughness_anisotropy, &m_.coat_ior,
          &m_.fuzz_weight, &m_.fuzz_roughness, &m_.transmission_weight, &m_.base_metalness})
        covering_varies_ |= input->varies();
    if (!covering_varies_) return;
    facts_.emission_textured = true;
    facts_.emission_by_hit |= graph_.reads_attributes();
    facts_.emission_geometry |=
        graph_.reads_geometry() || graph_.reads_tangent() || graph_.reads_vertex_color();
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

Color ShaderProgram::emission(const ShadeInput& in, const TextureStore* store,
                              float outward) const noexcept {
    const Color bare = emission_varies_ ? bare_emission(in, store) : constant_emission_;
    if (!facts_.emission_covered) return bare;
    const auto covered = [&](const Surface& s) {
        return bare * s.covering(std::fabs(outward), outward >= 0.0f);
    };
    return covering_varies_ ? covered(varied(in, store)) : covered(constant_);
}

Color ShaderProgram::bare_emission(const ShadeInput& in, const TextureStore* store) const noexcept {
    constexpr float kMost = 1e20f;
    GraphRun run(emission_graph_, in, store);
    const float luminance = m_.emission_luminance.node >= 0
                                ? run.value(emission_luminance_).x
                                : read(m_.emission_luminance, in, store);
    const Color color = m_.emission_color.node >= 0 ? run.value(emission_color_)
                                                    : read(m_.emission_color, in, store);
    return kept(color, 0.0f, kMost) * (kept(luminance, 0.0f, kMost) * (1.0f / kLumensPerWatt));
}

Color ShaderProgram::visible_emission(const ShadeInput& in, const TextureStore* store,
                                      float outward) const noexcept {
    // Two ways out: a copy of what was returned would wait for its parts.
    if (!facts_.cutout) return emission(in, store, outward);
    return emission(in, store, outward) * opacity(in, store);
}

// Of a graph: the mean over points of its texture and object space. It only decides how often a
// light is asked, so that it must not be nothing.
Color ShaderProgram::mean_emission_of_graph(const TextureStore* store) const noexcept {
    constexpr int kPoints = 256;
    Color sum(0.0f);
    for (int i = 0; i < kPoints; ++i) {
        const auto at = [&](std::uint32_t axis) {
            return static_cast<float>(hash_combine(axis, static_cast<std::uint32_t>(i)) >> 8) *
                   0x1p-24f;
        };
        ShadeInput in;
        in.uv = {at(1), at(2)};
        in.p_object = in.p_world = Vec3f{at(3), at(4), at(5)} * 2.0f - Vec3f(1.0f);
        in.n = {0, 0, 1};
        sum += bare_emission(in, store);
    }
    const Color mean = sum * (1.0f / kPoints);
    return max_component(mean) > 0.0f ? mean : Color(1.0f / kLumensPerWatt);
}

Color ShaderProgram::mean_emission(const TextureStore* store) const noexcept {
    if (!emission_graph_.empty()) return mean_emission_of_graph(store);
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

float ShaderProgram::opacity(const ShadeInput& in, const TextureStore* store) const noexcept {
    const FloatInput& o = m_.geometry_opacity;
    if (o.node >= 0) return kept(GraphRun(opacity_graph_, in, store).value(opacity_).x, 0.0f, 1.0f);
    if (o.texture < 0) return o.value;
    const float v = channel_of(store->sample(o.texture, in.uv.x, in.uv.y, 0.0f, in.seed),
                               opacity_channel(o, store));
    return clamp01(o.value * (o.invert ? 1.0f - v : v));
}

Vec3f ShaderProgram::normal(const ShadeInput& in, const TextureStore* store) const noexcept {
    Vec3f n = mapped_normal(m_.geometry_normal, normal_, in, store);
    if (!m_.bump.varies()) return n;
    const float unit = m_.bump_in_uv ? texture_unit(in) : object_unit(in);
    return bumped_normal(n, in, unit, [&](const ShadeInput& at) {
        return m_.bump.node >= 0 ? GraphRun(relief_, at, store).value(bump_).x
                                 : read(m_.bump, at, store);
    });
}

Vec3f ShaderProgram::coat_normal(const ShadeInput& in, const TextureStore* store) const noexcept {
    return mapped_normal(m_.geometry_coat_normal, coat_normal_, in, store);
}

Vec3f ShaderProgram::tangent(const ShadeInput& in, const TextureStore* store) const noexcept {
    return GraphRun(relief_, in, store).value(tangent_);
}

Vec3f ShaderProgram::coat_tangent(const ShadeInput& in, const TextureStore* store) const noexcept {
    return GraphRun(relief_, in, store).value(coat_tangent_);
}

Vec3f ShaderProgram::mapped_normal(const NormalInput& input, const Wire& wire, const ShadeInput& in,
                                   const TextureStore* store) const noexcept {
    if (input.node >= 0) {
        const Vec3f n = GraphRun(relief_, in, store).value(wire);
        const float l2 = length2(n);
        return l2 > 0.0f && std::isfinite(l2) ? n * (1.0f / std::sqrt(l2)) : in.n;
    }
    if (input.texture < 0) return in.n;
    const Texel t = store->sample(input.texture, in.uv.x, in.uv.y, in.uv_width, in.seed);
    const Vec3f local = unpacked_normal({t[0], t[1], t[2]}, input.scale);
    return normal_from_tangent_space(in, {local.x, input.flip_y ? -local.y : local.y, local.z});
}

}  // namespace tessera
