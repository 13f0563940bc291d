// Autodesk Standard Surface (Georgiev et al., 2019) by the inputs of OpenPBR.

#include <algorithm>
#include <cmath>

#include "renderer/io/mtlx_surface.h"
#include "renderer/io/scene_layers.h"

namespace tessera {
namespace {

using M = MaterialDesc;
using N = NodeOp;

const std::vector<std::string> kInputs{"base",
                                       "base_color",
                                       "diffuse_roughness",
                                       "metalness",
                                       "specular",
                                       "specular_color",
                                       "specular_roughness",
                                       "specular_IOR",
                                       "specular_anisotropy",
                                       "specular_rotation",
                                       "transmission",
                                       "transmission_color",
                                       "transmission_depth",
                                       "transmission_scatter",
                                       "transmission_scatter_anisotropy",
                                       "transmission_dispersion",
                                       "transmission_extra_roughness",
                                       "subsurface",
                                       "subsurface_color",
                                       "subsurface_radius",
                                       "subsurface_scale",
                                       "subsurface_anisotropy",
                                       "sheen",
                                       "sheen_color",
                                       "sheen_roughness",
                                       "coat",
                                       "coat_color",
                                       "coat_roughness",
                                       "coat_anisotropy",
                                       "coat_rotation",
                                       "coat_IOR",
                                       "coat_normal",
                                       "coat_affect_color",
                                       "coat_affect_roughness",
                                       "thin_film_thickness",
                                       "thin_film_IOR",
                                       "emission",
                                       "emission_color",
                                       "opacity",
                                       "thin_walled",
                                       "normal",
                                       "tangent"};

class StandardSurface {
public:
    StandardSurface(MtlxGraph& graph, const MtlxGraph::NodeAt& shader)
        : graph_(graph), shader_(shader), in_(graph, shader) {}

    void read() {
        in_.check_names(kInputs);
        // 1.0.1 of the shader changed these two defaults.
        const std::string* version = shader_.node.find("version");
        const bool old = version && *version == "1.0.0";
        read_base(old ? 0.8f : 1.0f, old ? 1.0f : 0.8f);
        read_specular();
        read_inside();
        read_layers();
        read_emission();
        read_geometry();
    }

private:
    const SourceLoc& loc() const { return shader_.node.loc; }
    MtlxValue like(const MtlxValue& value, const NodeValue& rgb) {
        MtlxValue out = value;
        out.rgb = rgb;
        return out;
    }
    static bool zero(const MtlxValue& v) {
        return v.is_constant() && v.rgb.value == Float3{0, 0, 0};
    }
    template <class F>
    MtlxValue mapped(const MtlxValue& value, F of_constant, NodeOp op, float second) {
        if (!value.is_constant())
            return like(value, graph_.emit(op, {value.rgb, node_constant(second)}, loc()));
        MtlxValue out = value;
        for (float& x : out.rgb.value) x = of_constant(x);
        return out;
    }

    /// A colour under a coat that saturates it: color^(1 + coat coat_affect_color).
    MtlxValue under_coat(const MtlxValue& color) {
        const MtlxValue coat = in_.number("coat", 0), affect = in_.number("coat_affect_color", 0);
        if (zero(coat) || zero(affect)) return color;
        if (color.is_constant() && coat.is_constant() && affect.is_constant()) {
            MtlxValue out = color;
            const float gamma = 1 + std::clamp(coat.rgb.value[0], 0.0f, 1.0f) * affect.rgb.value[0];
            for (float& x : out.rgb.value) x = std::pow(std::max(x, 0.0f), gamma);
            return out;
        }
        const NodeValue both = graph_.emit(N::multiply, {coat.rgb, affect.rgb}, loc());
        const NodeValue gamma = graph_.emit(N::add, {both, node_constant(1)}, loc());
        return like(color, graph_.emit(N::power, {color.rgb, gamma}, loc()));
    }

