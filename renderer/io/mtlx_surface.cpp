#include "renderer/io/mtlx_surface.h"

#include <algorithm>
#include <type_traits>

#include "renderer/core/nearest_name.h"
#include "renderer/io/scene_layers.h"

namespace tessera {
namespace {

using Kind = MtlxValue::Kind;

template <class Input>
OpenPbrInput info_of(Input MaterialDesc::*wanted) {
    OpenPbrInput found{};
    visit_openpbr([&]<class Other>(Other MaterialDesc::*member, const OpenPbrInput& info) {
        if constexpr (std::is_same_v<Other, Input>) {
            if (member == wanted) found = info;
        }
    });
    return found;
}

}  // namespace

const SourceLoc& MtlxInputs::loc(std::string_view name) const {
    const MtlxElement* input = shader_.node.child(name);
    return input ? input->loc : shader_.node.loc;
}

std::string MtlxInputs::subject(std::string_view name) const {
    return shader_.node.subject() + ": " + std::string(name);
}

std::optional<MtlxValue> MtlxInputs::given(std::string_view name) {
    auto value = graph_.input(shader_, name);
    if (value && value->source != shader_.node.child(name)) {
        // Messages speak of the shader's own input.
        value->source = shader_.node.child(name);
    }
    return value;
}

MtlxValue MtlxInputs::number(std::string_view name, float otherwise) {
    if (auto value = given(name)) return *value;
    return {.type = MtlxType::scalar, .rgb = node_constant(otherwise), .source = &shader_.node};
}

MtlxValue MtlxInputs::color(std::string_view name, const Float3& otherwise) {
    if (auto value = given(name)) return *value;
    return {.type = MtlxType::color3, .rgb = {otherwise}, .source = &shader_.node};
}

std::optional<float> MtlxInputs::constant(std::string_view name) {
    const auto value = given(name);
    if (value && value->is_constant() && is_number(value->type)) return value->rgb.value[0];
    return std::nullopt;
}

void MtlxInputs::set(FloatInput MaterialDesc::*member, const MtlxValue& value) {
    const OpenPbrInput info = info_of(member);
    FloatInput& input = graph_.material().*member;
    const SourceLoc& loc = value.source->loc;
    const std::string subject = shader_.node.subject() + ": " + info.name;
    if (!is_number(value.type))
        return graph_.damage(
            loc, subject + " takes a number, not type " + std::string(name_of(value.type)));
    if (value.is_constant()) {
        const float x = value.rgb.value[0];
        if (!(x >= static_cast<float>(info.low) && x <= static_cast<float>(info.high)))
            return graph_.damage(loc, subject + " is " + number_text(double(x)) +
                                          ", must be from " + number_text(info.low) + " to " +
                                          number_text(info.high));
        input = {x};
        return;
    }
    const auto image = plain_image(graph_, value.rgb);
    if (image && image->channel != Channel::automatic && image->factor[0] >= 0) {
        input = {image->factor[0], image->texture, image->channel, image->invert};
        return;
    }
    set_input(input, value.rgb);
}

void MtlxInputs::set(ColorInput MaterialDesc::*member, const MtlxValue& value) {
    const OpenPbrInput info = info_of(member);
    ColorInput& input = graph_.material().*member;
    const SourceLoc& loc = value.source->loc;
    const std::string subject = shader_.node.subject() + ": " + info.name;
    if (value.type != MtlxType::color3)
        return graph_.damage(
            loc, subject + " takes a color3, not type " + std::string(name_of(value.type)));
    if (value.is_constant()) {
        input = {value.rgb.value};
        const auto low = static_cast<float>(info.low), high = static_cast<float>(info.high);
        for (float& x : input.value) x = std::clamp(x, low, high);
        if (input.value != value.rgb.value)
            graph_.reading().reader.problems.warn(loc, subject + " lies outside " +
                                                           number_text(info.low) + " to " +
                                                           number_text(info.high) + ", clamped");
        return;
    }
    const auto image = plain_image(graph_, value.rgb);
    const bool whole = image && image->channel == Channel::automatic && !image->invert;
    if (whole &&
        std::all_of(image->factor.begin(), image->factor.end(), [](float f) { return f >= 0; })) {
        input = {image->factor, image->texture};
        return;
    }
    set_input(input, value.rgb);
}

void MtlxInputs::set_thin_walled(std::string_view name) {
    const auto value = given(name);
    if (!value) return;
    if (value->type == MtlxType::boolean && value->is_constant())
        graph_.material().geometry_thin_walled = value->rgb.value[0] != 0;
    else
        graph_.damage(loc(name), subject(name) + " must be true or false");
}

void MtlxInputs::set_normal(std::string_view name, NormalInput MaterialDesc::*member) {
    const auto value = given(name);
    if (!value || value->kind != Kind::plain) return;
    NormalInput& input = graph_.material().*member;
    if (value->type != MtlxType::vector3 || value->is_constant())
        return graph_.damage(loc(name), subject(name) + " takes nodes that give a vector3");
    const NodeDesc node = graph_.material().nodes[static_cast<std::size_t>(value->rgb.node)];
    const bool map = kNodes[static_cast<std::size_t>(node.type)].op == NodeOp::normalmap;
    const bool even = map && node.inputs[1].node < 0;
    const auto image = even ? plain_image(graph_, node.inputs[0]) : std::nullopt;
    if (image && image->channel == Channel::automatic && !image->invert &&
        image->factor == Float3{1, 1, 1})
        input = {image->texture, node.given[1] ? node.inputs[1].value[0] : 1.0f};
    else
        set_input(input, value->rgb);
}

void MtlxInputs::check_names(const std::vector<std::string>& names) {
    for (const MtlxElement* input : shader_.node.children) {
        if (input->category != "input") continue;
        const std::string name = input->name();
        if (std::find(names.begin(), names.end(), name) != names.end()) continue;
        graph_.damage(input->loc, shader_.node.subject() + ": has no input '" + name + "'" +
                                      did_you_mean(name, names));
    }
}

void MtlxInputs::unsupported(std::string_view name, const std::string& why) {
    graph_.reading().reader.problems.warn(
        loc(name), subject(name) + (why.empty() ? " is not supported yet, ignored" : " " + why));
}

void read_open_pbr_surface(MtlxGraph& graph, const MtlxGraph::NodeAt& shader) {
    MtlxInputs in(graph, shader);
    std::vector<std::string> names{"geometry_thin_walled"};
    visit_openpbr([&](auto member, const OpenPbrInput& info) {
        if (std::string_view(info.name) == "bump") return;  // ours alone
        names.emplace_back(info.name);
        if (const auto value = in.given(info.name)) in.set(member, *value);
    });
    for (const NormalKey& normal : kNormalKeys) {
        names.emplace_back(normal.name);
        in.set_normal(normal.name, normal.member);
    }
    in.check_names(names);
    in.set_thin_walled("geometry_thin_walled");
}

}  // namespace tessera
