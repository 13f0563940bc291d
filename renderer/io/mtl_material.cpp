#include "renderer/io/mtl_material.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "renderer/core/vec.h"
#include "renderer/io/obj_text.h"

namespace tessera {
namespace {

constexpr float kDefaultIor = 1.5f;
constexpr float kBrightest = 1e10f;     // W/m^2/sr
constexpr float kLeastBending = 1.05f;  // below it Ni means "not set" in most files
constexpr float kMirrorNs = 1000;       // the format's largest exponent: perfectly smooth

float max_of(const Float3& c) { return std::max({c[0], c[1], c[2]}); }

Channel channel_of(const MtlTexture& texture) {
    switch (texture.channel) {
        case 'r':
            return Channel::r;
        case 'g':
            return Channel::g;
        case 'b':
            return Channel::b;
        case 'l':
            return Channel::luminance;
        default:
            return Channel::automatic;
    }
}

class Mapper {
public:
    Mapper(MtlValues values, const MtlContext& context)
        : v_(std::move(values)), context_(&context) {}
    MaterialDesc map();

private:
    bool has(std::string_view key) const { return context_->block->given.contains(key); }
    std::uint32_t line(std::string_view key) const;
    void note(std::string_view key, const char* text) const;
    void limit(const char* key, float& value, float low, float high) const;
    void limit(const char* key, Float3& value, float high) const;
    int texture(const char* key, const MtlTexture& texture) const;
    void check();
    void base();
    void specular();
    void mirror();
    void glass();
    void emission();
    void opacity(bool is_glass);
    void maps();
    float roughness_or(float otherwise) const;