    void read_base(float base, float grey) {
        in_.set(&M::base_weight, in_.number("base", base));
        const MtlxValue color = in_.color("base_color", {grey, grey, grey});
        in_.set(&M::base_color, under_coat(color));
        in_.set(&M::base_diffuse_roughness, in_.number("diffuse_roughness", 0));
        in_.set(&M::base_metalness, in_.number("metalness", 0));
    }

    /// Standard Surface's specular and specular_color tint a metal's edge only; OpenPBR's weight
    /// dims all of it, and its colour is that at 82 degrees.
    void read_specular() {
        const MtlxValue weight = in_.number("specular", 1), metalness = in_.number("metalness", 0);
        const MtlxValue color = in_.color("specular_color", {1, 1, 1});
        const MaterialDesc& m = graph_.material();
        const bool metal = metalness.is_constant() && metalness.rgb.value[0] >= 1;
        if (metal) {
            in_.set(&M::specular_weight, like(weight, node_constant(1)));
            const bool written = weight.is_constant() && color.is_constant() &&
                                 !m.base_color.varies() && !m.base_weight.varies();
            MtlxValue edge = color;
            for (std::size_t i = 0; i < 3; ++i)
                edge.rgb.value[i] =
                    written ? f82_of_edge_tint(m.base_color.value[i] * m.base_weight.value,
                                               weight.rgb.value[0] * color.rgb.value[i])
                            : 1.0f;
            edge.rgb.node = -1;
            in_.set(&M::specular_color, edge);
        } else {
            MtlxValue share = weight;
            if (!metalness.is_constant())
                share.rgb = graph_.emit(
                    N::ifgreater, {metalness.rgb, node_constant(0), node_constant(1), weight.rgb},
                    loc());
            else if (metalness.rgb.value[0] > 0)
                share.rgb = node_constant(1);
            in_.set(&M::specular_weight, share);
            in_.set(&M::specular_color, color);
        }
        in_.set(&M::specular_roughness, coated_roughness(in_.number("specular_roughness", 0.2f)));
        // Any number is allowed there, and 0 is met where specular is 0 too.
        const MtlxValue index = in_.number("specular_IOR", 1.5f);
        const bool unused = zero(weight) && !metal && zero(in_.number("transmission", 0));
        if (!unused || !index.is_constant()) in_.set(&M::specular_ior, index);
        read_anisotropy("specular_anisotropy", "specular_rotation",
                        &M::specular_roughness_anisotropy, &M::geometry_tangent);
    }

    /// A rough coat may roughen what lies below: towards 1 by coat, its roughness and
    /// coat_affect_roughness.
    MtlxValue coated_roughness(const MtlxValue& roughness) {
        const MtlxValue coat = in_.number("coat", 0);
        const MtlxValue affect = in_.number("coat_affect_roughness", 0);
        const MtlxValue own = in_.number("coat_roughness", 0.1f);
        if (zero(coat) || zero(affect) || zero(own)) return roughness;
        if (roughness.is_constant() && coat.is_constant() && affect.is_constant() &&
            own.is_constant()) {
            const float share =
                std::clamp(coat.rgb.value[0] * affect.rgb.value[0] * own.rgb.value[0], 0.0f, 1.0f);
            return mapped(
                roughness, [&](float r) { return r + (1 - r) * share; }, N::add, 0);
        }
        NodeValue share = graph_.emit(N::multiply, {coat.rgb, affect.rgb}, loc());
        share = graph_.emit(N::multiply, {share, own.rgb}, loc());
        return like(roughness,
                    graph_.emit(N::mix, {node_constant(1), roughness.rgb, share}, loc()));
    }

    /// Rotation is in turns about the normal, the other way round as MaterialX's nodes turn.
    void read_anisotropy(std::string_view amount, std::string_view rotation,
                         FloatInput MaterialDesc::*member, NormalInput MaterialDesc::*tangent) {
        const MtlxValue value = in_.number(amount, 0);
        in_.set(member, value);
        in_.set_normal("tangent", tangent);
        const MtlxValue turn = in_.number(rotation, 0);
        const float half_turns = turn.rgb.value[0] * 2;  // half a turn changes nothing
        const bool turned = !turn.is_constant() || half_turns != std::floor(half_turns);
        if (!turned || zero(value)) return;
        const auto given = in_.given("tangent");
        const NodeValue along = given ? given->rgb : graph_.emit(N::tangent, {}, loc());
        const NodeValue degrees = graph_.product(turn.rgb, -360, loc());
        const NodeValue normal = graph_.emit(N::normal, {}, loc());
        set_input(graph_.material().*tangent,
                  graph_.emit(N::rotate3d, {along, degrees, normal}, loc()));
    }

