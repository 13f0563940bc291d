#include "renderer/io/scene_nodes.h"

#include <algorithm>

#include "renderer/core/murmur3.h"
#include "renderer/core/nearest_name.h"
#include "renderer/io/params.h"
#include "renderer/io/scene_textures.h"

namespace tessera {
namespace {

constexpr int kMaxDepth = 512;
const std::set<std::string, std::less<>> kImageKeys{"file",        "wrap", "filter", "frame_offset",
                                                    "color_space", "gain", "bias"};
const std::vector<std::string> kLayerKeys{"value", "mask", "opacity", "blend"};

const NodeInfo& info_of(const NodeDesc& node) {
    return kNodes[static_cast<std::size_t>(node.type)];
}

// Numbers go everywhere; three numbers are three numbers; else the kinds must agree.
bool fits(NodeType from, NodeType to) {
    if (to == NodeType::any || from == NodeType::scalar || from == to) return true;
    const auto triple = [](NodeType t) { return t == NodeType::color || t == NodeType::vector3; };
    return triple(from) && (triple(to) || to == NodeType::vector2);
}

// Whether values of two kinds can be told apart no more than numbers stand beside either.
bool joins(NodeType a, NodeType b) {
    const auto pair = [](NodeType t) { return t == NodeType::vector2; };
    const auto open = [](NodeType t) { return t == NodeType::scalar || t == NodeType::any; };
    return open(a) || open(b) || pair(a) == pair(b);
}

// Inputs that are written as words.
bool takes_word(NodeOp op, std::string_view input) {
    return (op == NodeOp::layer && input == "blend") || op == NodeOp::named ||
           (op == NodeOp::random && input == "by");
}

NodeDesc make(NodeOp op, const SourceLoc& loc) {
    NodeDesc node;
    node.type = static_cast<int>(op);
    node.loc = loc;
    const std::size_t count = kNodes[static_cast<std::size_t>(op)].inputs().size();
    node.inputs.resize(count);
    node.given.assign(count, false);
    return node;
}

void give(NodeDesc& node, std::size_t input, const NodeValue& value) {
    node.inputs[input] = value;
    node.given[input] = true;
}

}  // namespace

const std::vector<std::string>& blend_modes() {
    static const std::vector<std::string> modes{
        "over", "multiply", "screen", "overlay", "add", "subtract", "max", "min", "soft_light"};
    return modes;
}

bool NodeReader::is_graph(const Value& value) {
    return value.find("type") || value.find("node") || value.find("layers");
}

int NodeReader::push(NodeDesc node) {
    material_.nodes.push_back(std::move(node));
    return static_cast<int>(material_.nodes.size()) - 1;
}

std::optional<NodeValue> NodeReader::read(const Value& value, NodeType wanted,
                                          const std::string& key, const ReadContext& at) {
    if (!value.table()) return read_plain(value, wanted, key, at);
    if (depth_ >= kMaxDepth) {
        at.problems.error(value.loc, at.subject + ": " + key + ": nodes within nodes within ... " +
                                         "deeper than 512");
        return std::nullopt;
    }
    ++depth_;
    const ReadContext inner{at.problems, at.subject + ": " + key, "input"};
    std::optional<NodeValue> out;
    if (value.find("layers")) {
        out = read_layers(value, wanted, inner);
    } else if (value.find("node")) {
        out = read_named(value, wanted, inner);
    } else if (const auto node = read_node(value, wanted, inner)) {
        out = output_of(*node, value, wanted, inner);
    }
    --depth_;
    return out;
}

std::optional<NodeValue> NodeReader::read_plain(const Value& value, NodeType wanted,
                                                const std::string& key, const ReadContext& at) {
    const int count = wanted == NodeType::vector2 ? 2 : 3;
    const bool list = value.list() != nullptr;
    const bool number = std::holds_alternative<double>(value.data) ||
                        std::holds_alternative<std::int64_t>(value.data);
    const int takes = wanted == NodeType::scalar ? 1 : count;
    const std::size_t size = list ? value.list()->size() : 0;
    const bool pair = wanted == NodeType::any && size == 2;
    const bool long_enough = takes > 1 && (size == std::size_t(takes) || pair);
    if (!number && !long_enough) {
        report_misfit(value, key, describe({.kind = Form::Kind::input, .count = takes}), at);
        return std::nullopt;
    }
    Key row{
        key, {.kind = Form::Kind::numbers, .count = pair ? 2 : count, .or_one = true}, "", nullptr};
    if (!list) row.form = {.kind = Form::Kind::number};
    const auto plain = plain_value(value, row, at);
    if (!plain) return std::nullopt;
    NodeValue out;
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t from = list ? i : 0;
        out.value[i] = from < plain->numbers.size() ? static_cast<float>(plain->numbers[from]) : 0;
    }
    return out;
}