    MtlValues v_;
    const MtlContext* context_;
    MaterialDesc out_;
};

std::uint32_t Mapper::line(std::string_view key) const {
    const auto found = context_->block->given.find(key);
    return found == context_->block->given.end() ? 0 : found->second;
}

void Mapper::note(std::string_view key, const char* text) const {
    context_->tally->note(text, line(key), "(material '" + context_->name + "')");
}

void Mapper::limit(const char* key, float& value, float low, float high) const {
    if (value >= low && value <= high) return;
    std::ostringstream text;
    text << "material '" << context_->name << "': " << key << " is " << value << ", must be in ["
         << low << ", " << high << "]";
    context_->tally->add("value clamped:", line(key), text.str());
    value = value > low ? high : low;
}

void Mapper::limit(const char* key, Float3& value, float high) const {
    for (float& channel : value) limit(key, channel, 0, high);
}

int Mapper::texture(const char* key, const MtlTexture& texture) const {
    return texture.file.empty() ? -1 : context_->texture(texture, line(key));
}

void Mapper::check() {
    limit("Kd", v_.kd, 1);
    limit("Ks", v_.ks, 1);
    limit("Ke", v_.ke, kBrightest);
    limit("Tf", v_.tf, 1);
    limit("d", v_.d, 0, 1);
    if (has("Ns")) limit("Ns", v_.ns, 0, 1e6f);
    if (has("Ni")) limit("Ni", v_.ni, 0.001f, 10);
    if (has("illum") && (v_.illum < 0 || v_.illum > 10)) {
        context_->tally->add("illum must be in [0, 10], 2 is used:", line("illum"),
                             "'" + context_->name + "'");
        v_.illum = 2;
    }
    if (has("Pr")) limit("Pr", v_.pr, 0, 1);
    if (has("Pm")) limit("Pm", v_.pm, 0, 1);
    if (has("aniso")) limit("aniso", v_.aniso, 0, 1);
    if (has("Ps")) limit("Ps", v_.ps, 0, 1);
    if (has("Pc")) limit("Pc", v_.pc, 0, 1);
    if (has("Pcr")) limit("Pcr", v_.pcr, 0, 1);
}

float Mapper::roughness_or(float otherwise) const {
    if (has("Pr")) return v_.pr;
    if (!has("Ns")) return otherwise;
    return v_.ns >= kMirrorNs && otherwise == 0 ? 0 : roughness_from_phong(v_.ns);
}

void Mapper::base() {
    out_.base_color.value = v_.kd;
    if (!has("Kd"))
        out_.base_color.value = has("map_Kd") ? Float3{1, 1, 1} : Float3{0.8f, 0.8f, 0.8f};
    out_.base_color.texture = texture("map_Kd", v_.map_kd);
    if (has("Kd") && has("map_Kd") && max_of(v_.kd) == 0) {
        note("Kd", "Kd 0 would hide map_Kd; 1 is used");
        out_.base_color.value = {1, 1, 1};
    }
}

// Ks is a highlight colour without a unit. Twice its largest channel, at most 1, becomes
// specular_weight: Ks 0.5, which modellers write for an ordinary surface, is the plain dielectric.
// Fresnel reflection takes its share from the base, so no choice of Kd and Ks gains energy.
void Mapper::specular() {
    const bool pbr = has("Pr") || has("Pm") || has("map_Pr") || has("map_Pm");
    const bool highlight = !has("illum") || v_.illum >= 2;
    const float ks = has("Ks") && highlight ? max_of(v_.ks) : 0;
    out_.specular_weight.value = ks > 0 ? std::min(1.0f, 2 * ks) : (pbr ? 1.0f : 0.0f);
    if (ks > 0) {
        out_.specular_color.value = {v_.ks[0] / ks, v_.ks[1] / ks, v_.ks[2] / ks};
        out_.specular_color.texture = texture("map_Ks", v_.map_ks);
    }
    out_.specular_ior.value = has("Ni") && v_.ni > kLeastBending ? v_.ni : kDefaultIor;
    out_.specular_roughness.value = roughness_or(0.3f);
    out_.base_metalness.value = v_.pm;
    if (v_.pm > 0 || has("map_Pm")) {
        // specular_weight scales a metal's reflection too: it would turn it dark.
        out_.specular_weight.value = 1;
        out_.specular_color = ColorInput{{1, 1, 1}};
    }
    out_.specular_roughness_anisotropy.value = v_.aniso;
    out_.coat_weight.value = v_.pc;
    out_.coat_roughness.value = v_.pcr;
    out_.fuzz_weight.value = v_.ps;
}

void Mapper::mirror() {
    out_.base_metalness.value = 1;
    out_.base_color.value = has("Ks") ? v_.ks : Float3{1, 1, 1};
    out_.base_color.texture = texture("map_Ks", v_.map_ks);
    out_.specular_weight.value = 1;
    out_.specular_roughness.value = roughness_or(0);
}

void Mapper::glass() {
    out_.transmission_weight.value = 1;
    if (has("Tf")) out_.transmission_color.value = v_.tf;
    out_.specular_weight.value = 1;
    out_.specular_ior.value = has("Ni") ? v_.ni : kDefaultIor;
    out_.specular_roughness.value = roughness_or(0);
}

void Mapper::emission() {
    const float peak = max_of(v_.ke);
    if (peak > 0) {
        out_.emission_luminance.value = peak * kLumensPerWatt;
        out_.emission_color.value = {v_.ke[0] / peak, v_.ke[1] / peak, v_.ke[2] / peak};
    }
    if (has("map_Ke")) {
        out_.emission_color.texture = texture("map_Ke", v_.map_ke);
        if (peak == 0)
            out_.emission_luminance.value =
                out_.emission_color.texture >= 0 ? kLumensPerWatt : 0.0f;
        if (peak == 0 && has("Ke")) note("Ke", "Ke 0 would hide map_Ke; 1 is used");
    }
    const std::string lower = to_lower(context_->name);
    const bool lamp =
        lower.find("light") != std::string::npos || lower.find("lamp") != std::string::npos;
    if (lamp && has("Ka") && !has("Ke") && !has("map_Ke") && max_of(v_.ka) > 0)
        context_->tally->add("Ka is not emission; use Ke to make it a light:", line("Ka"),
                             "'" + context_->name + "'");
}

void Mapper::opacity(bool is_glass) {
    if (!is_glass) out_.geometry_opacity.value = v_.d;
    if (has("Tr") && !has("d") && v_.d == 0 && !has("map_d"))
        note("Tr", "Tr 1 makes it invisible (Tr = 1 - d; some writers mean d)");
    const bool inverted = has("map_Tr");
    if (!has("map_d") && !inverted) return;
    FloatInput& opacity = out_.geometry_opacity;
    opacity.texture = texture(inverted ? "map_Tr" : "map_d", v_.map_d);
    opacity.channel = channel_of(v_.map_d);
    opacity.invert = inverted;
    if (v_.map_d.file == v_.map_kd.file) opacity.channel = Channel::a;
    if (opacity.value == 0 && opacity.texture >= 0) {
        note("d", "d 0 would hide map_d; 1 is used");
        opacity.value = 1;
    }
}

void Mapper::maps() {
    if (has("map_Pr")) {
        out_.specular_roughness.texture = texture("map_Pr", v_.map_pr);
        out_.specular_roughness.channel = channel_of(v_.map_pr);
        if (out_.specular_roughness.texture >= 0)
            out_.specular_roughness.value = v_.pr > 0 ? v_.pr : 1;
    }
    if (has("map_Pm")) {
        out_.base_metalness.texture = texture("map_Pm", v_.map_pm);
        out_.base_metalness.channel = channel_of(v_.map_pm);
        out_.base_metalness.value =
            out_.base_metalness.texture < 0 ? v_.pm : (v_.pm > 0 ? v_.pm : 1);
    }
    if (has("map_Ps")) {
        out_.fuzz_weight.texture = texture("map_Ps", v_.map_ps);
        out_.fuzz_weight.channel = channel_of(v_.map_ps);
        if (out_.fuzz_weight.texture >= 0) out_.fuzz_weight.value = v_.ps > 0 ? v_.ps : 1;
    }
    if (has("disp")) {
        out_.displacement.texture = texture("disp", v_.disp);
        out_.displacement.channel = channel_of(v_.disp);
        out_.displacement.value = out_.displacement.texture >= 0 ? 1.0f : 0.0f;
    }
    const bool bump_is_normal = to_lower(v_.bump.file).find("norm") != std::string::npos;
    if (has("bump") && !bump_is_normal && !has("norm")) {
        // The format gives no unit: white is a hundredth of the texture's width high.
        constexpr float kHeight = 0.01f;
        out_.bump.texture = texture("bump", v_.bump);
        out_.bump.channel = channel_of(v_.bump);
        out_.bump.value = out_.bump.texture >= 0 ? kHeight * v_.bump.bump : 0.0f;
        out_.bump_in_uv = true;
    }
    if (has("bump") && bump_is_normal && !has("norm"))
        note("bump", "bump file is taken for a normal map by its name");
    const bool use_bump = !has("norm") && has("bump") && bump_is_normal;
    const MtlTexture& normal = use_bump ? v_.bump : v_.norm;
    out_.geometry_normal.texture = texture(use_bump ? "bump" : "norm", normal);
    if (out_.geometry_normal.given()) {
        const float scale = normal.bump;
        out_.geometry_normal.scale = scale >= 0 && scale <= 10 ? scale : 1;
    }
}

MaterialDesc Mapper::map() {
    out_.name = context_->name;
    check();
    if (has("d") && has("Tr")) {
        context_->tally->add("both d and Tr given, d counts:", line("Tr"),
                             "'" + context_->name + "'");
    }
    const int illum = has("illum") ? v_.illum : 2;
    const bool refracts = illum == 4 || illum == 6 || illum == 7 || illum == 9;
    // Ni 1 bends nothing: with d below 1 the writer meant see-through, with d 1 a plain surface.
    const bool is_glass = refracts && (has("Ni") ? v_.ni > kLeastBending : v_.d == 1);
    base();
    specular();
    if (illum == 3 || illum == 5) mirror();
    if (is_glass) glass();
    if (refracts && !is_glass && v_.d == 1 && !has("map_d"))
        note("illum", "glass by illum, but Ni is about 1 and d is 1: taken as opaque");
    emission();
    opacity(is_glass);
    maps();
    return std::move(out_);
}

}  // namespace

MaterialDesc map_mtl(MtlValues values, const MtlContext& context) {
    return Mapper(std::move(values), context).map();
}

float roughness_from_phong(float ns) noexcept { return std::sqrt(std::sqrt(2 / (ns + 2))); }

}  // namespace tessera