    void read_inside() {
        in_.set(&M::transmission_weight, in_.number("transmission", 0));
        in_.set(&M::transmission_color, in_.color("transmission_color", {1, 1, 1}));
        in_.set(&M::transmission_depth, in_.number("transmission_depth", 0));
        in_.set(&M::transmission_scatter, in_.color("transmission_scatter", {0, 0, 0}));
        in_.set(&M::transmission_scatter_anisotropy,
                in_.number("transmission_scatter_anisotropy", 0));
        if (!zero(in_.number("transmission_extra_roughness", 0)))
            in_.unsupported("transmission_extra_roughness");
        read_dispersion();

        in_.set(&M::subsurface_weight, in_.number("subsurface", 0));
        in_.set(&M::subsurface_color, under_coat(in_.color("subsurface_color", {1, 1, 1})));
        in_.set(&M::subsurface_scatter_anisotropy, in_.number("subsurface_anisotropy", 0));
        MtlxValue scale = in_.number("subsurface_scale", 1);
        MtlxValue radius = in_.color("subsurface_radius", {1, 1, 1});
        // Radii beyond 1 are lengths as they are; OpenPBR keeps the colour within it.
        const Float3& r = radius.rgb.value;
        const float most = std::max({r[0], r[1], r[2]});
        if (radius.is_constant() && most > 1) {
            scale.rgb = graph_.product(scale.rgb, most, loc());
            for (float& x : radius.rgb.value) x /= most;
        }
        in_.set(&M::subsurface_radius, scale);
        in_.set(&M::subsurface_radius_scale, radius);
    }

    /// An Abbe number, 0 for none; OpenPBR's is within 9 and 91, its scale goes beyond.
    void read_dispersion() {
        const MtlxValue abbe = in_.number("transmission_dispersion", 0);
        if (zero(abbe)) return;
        if (!abbe.is_constant() || abbe.rgb.value[0] < 0)
            return in_.unsupported("transmission_dispersion", "must be a written number, ignored");
        const float number = std::clamp(abbe.rgb.value[0], 9.0f, 91.0f);
        in_.set(&M::transmission_dispersion_abbe_number, like(abbe, node_constant(number)));
        const float share = std::min(1.0f, number / abbe.rgb.value[0]);
        in_.set(&M::transmission_dispersion_scale, like(abbe, node_constant(share)));
    }

    void read_layers() {
        in_.set(&M::fuzz_weight, in_.number("sheen", 0));
        in_.set(&M::fuzz_color, in_.color("sheen_color", {1, 1, 1}));
        // The exponent by which MaterialX's own translation to OpenPBR matches the two lobes.
        in_.set(&M::fuzz_roughness,
                mapped(
                    in_.number("sheen_roughness", 0.3f),
                    [](float r) { return std::pow(std::max(r, 0.0f), 0.4f); }, N::power, 0.4f));
        in_.set(&M::coat_weight, in_.number("coat", 0));
        in_.set(&M::coat_color, in_.color("coat_color", {1, 1, 1}));
        in_.set(&M::coat_roughness, in_.number("coat_roughness", 0.1f));
        read_anisotropy("coat_anisotropy", "coat_rotation", &M::coat_roughness_anisotropy,
                        &M::geometry_coat_tangent);
        in_.set(&M::coat_ior, in_.number("coat_IOR", 1.5f));
        in_.set(&M::coat_darkening, in_.number("", 0));  // coat_affect_color stands for it

        const MtlxValue thickness = in_.number("thin_film_thickness", 0);  // nanometres
        if (zero(thickness)) return;
        in_.set(&M::thin_film_weight, in_.number("", 1));
        in_.set(&M::thin_film_thickness,
                like(thickness, graph_.product(thickness.rgb, 1e-3f, loc())));
        in_.set(&M::thin_film_ior, in_.number("thin_film_IOR", 1.5f));
    }