std::optional<NodeValue> NodeReader::read_named(const Value& table, NodeType wanted,
                                                const ReadContext& at) {
    const Value& written = *table.find("node");
    for (const auto& [key, value] : *table.table()) {
        if (key != "node" && key != "output") {
            at.problems.error(
                value.loc, at.subject + ": beside 'node' stands 'output' only, not '" + key + "'");
            return std::nullopt;
        }
    }
    if (!written.text()) {
        report_misfit(written, "node", "a name in quotes", at);
        return std::nullopt;
    }
    const std::string& name = *written.text();
    const Value* definition = named_ ? named_->find(name) : nullptr;
    if (!definition) {
        std::vector<std::string> names;
        if (named_ && named_->table())
            for (const auto& [known, value] : *named_->table()) names.push_back(known);
        at.problems.error(written.loc, at.subject + ": there is no node '" + name + "'" +
                                           did_you_mean(name, names));
        return std::nullopt;
    }
    const auto known = read_names_.find(name);
    if (known != read_names_.end())
        return known->second < 0 ? std::nullopt : output_of(known->second, table, wanted, at);
    if (!open_names_.insert(name).second) {
        at.problems.error(written.loc, at.subject + ": node '" + name + "' goes in a circle");
        return std::nullopt;
    }
    const ReadContext own{at.problems, "material '" + material_.name + "': node '" + name + "'",
                          "input"};
    std::optional<int> node;
    if (!definition->table() || !definition->find("type"))
        own.problems.error(definition->loc, own.subject + ": type is missing");
    else
        node = read_node(*definition, NodeType::any, own);
    open_names_.erase(name);
    read_names_[name] = node.value_or(-1);
    return node ? output_of(*node, table, wanted, at) : std::nullopt;
}

void NodeReader::read_unused(const Value* own, const ReadContext& at) {
    if (!own || !own->table()) return;
    for (const auto& [name, value] : *own->table()) {
        if (read_names_.contains(name)) continue;
        Value reference{Table{}, value.loc};
        std::get<Table>(reference.data)["node"] = Value{name, value.loc};
        read_named(reference, NodeType::any, {at.problems, at.subject + ": node", "input"});
    }
}

std::optional<int> NodeReader::read_node(const Value& table, NodeType wanted,
                                         const ReadContext& at) {
    const Value* type = table.find("type");
    if (type && !type->text()) {
        report_misfit(*type, "type", "the name of a node in quotes", at);
        return std::nullopt;
    }
    const std::string name = type ? *type->text() : "image";
    int index = find_node(name);
    if (name == "tiledimage") index = find_node("image");
    if (index < 0) {
        std::vector<std::string> names;
        for (const NodeInfo& info : kNodes) names.emplace_back(info.name);
        at.problems.error(type->loc, at.subject + ": there is no node type '" + name + "'" +
                                         did_you_mean(name, names));
        return std::nullopt;
    }
    const NodeInfo& info = kNodes[static_cast<std::size_t>(index)];
    NodeDesc node = make(info.op, table.loc);
    const bool image = info.op == NodeOp::image || info.op == NodeOp::triplanar;
    if (image && !read_image(table, wanted, node, at)) return std::nullopt;
    bool good = true;
    const auto fail = [&](const SourceLoc& loc, const std::string& what) {
        at.problems.error(loc, at.subject + ": node '" + name + "'" + what);
        good = false;
    };
    NodeType widest = NodeType::scalar;
    for (const auto& [key, value] : *table.table()) {
        if (key == "type" || key == "output" || (image && kImageKeys.contains(key))) continue;
        const auto inputs = info.inputs();
        const auto input = std::find_if(
            inputs.begin(), inputs.end(),
            [&, &wanted_name = key](const NodeInputInfo& i) { return i.name == wanted_name; });
        if (input == inputs.end()) {
            std::vector<std::string> names;
            for (const NodeInputInfo& i : inputs) names.emplace_back(i.name);
            fail(value.loc, " has no input '" + key + "'" + did_you_mean(key, names));
            continue;
        }
        const auto given = takes_word(info.op, key) ? read_word(value, info.op, key, at)
                                                    : read(value, input->type, key, at);
        good &= given.has_value();
        if (!given) continue;
        give(node, static_cast<std::size_t>(input - inputs.begin()), *given);
        if (input->type != NodeType::any) continue;
        NodeType own = value.list()
                           ? (value.list()->size() == 2 ? NodeType::vector2 : NodeType::color)
                           : NodeType::scalar;
        if (given->node >= 0) own = type_of(*given);
        if (!joins(widest, own))
            fail(value.loc, ": " + key + " is a " + std::string(name_of(own)) + ", beside a " +
                                std::string(name_of(widest)) +
                                " (see 'extract', 'luminance', 'combine3')");
        if (own != NodeType::scalar) widest = own;
    }
    if (info.op == NodeOp::named && !node.given[0]) fail(table.loc, ": name is missing");
    if (!good) return std::nullopt;
    const int at_index = push(std::move(node));
    types_[at_index] = info.output == NodeType::any ? widest : info.output;
    return at_index;
}

