// Images of MaterialX.

#include <algorithm>
#include <array>

#include "renderer/core/nearest_name.h"
#include "renderer/io/mtlx_graph.h"
#include "renderer/io/scene_textures.h"

namespace tessera {
namespace {

using At = MtlxGraph::NodeAt;

/// What says which frame or layer of what is read; without effect for one plain picture.
constexpr std::array<std::string_view, 8> kWithoutEffect{
    "filtertype", "framerange", "frameoffset", "frameendaction",
    "layer",      "layerx",     "layery",      "layerz"};

bool without_effect(MtlxGraph& graph, const At& at, const MtlxElement& input) {
    const std::string name = input.name();
    if (std::find(kWithoutEffect.begin(), kWithoutEffect.end(), name) == kWithoutEffect.end())
        return false;
    if (name.starts_with("layer") && !graph.text(at, name, "").empty())
        graph.damage(input.loc, at.node.subject() + ": layers within a picture are not read");
    if (name == "frameoffset" && graph.number(at, name, 0) != 0)
        graph.damage(input.loc, at.node.subject() + ": sequences of frames are not read");
    return true;
}

void check_inputs(MtlxGraph& graph, const At& at, const std::vector<std::string>& known) {
    for (const MtlxElement* input : at.node.children) {
        if (input->category != "input" || without_effect(graph, at, *input)) continue;
        const std::string name = input->name();
        if (std::find(known.begin(), known.end(), name) != known.end()) continue;
        graph.damage(input->loc, at.node.subject() + ": has no input '" + name + "'" +
                                     did_you_mean(name, known));
    }
}

Wrap wrap_of(MtlxGraph& graph, const At& at, const std::string& name, bool black_outside) {
    const std::string mode = graph.text(at, name, "periodic");
    if (mode == "clamp") return Wrap::clamp;
    if (mode == "mirror") return Wrap::mirror;
    if (mode == "constant") {
        if (!black_outside)
            graph.damage(at, name + " 'constant' gives 0 outside, no other default");
        return Wrap::black;
    }
    if (mode != "periodic" && !mode.empty())
        graph.damage(
            at, name + " is '" + mode + "', must be 'periodic', 'clamp', 'mirror' or 'constant'");
    return Wrap::repeat;
}

/// The file that an input names, as it is to be looked for; what wrote it says its colour space.
std::optional<MtlxValue> file_of(MtlxGraph& graph, const At& at, std::string_view name) {
    auto file = graph.input(at, name);
    if (!file || (file->type == MtlxType::filename && file->text.empty())) return std::nullopt;
    if (file->type != MtlxType::filename) {
        graph.damage(at, std::string(name) + " is of type " + std::string(name_of(file->type)) +
                             ", must be filename");
        return std::nullopt;
    }
    const std::string* prefix = file->source->inherited("fileprefix");
    if (prefix) file->text = *prefix + file->text;
    return file;
}

/// The texture of a file; -1 after reporting, or when the node's default stands for it.
int texture_of(MtlxGraph& graph, const At& at, const MtlxValue& file, bool has_default) {
    SceneReader& reader = graph.reading().reader;
    const SourceLoc& loc = file.source->loc;
    TextureEntry entry;
    entry.file = file.text;
    const bool black = !has_default;
    entry.wrap = wrap_of(graph, at, "uaddressmode", black);
    entry.wrap_v = wrap_of(graph, at, "vaddressmode", black);
    entry.color_space = "raw";
    if (is_color(at.type)) {
        entry.color_space = mtlx_color_space(*file.source);
        if (entry.color_space.empty()) {
            reader.problems.note(loc, at.node.subject() +
                                          ": no colorspace is written; its colours are taken as "
                                          "they are");
            entry.color_space = "raw";
        }
        try {
            Float3 probe{0.5f, 0.5f, 0.5f};
            graph.reading().colors.to_working(probe, entry.color_space);
        } catch (const Error& error) {
            graph.damage(loc, at.node.subject() + ": " + error.what());
            entry.color_space = "raw";
        }
    }
    const AssetPath found = reader.find(entry.file, loc);
    if (has_default && found.path.empty() && !found.refused) {
        reader.problems.warn(loc, at.node.subject() + ": file '" + entry.file + "' " +
                                      found.reason + "; its default is used");
        return -1;
    }
    const ReadContext context{reader.problems, at.node.subject()};
    return add_texture(Value{Table{}, loc}, entry, context, reader);
}

MtlxValue default_of(MtlxGraph& graph, const At& at) {
    const auto written = graph.input(at, "default");
    if (written && written->type == at.type) return *written;
    if (written) graph.damage(at, "default is of type " + std::string(name_of(written->type)));
    return {.type = at.type, .fourth = node_constant(0), .source = &at.node};
}

/// An image as the value of its node: a number is the red of it.
MtlxValue value_of_image(MtlxGraph& graph, const At& at, const NodeValue& image) {
    MtlxValue out{.type = at.type, .rgb = image, .source = &at.node};
    if (is_number(at.type))
        out.rgb = graph.emit(NodeOp::extract, {image, node_constant(0)}, at.node.loc);
    out.fourth = {{}, image.node, 1};
    return out;
}

bool is_pair(MtlxGraph& graph, const At& at, std::string_view name, const MtlxValue& value) {
    if (value.type == MtlxType::vector2) return true;
    graph.damage(at, std::string(name) + " is of type " + std::string(name_of(value.type)) +
                         ", must be vector2");
    return false;
}

Float3 constant_pair(MtlxGraph& graph, const At& at, std::string_view name, float otherwise) {
    const auto value = graph.input(at, name);
    if (!value || !is_pair(graph, at, name, *value)) return {otherwise, otherwise, otherwise};
    if (!value->is_constant()) graph.damage(at, std::string(name) + " must be written numbers");
    return value->is_constant() ? value->rgb.value : Float3{otherwise, otherwise, otherwise};
}

bool comes_in(MtlxGraph& graph, const At& at) {
    if (width_of(at.type) > 0 && at.type != MtlxType::boolean) return true;
    graph.damage(at, "does not come in its type");
    return false;
}

}  // namespace

std::optional<MtlxValue> read_mtlx_image(MtlxGraph& graph, const At& at) {
    if (!comes_in(graph, at)) return std::nullopt;
    const bool tiled = at.node.category == "tiledimage";
    std::vector<std::string> known{"file", "default", "texcoord", "uaddressmode", "vaddressmode"};
    if (tiled)
        for (const char* name : {"uvtiling", "uvoffset", "realworldimagesize", "realworldtilesize"})
            known.emplace_back(name);
    check_inputs(graph, at, known);
    const auto file = file_of(graph, at, "file");
    const MtlxValue otherwise = default_of(graph, at);
    if (!file) return otherwise;
    const bool has_default = at.node.child("default") != nullptr;
    const int texture = texture_of(graph, at, *file, has_default);
    if (texture < 0) return otherwise;

    NodeDesc node = make_node(NodeOp::image, at.node.loc);
    node.texture = texture;
    node.color = is_color(at.type);
    const auto give = [&](std::size_t input, const NodeValue& value) {
        node.inputs[input] = value;
        node.given[input] = true;
    };
    if (const auto place = graph.input(at, "texcoord");
        place && is_pair(graph, at, "texcoord", *place))
        give(0, place->rgb);
    if (tiled) {
        // (uv * tiling - offset) / image size * tile size, as the standard library defines it.
        const Float3 size = constant_pair(graph, at, "realworldimagesize", 1);
        const Float3 tile = constant_pair(graph, at, "realworldtilesize", 1);
        const Float3 ratio{size[0] != 0 ? tile[0] / size[0] : 0,
                           size[1] != 0 ? tile[1] / size[1] : 0, 0};
        const auto scaled = [&](NodeValue v, float sign) -> NodeValue {
            const Float3 by{ratio[0] * sign, ratio[1] * sign, 0};
            if (v.node >= 0) return graph.emit(NodeOp::multiply, {v, {by}}, at.node.loc);
            return {{v.value[0] * by[0], v.value[1] * by[1], 0}};
        };
        const auto tiling = graph.input(at, "uvtiling");
        const auto offset = graph.input(at, "uvoffset");
        if (tiling && is_pair(graph, at, "uvtiling", *tiling)) give(1, scaled(tiling->rgb, 1));
        if (!tiling && ratio != Float3{1, 1, 0}) give(1, {{ratio[0], ratio[1], 0}});
        if (offset && is_pair(graph, at, "uvoffset", *offset)) give(2, scaled(offset->rgb, -1));
    }
    return value_of_image(graph, at, {{}, graph.push(std::move(node))});
}

std::optional<MtlxValue> read_mtlx_triplanar(MtlxGraph& graph, const At& at) {
    if (!comes_in(graph, at)) return std::nullopt;
    check_inputs(graph, at, {"filex", "filey", "filez", "default", "position", "blend"});
    std::optional<MtlxValue> file;
    for (const char* name : {"filex", "filey", "filez"}) {
        const auto one = file_of(graph, at, name);
        if (!one || (file && file->text != one->text)) {
            graph.damage(at, "filex, filey and filez must be one file");
            return default_of(graph, at);
        }
        file = one;
    }
    const MtlxValue otherwise = default_of(graph, at);
    const int texture = texture_of(graph, at, *file, at.node.child("default") != nullptr);
    if (texture < 0) return otherwise;
    NodeDesc node = make_node(NodeOp::triplanar, at.node.loc);
    node.texture = texture;
    node.color = is_color(at.type);
    const auto give = [&](std::size_t input, const NodeValue& value) {
        node.inputs[input] = value;
        node.given[input] = true;
    };
    if (const auto place = graph.input(at, "position")) {
        if (place->type == MtlxType::vector3)
            give(0, place->rgb);
        else
            graph.damage(at, "position must be vector3");
    }
    if (const auto blend = graph.input(at, "blend"); blend && is_number(blend->type))
        give(2, blend->rgb);
    if (has_fourth(at.type)) graph.damage(at, "comes without a fourth component");
    return value_of_image(graph, at, {{}, graph.push(std::move(node))});
}

std::optional<MtlxValue> read_mtlx_normal_map(MtlxGraph& graph, const At& at) {
    check_inputs(graph, at, {"in", "scale", "space", "normal", "tangent", "bitangent"});
    using Kind = MtlxValue::Kind;
    for (const char* name : {"normal", "tangent", "bitangent"}) {
        const auto frame = graph.input(at, name);
        if (frame && frame->kind != Kind::surface_normal && frame->kind != Kind::surface_tangent)
            graph.damage(at, std::string(name) + " must be the surface's own");
    }
    if (graph.text(at, "space", "tangent") != "tangent")
        graph.damage(at, "space is not 'tangent': only maps in tangent space are read");
    NodeDesc node = make_node(NodeOp::normalmap, at.node.loc);
    const auto give = [&](std::size_t input, const NodeValue& value) {
        node.inputs[input] = value;
        node.given[input] = true;
    };
    if (const auto in = graph.input(at, "in")) {
        if (in->type != MtlxType::vector3)
            graph.damage(at,
                         "in is of type " + std::string(name_of(in->type)) + ", must be vector3");
        give(0, in->rgb);
    }
    if (const auto scale = graph.input(at, "scale")) {
        const Float3& s = scale->rgb.value;
        const bool even = is_number(scale->type) || (scale->is_constant() && s[0] == s[1]);
        if (!even) graph.damage(at, "scale must be one number");
        give(1, scale->is_constant() ? node_constant(s[0]) : scale->rgb);
    }
    return MtlxValue{
        .type = MtlxType::vector3, .rgb = {{}, graph.push(std::move(node))}, .source = &at.node};
}

std::optional<MtlxPlainImage> plain_image(MtlxGraph& graph, const NodeValue& value) {
    const std::vector<NodeDesc>& nodes = graph.material().nodes;
    MtlxPlainImage out;
    NodeValue at = value;
    bool inverted = false, one_channel = false;
    for (std::size_t steps = 0; at.node >= 0 && steps < nodes.size(); ++steps) {
        const NodeDesc& node = nodes[static_cast<std::size_t>(at.node)];
        const NodeOp op = kNodes[static_cast<std::size_t>(node.type)].op;
        const auto constant = [&](std::size_t i) { return node.inputs[i].node < 0; };
        if (op == NodeOp::multiply && !inverted && !one_channel) {
            const std::size_t factor = constant(1) ? 1 : 0;
            if (!constant(factor) || !node.given[factor]) return std::nullopt;
            for (std::size_t i = 0; i < 3; ++i) out.factor[i] *= node.inputs[factor].value[i];
            at = node.inputs[1 - factor];
        } else if (op == NodeOp::invert && !inverted && !one_channel) {
            const bool from_one =
                !node.given[1] || (constant(1) && node.inputs[1].value == Float3{1, 1, 1});
            if (!from_one) return std::nullopt;
            inverted = true;
            at = node.inputs[0];
        } else if (op == NodeOp::extract && !one_channel && at.output == 0) {
            if (!constant(1)) return std::nullopt;
            const float index = node.inputs[1].value[0];
            out.channel = index < 0.5f ? Channel::r : index < 1.5f ? Channel::g : Channel::b;
            one_channel = true;
            at = node.inputs[0];
        } else if (op == NodeOp::image) {
            if (at.output == 1 && one_channel) return std::nullopt;
            if (at.output == 1) out.channel = Channel::a;
            if (node.given[0] || node.texture < 0 || !constant(1) || !constant(2))
                return std::nullopt;
            out.invert = inverted;
            TextureDesc texture =
                graph.reading().reader.scene.textures[static_cast<std::size_t>(node.texture)];
            if (node.given[1]) texture.scale = {node.inputs[1].value[0], node.inputs[1].value[1]};
            if (node.given[2]) texture.offset = {node.inputs[2].value[0], node.inputs[2].value[1]};
            out.texture = graph.reading().reader.add_texture(std::move(texture));
            return out;
        } else {
            return std::nullopt;
        }
    }
    return std::nullopt;
}

}  // namespace tessera