    void read_emission() {
        const MtlxValue weight = in_.number("emission", 0);
        if (zero(weight)) return;
        // Its unit is radiance; ours is nits.
        in_.set(&M::emission_luminance,
                like(weight, graph_.product(weight.rgb, kLumensPerWatt, loc())));
        in_.set(&M::emission_color, in_.color("emission_color", {1, 1, 1}));
    }

    void read_geometry() {
        in_.set_thin_walled("thin_walled");
        in_.set_normal("normal", &M::geometry_normal);
        in_.set_normal("coat_normal", &M::geometry_coat_normal);
        read_opacity();
    }

    /// A colour there, a number here: its luminance.
    void read_opacity() {
        const MtlxValue color = in_.color("opacity", {1, 1, 1});
        MtlxValue grey = color;
        grey.type = MtlxType::scalar;
        const Float3& c = color.rgb.value;
        if (color.is_constant()) {
            const bool even = c[0] == c[1] && c[1] == c[2];
            const float y = 0.2126f * c[0] + 0.7152f * c[1] + 0.0722f * c[2];
            grey.rgb = node_constant(even ? c[0] : y);
            if (!even) in_.unsupported("opacity", "is coloured, its luminance is used");
            return in_.set(&M::geometry_opacity, grey);
        }
        const auto image = plain_image(graph_, color.rgb);
        const bool even =
            image && image->factor[0] == image->factor[1] && image->factor[1] == image->factor[2];
        if (!even) {
            grey.rgb = graph_.emit(N::luminance, {color.rgb}, loc());
            return in_.set(&M::geometry_opacity, grey);
        }
        const bool whole = image->channel == Channel::automatic;
        graph_.material().geometry_opacity = {image->factor[0], image->texture,
                                              whole ? Channel::luminance : image->channel,
                                              image->invert};
    }

    MtlxGraph& graph_;
    const MtlxGraph::NodeAt& shader_;
    MtlxInputs in_;
};

}  // namespace

void read_standard_surface(MtlxGraph& graph, const MtlxGraph::NodeAt& shader) {
    StandardSurface(graph, shader).read();
}

// Gulbrandsen, "Artist Friendly Metallic Fresnel", 2014: n and k from the two; then the exact
// reflectance of a conductor against Schlick's curve where Kutz, Hasan and Edmondson 2021 compare
// them, at cos = 1/7.
float f82_of_edge_tint(float reflectivity, float edge_tint) noexcept {
    const double r = std::clamp(double(reflectivity), 0.0, 0.999);
    const double g = std::clamp(double(edge_tint), 0.0, 1.0);
    const double root = std::sqrt(r);
    const double n = g * (1 - r) / (1 + r) + (1 - g) * (1 + root) / (1 - root);
    const double k2 = std::max(0.0, (r * (n + 1) * (n + 1) - (n - 1) * (n - 1)) / (1 - r));
    const double c = 1.0 / 7, c2 = c * c, s2 = 1 - c2;
    const double t0 = n * n - k2 - s2;
    const double a2b2 = std::sqrt(t0 * t0 + 4 * n * n * k2);
    const double a = std::sqrt(std::max(0.0, 0.5 * (a2b2 + t0)));
    const double rs = (a2b2 + c2 - 2 * a * c) / (a2b2 + c2 + 2 * a * c);
    const double rp =
        rs * (c2 * a2b2 + s2 * s2 - 2 * a * c * s2) / (c2 * a2b2 + s2 * s2 + 2 * a * c * s2);
    const double schlick = r + (1 - r) * std::pow(1 - c, 5);
    return static_cast<float>(std::clamp(0.5 * (rs + rp) / schlick, 0.0, 1.0));
}

}  // namespace tessera