std::optional<NodeValue> NodeReader::read_word(const Value& value, NodeOp op,
                                               const std::string& key, const ReadContext& at) {
    static const std::vector<std::string> kinds{"instance", "object", "material"};
    if (!value.text() && op != NodeOp::named) return read(value, NodeType::scalar, key, at);
    if (!value.text()) {
        report_misfit(value, key, "a name in quotes", at);
        return std::nullopt;
    }
    if (key == "name") {
        // A hash in halves, which floats hold exactly.
        const std::uint32_t id = cryptomatte_id(*value.text());
        return NodeValue{{static_cast<float>(id & 0xffffu), static_cast<float>(id >> 16), 0.0f}};
    }
    const auto& words = op == NodeOp::layer ? blend_modes() : kinds;
    const auto found = std::find(words.begin(), words.end(), *value.text());
    if (found == words.end()) {
        at.problems.error(value.loc, at.subject + ": there is no " +
                                         (op == NodeOp::layer ? "blend mode '" : "kind of name '") +
                                         *value.text() + "'" + did_you_mean(*value.text(), words));
        return std::nullopt;
    }
    NodeValue number;
    number.value.fill(static_cast<float>(found - words.begin()));
    return number;
}

NodeType NodeReader::type_of(const NodeValue& value) const {
    const auto own = static_cast<std::size_t>(value.node);
    if (value.output == 0) return types_.at(value.node);
    const NodeInfo& info = info_of(material_.nodes[own]);
    return info.outputs()[static_cast<std::size_t>(value.output - 1)].type;
}

bool NodeReader::read_image(const Value& table, NodeType wanted, NodeDesc& node,
                            const ReadContext& at) {
    Value own{Table{}, table.loc};
    Table& keys = std::get<Table>(own.data);
    for (const std::string& key : kImageKeys)
        if (const Value* value = table.find(key)) keys[key] = *value;
    TextureEntry entry;
    read_keys(own, color_texture_keys(), entry, at);
    if (entry.file.empty()) return false;
    node.color = wanted == NodeType::color || wanted == NodeType::any;
    node.texture = add_texture(own, entry, at, reader_);
    return true;
}

