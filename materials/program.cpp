#include "materials/program.h"

#include <algorithm>

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

float channel_of(const Texel& t, Channel channel) {
    switch (channel) {
        case Channel::r:
            return t[0];
        case Channel::g:
            return t[1];
        case Channel::b:
            return t[2];
        case Channel::a:
            return t[3];
        case Channel::luminance:
            return luminance({t[0], t[1], t[2]});
        case Channel::automatic:
            break;
    }
    return t[0];
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

bool zero(const FloatInput& input) { return input.value == 0.0f; }
bool one(const FloatInput& input) { return input.value == 1.0f && input.texture < 0; }

// Calls visit(texture index, use) for every input; Material is MaterialDesc, const or not.
template <class Material, class Visit>
void visit_textures(Material& m, Visit visit) {
    for (auto* c : {&m.base_color, &m.specular_color, &m.transmission_color, &m.emission_color}) {
        visit(c->texture, TextureUse::color);
    }
    for (auto* f : {&m.base_weight, &m.base_metalness, &m.specular_weight, &m.specular_roughness,
                    &m.specular_roughness_anisotropy, &m.transmission_weight, &m.emission_luminance,
                    &m.geometry_opacity}) {
        visit(f->texture, TextureUse::data);
    }
    visit(m.geometry_normal, TextureUse::data);
}

// Inputs that cannot reach the result lose their textures: they are then never loaded.
MaterialDesc folded(MaterialDesc m) {
    if (zero(m.emission_luminance) || max_component(color_of(m.emission_color.value)) == 0.0f) {
        m.emission_luminance = {0};
        m.emission_color.texture = -1;
    }
    const bool metal = one(m.base_metalness), clear = one(m.transmission_weight);
    if (metal) m.transmission_weight = {0};
    if (zero(m.transmission_weight)) m.transmission_color.texture = -1;
    if (clear && zero(m.base_metalness)) m.base_color.texture = -1, m.base_weight.texture = -1;
    const bool dielectric_boundary = !zero(m.specular_weight) && m.specular_ior != 1.0f;
    if (!dielectric_boundary && zero(m.base_metalness) && zero(m.transmission_weight)) {
        m.specular_color.texture = m.specular_roughness.texture =
            m.specular_roughness_anisotropy.texture = -1;
    }
    return m;
}

}  // namespace

MaterialDesc remapped(MaterialDesc desc, std::span<const int> to) {
    visit_textures(desc, [&](int& texture, TextureUse) {
        if (texture >= 0) texture = to[texture];
    });
    return desc;
}

void collect_textures(const MaterialDesc& desc, std::vector<TextureUse>& use,
                      std::vector<bool>& read) {
    const MaterialDesc kept = folded(desc);
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
    facts_.specular = facts_.transmission || !zero(m_.base_metalness) ||
                      (!zero(m_.specular_weight) && m_.specular_ior != 1.0f);
    facts_.uv = facts_.textured;
    facts_.tangent = m_.geometry_normal >= 0 || !zero(m_.specular_roughness_anisotropy);
    facts_.vertex_color = m_.use_vertex_color;
    const auto value = [](const FloatInput& f) { return f.value; };
    SurfaceParams p;
    p.base_color = color_of(m_.base_color.value) * value(m_.base_weight);
    p.base_metalness = value(m_.base_metalness);
    p.specular_weight = value(m_.specular_weight);
    p.specular_color = color_of(m_.specular_color.value);
    p.specular_roughness = value(m_.specular_roughness);
    p.specular_roughness_anisotropy = value(m_.specular_roughness_anisotropy);
    p.specular_ior = m_.specular_ior;
    p.transmission_weight = value(m_.transmission_weight);
    p.transmission_color = color_of(m_.transmission_color.value);
    p.thin_walled = m_.geometry_thin_walled;
    const bool same_boundary = m_.specular_roughness.texture < 0 &&
                               m_.specular_roughness_anisotropy.texture < 0 &&
                               m_.specular_weight.texture < 0;
    if (same_boundary && facts_.specular && !one(m_.base_metalness) &&
        !one(m_.transmission_weight)) {
        const Surface s(p);
        boundary_ =
            std::make_shared<ReflectionAlbedoCurve>(std::sqrt(s.ggx.ax * s.ggx.ay), s.boundary_eta);
        p.boundary = boundary_.get();
    }
    constant_ = Surface(p);
}

SurfaceParams ShaderProgram::varied(const ShadeInput& in,
                                    const TextureStore* store) const noexcept {
    SurfaceParams p = constant_.p;
    p.base_color = base_color(in, store);
    if (facts_.textured) {
        if (m_.base_metalness.texture >= 0)
            p.base_metalness = clamp01(read(m_.base_metalness, in, store));
        if (m_.specular_weight.texture >= 0)
            p.specular_weight = clamp01(read(m_.specular_weight, in, store));
        if (m_.specular_color.texture >= 0) {
            p.specular_color =
                min(max(read(m_.specular_color, in, store), Color(0.0f)), Color(1.0f));
        }
        if (m_.specular_roughness.texture >= 0)
            p.specular_roughness = clamp01(read(m_.specular_roughness, in, store));
        if (m_.specular_roughness_anisotropy.texture >= 0) {
            p.specular_roughness_anisotropy =
                clamp01(read(m_.specular_roughness_anisotropy, in, store));
        }
        if (m_.transmission_weight.texture >= 0)
            p.transmission_weight = clamp01(read(m_.transmission_weight, in, store));
        if (m_.transmission_color.texture >= 0) {
            p.transmission_color =
                min(max(read(m_.transmission_color, in, store), Color(0.0f)), Color(1.0f));
        }
    }
    return p;
}

Color ShaderProgram::base_color(const ShadeInput& in, const TextureStore* store) const noexcept {
    Color c = constant_.p.base_color;
    if (m_.base_color.texture >= 0 || m_.base_weight.texture >= 0) {
        c = read(m_.base_color, in, store) * read(m_.base_weight, in, store);
        c = min(max(c, Color(0.0f)), Color(1.0f));
    }
    return facts_.vertex_color ? c * in.vertex_color : c;
}

Color ShaderProgram::emission(const ShadeInput& in, const TextureStore* store) const noexcept {
    return max(read(m_.emission_color, in, store) * read(m_.emission_luminance, in, store),
               Color(0.0f));
}

Color ShaderProgram::visible_emission(const ShadeInput& in,
                                      const TextureStore* store) const noexcept {
    const Color c = emission(in, store);
    return facts_.cutout ? c * opacity(in.uv, store) : c;
}

Color ShaderProgram::mean_emission(const TextureStore* store) const noexcept {
    Color c = color_of(m_.emission_color.value) * m_.emission_luminance.value;
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

std::optional<Vec3f> ShaderProgram::normal(const ShadeInput& in,
                                           const TextureStore* store) const noexcept {
    if (m_.geometry_normal < 0) return std::nullopt;
    const Texel t = store->sample(m_.geometry_normal, in.uv.x, in.uv.y, in.uv_width);
    const float s = m_.geometry_normal_scale;
    const Vec3f n{(2.0f * t[0] - 1.0f) * s, (2.0f * t[1] - 1.0f) * s,
                  std::max(2.0f * t[2] - 1.0f, 1e-3f)};
    return normalize(n);
}

}  // namespace tessera
