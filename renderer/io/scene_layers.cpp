#include "renderer/io/scene_layers.h"

#include "renderer/api/openpbr_inputs.h"
#include "renderer/core/nearest_name.h"
#include "renderer/io/params.h"

namespace tessera {
namespace {

struct LayerHead {
    NodeValue mask{{1, 1, 1}};
    float opacity = 1;
    int blend = 0;
};

/// mask, opacity and blend; true if key was one of them.
bool read_head(const std::string& key, const Value& value, LayerHead& head, NodeReader& nodes,
               const ReadContext& at) {
    if (key == "mask") {
        if (const auto mask = nodes.read(value, NodeType::scalar, key, at)) head.mask = *mask;
    } else if (key == "opacity") {
        Key row{key, {.kind = Form::Kind::number, .limits = kUnit}, "", nullptr};
        if (const auto plain = plain_value(value, row, at))
            head.opacity = static_cast<float>(plain->numbers[0]);
    } else if (key == "blend") {
        Key row{key, {.kind = Form::Kind::choice, .choices = blend_modes()}, "", nullptr};
        if (const auto plain = plain_value(value, row, at)) head.blend = plain->choice;
    } else if (key != "name") {
        return false;
    }
    return true;
}

/// Lays one value on the input of that name.
void lay(const std::string& key, const Value& value, const LayerHead& head, MaterialDesc& material,
         NodeReader& nodes, const ReadContext& at) {
    bool known = false;
    std::vector<std::string> names{"name", "mask", "opacity", "blend"};
    visit_inputs([&](auto member, const OpenPbrInput& info) {
        names.emplace_back(info.name);
        if (key != info.name) return;
        known = true;
        auto& input = material.*member;
        const auto above = nodes.read(value, type_of(member), key, at);
        if (!above) return;
        const NodeValue below = nodes.node_of(input, type_of(member));
        set_input(input, nodes.layer(below, *above, head.mask, head.blend, value.loc));
    });
    for (const NormalKey& row : kNormalKeys) {
        names.emplace_back(row.name);
        if (key != row.name) continue;
        known = true;
        NormalInput& input = material.*row.member;
        const auto above = nodes.read_normal(value, key, at);
        if (!above) continue;
        const NodeValue below = nodes.node_of(input, row.takes_maps);
        set_input(input, nodes.layer(below, *above, head.mask, head.blend, value.loc));
    }
    if (!known)
        at.problems.error(value.loc,
                          at.subject + ": unknown input '" + key + "'" + did_you_mean(key, names));
}

}  // namespace

void set_input(ColorInput& input, const NodeValue& value) {
    input = {};
    input.value = value.node >= 0 ? Float3{1, 1, 1} : value.value;
    input.node = value.node;
    input.output = value.output;
}

void set_input(FloatInput& input, const NodeValue& value) {
    input = {};
    input.value = value.node >= 0 ? 1.0f : value.value[0];
    input.node = value.node;
    input.output = value.output;
}

void set_input(NormalInput& input, const NodeValue& value) {
    input = {};
    input.node = value.node;
    input.output = value.output;
}

void read_material_layers(const Value& layers, MaterialDesc& material, NodeReader& nodes,
                          const ReadContext& at) {
    if (!layers.list())
        return report_misfit(layers, "layer", "tables ([[material.NAME.layer]])", at);
    std::size_t number = 0;
    for (const Value& table : *layers.list()) {
        const std::string name = "layer[" + std::to_string(number++) + "]";
        if (!table.table()) {
            report_misfit(table, name, "a table", at);
            continue;
        }
        const ReadContext own{at.problems, at.subject + ": " + name, "input"};
        LayerHead head;
        for (const auto& [key, value] : *table.table()) read_head(key, value, head, nodes, own);
        if (head.opacity < 1) head.mask = nodes.product(head.mask, head.opacity, table.loc);
        for (const auto& [key, value] : *table.table()) {
            if (key == "name" || key == "mask" || key == "opacity" || key == "blend") continue;
            lay(key, value, head, material, nodes, own);
        }
    }
}

}  // namespace tessera