std::optional<NodeValue> NodeReader::output_of(int node, const Value& table, NodeType wanted,
                                               const ReadContext& at) {
    const NodeInfo& info = info_of(material_.nodes[static_cast<std::size_t>(node)]);
    NodeValue out;
    out.node = node;
    NodeType type = types_.at(node);
    if (const Value* written = table.find("output")) {
        const auto outputs = info.outputs();
        const std::string name = written->text() ? *written->text() : "";
        const auto found = std::find_if(outputs.begin(), outputs.end(),
                                        [&](const NodeOutputInfo& o) { return o.name == name; });
        if (found == outputs.end() && name != "out") {
            std::vector<std::string> names{"out"};
            for (const NodeOutputInfo& o : outputs) names.emplace_back(o.name);
            at.problems.error(written->loc, at.subject + ": node '" + std::string(info.name) +
                                                "' has no output '" + name + "'" +
                                                did_you_mean(name, names));
            return std::nullopt;
        }
        if (found != outputs.end()) {
            out.output = static_cast<int>(found - outputs.begin()) + 1;
            type = found->type;
        }
    }
    // An image gives a number where one is wanted: its red.
    const bool image = info.op == NodeOp::image || info.op == NodeOp::triplanar;
    if (!fits(type, wanted) && !image) {
        at.problems.error(table.loc, at.subject + ": node '" + std::string(info.name) +
                                         "' gives a " + std::string(name_of(type)) +
                                         ", wanted is a " + std::string(name_of(wanted)) +
                                         " (see 'extract', 'luminance', 'combine3')");
        return std::nullopt;
    }
    return out;
}

std::optional<NodeValue> NodeReader::read_layers(const Value& table, NodeType wanted,
                                                 const ReadContext& at) {
    const Value& written = *table.find("layers");
    for (const auto& [key, value] : *table.table()) {
        if (key == "layers") continue;
        at.problems.error(value.loc,
                          at.subject + ": beside 'layers' nothing stands, not '" + key + "'");
        return std::nullopt;
    }
    if (!written.list() || written.list()->empty()) {
        report_misfit(written, "layers", "a list of values, the lowest first", at);
        return std::nullopt;
    }
    std::optional<NodeValue> below;
    std::size_t number = 0;
    for (const Value& entry : *written.list()) {
        const std::string name = "layers[" + std::to_string(number++) + "]";
        const Value* value = entry.table() ? entry.find("value") : nullptr;
        if (!value) {
            const auto plain = read(entry, wanted, name, at);
            if (!plain) return std::nullopt;
            below = below ? layer(*below, *plain, {{1, 1, 1}}, 0, entry.loc) : *plain;
            continue;
        }
        const ReadContext inner{at.problems, at.subject + ": " + name, "key"};
        NodeValue mask{{1, 1, 1}};
        float opacity = 1;
        int blend = 0;
        bool good = true;
        for (const auto& [key, part] : *entry.table()) {
            if (key == "value") continue;
            if (key == "mask") {
                const auto read_mask = read(part, NodeType::scalar, key, inner);
                good &= read_mask.has_value();
                if (read_mask) mask = *read_mask;
            } else if (key == "opacity") {
                Key row{key, {.kind = Form::Kind::number, .limits = kUnit}, "", nullptr};
                const auto plain = plain_value(part, row, inner);
                good &= plain.has_value();
                if (plain) opacity = static_cast<float>(plain->numbers[0]);
            } else if (key == "blend") {
                Key row{key, {.kind = Form::Kind::choice, .choices = blend_modes()}, "", nullptr};
                const auto plain = plain_value(part, row, inner);
                good &= plain.has_value();
                if (plain) blend = plain->choice;
            } else {
                at.problems.error(part.loc, inner.subject + ": unknown key '" + key + "'" +
                                                did_you_mean(key, kLayerKeys));
                good = false;
            }
        }
        const auto above = read(*value, wanted, "value", inner);
        if (!above || !good) return std::nullopt;
        if (opacity < 1) mask = product(mask, opacity, entry.loc);
        below = layer(below.value_or(NodeValue{}), *above, mask, blend, entry.loc);
    }
    if (below->node >= 0) types_.try_emplace(below->node, wanted);
    return below;
}

NodeValue NodeReader::product(NodeValue value, float factor, const SourceLoc& loc) {
    NodeDesc node = make(NodeOp::multiply, loc);
    give(node, 0, value);
    give(node, 1, {{factor, factor, factor}});
    const int index = push(std::move(node));
    types_[index] = NodeType::any;
    return {{}, index};
}

NodeValue NodeReader::layer(NodeValue below, NodeValue above, NodeValue mask, int blend,
                            const SourceLoc& loc) {
    NodeDesc node = make(NodeOp::layer, loc);
    const auto mode = static_cast<float>(blend);
    give(node, 0, below);
    give(node, 1, above);
    give(node, 2, mask);
    give(node, 3, {{mode, mode, mode}});
    const int index = push(std::move(node));
    types_[index] = NodeType::any;
    return {{}, index};
}

int NodeReader::image_node(int texture, bool color) {
    NodeDesc node = make(NodeOp::image, {});
    node.texture = texture;
    node.color = color;
    const int index = push(std::move(node));
    types_[index] = color ? NodeType::color : NodeType::scalar;
    return index;
}

NodeValue NodeReader::node_of(const ColorInput& input, NodeType type) {
    if (input.node >= 0) return {{}, input.node, input.output};
    if (input.texture < 0) return {input.value};
    NodeDesc product = make(NodeOp::multiply, {});
    give(product, 0, {{}, image_node(input.texture, type == NodeType::color)});
    give(product, 1, {input.value});
    const int index = push(std::move(product));
    types_[index] = type;
    return {{}, index};
}

NodeValue NodeReader::node_of(const NormalInput& input, bool normal) {
    if (input.node >= 0) return {{}, input.node, input.output};
    if (input.texture < 0) {
        const int own = push(make(normal ? NodeOp::normal : NodeOp::tangent, {}));
        types_[own] = NodeType::vector3;
        return {{}, own};
    }
    NodeValue texel{{}, image_node(input.texture, false)};
    if (input.flip_y) {
        NodeDesc flip = make(NodeOp::remap, {});
        give(flip, 0, texel);
        give(flip, 3, {{0, 1, 0}});
        give(flip, 4, {{1, 0, 1}});
        texel = {{}, push(std::move(flip))};
    }
    NodeDesc map = make(NodeOp::normalmap, {});
    give(map, 0, texel);
    give(map, 1, {{input.scale, input.scale, input.scale}});
    const int index = push(std::move(map));
    types_[index] = NodeType::vector3;
    return {{}, index};
}

std::optional<NodeValue> NodeReader::read_normal(const Value& value, const std::string& key,
                                                 const ReadContext& at) {
    if (!value.table()) {
        report_misfit(
            value, key,
            describe({.kind = Form::Kind::image, .tables = {&normal_texture_keys().list}}), at);
        return std::nullopt;
    }
    if (is_graph(value)) {
        const auto node = read(value, NodeType::vector3, key, at);
        if (node && node->node < 0) {
            at.problems.error(value.loc, at.subject + ": " + key + " takes nodes, no constants");
            return std::nullopt;
        }
        if (node && type_of(*node) == NodeType::scalar) {
            at.problems.error(value.loc, at.subject + ": " + key +
                                             " takes a vector, the node gives a number (a height "
                                             "is for 'bump')");
            return std::nullopt;
        }
        return node;
    }
    TextureEntry entry;
    read_keys(value, normal_texture_keys(), entry, {at.problems, at.subject + ": " + key});
    const int texture = add_texture(value, entry, at, reader_);
    if (texture < 0) return std::nullopt;
    return node_of(
        NormalInput{texture, entry.scale_normal, entry.convention == NormalConvention::directx},
        true);
}

NodeValue NodeReader::node_of(const FloatInput& input, NodeType) {
    const Float3 value{input.value, input.value, input.value};
    if (input.node >= 0) return {{}, input.node, input.output};
    if (input.texture < 0) return {value};
    NodeValue read{{}, image_node(input.texture, false), input.channel == Channel::a ? 1 : 0};
    if (input.channel == Channel::g || input.channel == Channel::b) {
        NodeDesc channel = make(NodeOp::extract, {});
        give(channel, 0, read);
        const float which = input.channel == Channel::g ? 1.0f : 2.0f;
        give(channel, 1, {{which, which, which}});
        read = {{}, push(std::move(channel))};
    } else if (input.channel == Channel::luminance) {
        NodeDesc grey = make(NodeOp::luminance, {});
        give(grey, 0, read);
        read = {{}, push(std::move(grey))};
    }
    if (input.invert) {
        NodeDesc inverse = make(NodeOp::invert, {});
        give(inverse, 0, read);
        read = {{}, push(std::move(inverse))};
    }
    NodeDesc product = make(NodeOp::multiply, {});
    give(product, 0, read);
    give(product, 1, {value});
    const int index = push(std::move(product));
    types_[index] = NodeType::scalar;
    return {{}, index};
}

}  // namespace tessera
