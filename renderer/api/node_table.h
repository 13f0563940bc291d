#pragma once
// The nodes of shader graphs: names, inputs and defaults as MaterialX's standard library has them,
// and patterns of our own. Readers, the compiler and docs/nodes.md all go by this table.

#include <array>
#include <cstdint>
#include <span>
#include <string_view>

namespace tessera {

enum class NodeOp : std::uint8_t {
    constant,
    texcoord,
    position,
    normal,
    geomcolor,
    viewdirection,
    facingratio,
    fresnel,
    random,
    named,
    image,
    triplanar,
    tangent,
    normalmap,
    bump,
    add,
    subtract,
    multiply,
    divide,
    modulo,
    absval,
    sign,
    floor,
    ceil,
    round,
    power,
    sin,
    cos,
    asin,
    acos,
    atan2,
    sqrt,
    ln,
    exp,
    clamp,
    min,
    max,
    invert,
    normalize,
    magnitude,
    dotproduct,
    crossproduct,
    mix,
    remap,
    smoothstep,
    ramplr,
    ramptb,
    splitlr,
    splittb,
    luminance,
    contrast,
    saturate,
    hsvadjust,
    rgbtohsv,
    hsvtorgb,
    combine3,
    extract,
    ifgreater,
    switch_,  // NOLINT(readability-identifier-naming): a keyword without its underscore
    rotate3d,
    place2d,
    rotate2d,
    blackbody,
    noise2d,
    noise3d,
    fractal2d,
    fractal3d,
    cellnoise2d,
    cellnoise3d,
    worleynoise2d,
    worleynoise3d,
    checkerboard,
    brick,
    wood,
    marble,
    cloth,
    rust,
    flakes,
    edgewear,
    layer,
};

/// any: takes what it is given; as an output: what its inputs are.
enum class NodeType : std::uint8_t { scalar, color, vector2, vector3, any };

constexpr std::string_view name_of(NodeType type) {
    constexpr std::string_view kNames[]{"number", "colour", "vector2", "vector3", "value"};
    return kNames[static_cast<std::size_t>(type)];
}

struct NodeInputInfo {
    std::string_view name;
    NodeType type = NodeType::any;
    std::array<float, 3> initial{0, 0, 0};
};

/// An output beside the main one. Numbers stand before vectors, of which each is run by itself.
struct NodeOutputInfo {
    std::string_view name;
    NodeType type = NodeType::scalar;
};

inline constexpr int kMaxNodeInputs = 12, kMaxNodeOutputs = 5;

struct NodeInfo {
    NodeOp op;
    std::string_view name;
    NodeType output;
    std::string_view help;
    std::array<NodeInputInfo, kMaxNodeInputs> input_list{};
    std::array<NodeOutputInfo, kMaxNodeOutputs> output_list{};

    constexpr std::span<const NodeInputInfo> inputs() const {
        std::size_t n = 0;
        while (n < input_list.size() && !input_list[n].name.empty()) ++n;
        return {input_list.data(), n};
    }
    constexpr std::span<const NodeOutputInfo> outputs() const {
        std::size_t n = 0;
        while (n < output_list.size() && !output_list[n].name.empty()) ++n;
        return {output_list.data(), n};
    }
};

namespace node_table {

using enum NodeType;
inline constexpr std::array<float, 3> k0{0, 0, 0}, k1{1, 1, 1}, kHalf{0.5f, 0.5f, 0.5f};
inline constexpr NodeInputInfo kIn{"in", any, k0}, kIn1{"in1", any, k0}, kIn2{"in2", any, k0},
    kOne2{"in2", any, k1}, kPlace{"texcoord", vector2, k0}, kAt{"position", vector3, k0};
using O = NodeOp;

}  // namespace node_table

// clang-format off
inline constexpr std::array kNodes{
    NodeInfo{NodeOp::constant, "constant", NodeType::any, "A value.", {{{"value", NodeType::any}}}},
    NodeInfo{NodeOp::texcoord, "texcoord", NodeType::vector2, "Texture coordinates of the surface."},
    NodeInfo{NodeOp::position, "position", NodeType::vector3, "Position; space 0 the object's, 1 the world's.", {{{"space", NodeType::scalar}}}},
    NodeInfo{NodeOp::normal, "normal", NodeType::vector3, "Shading normal, unit, in the world."},
    NodeInfo{NodeOp::geomcolor, "geomcolor", NodeType::color, "Vertex colour."},
    NodeInfo{NodeOp::viewdirection, "viewdirection", NodeType::vector3, "From the viewer to the surface, unit, in the world."},
    NodeInfo{NodeOp::facingratio, "facingratio", NodeType::scalar, "1 where the surface faces the viewer, 0 at the silhouette; faceforward 0: negative from behind; invert 1: 1 minus it.",
             {{{"viewdirection", NodeType::vector3}, {"normal", NodeType::vector3}, {"faceforward", NodeType::scalar, {1, 0, 0}}, {"invert", NodeType::scalar}}}},
    NodeInfo{NodeOp::fresnel, "fresnel", NodeType::scalar, "What a smooth dielectric reflects towards the viewer, of an index ior over that outside.", {{{"ior", NodeType::scalar, {1.5f, 0, 0}}, {"normal", NodeType::vector3}}}},
    NodeInfo{NodeOp::random, "random", NodeType::scalar, "A number in [0, 1), another for each seed and each 'instance', 'object' or 'material' (by), whatever their order in the files.", {{{"seed", NodeType::scalar}, {"by", NodeType::scalar}}}},
    NodeInfo{NodeOp::named, "named", NodeType::scalar, "1 on what has the name, else 0: a text in name; by 'object' (the default), 'instance' or 'material'.", {{{"name", NodeType::scalar}, {"by", NodeType::scalar, {1, 0, 0}}}}},
    NodeInfo{NodeOp::image, "image", NodeType::color, "An image: file, wrap, filter, frame_offset, color_space as for inputs; at texcoord x uvtiling + uvoffset.",
             {{{"texcoord", NodeType::vector2}, {"uvtiling", NodeType::vector2, {1, 1, 0}}, {"uvoffset", NodeType::vector2}}}, {{{"alpha"}}}},
    NodeInfo{NodeOp::triplanar, "triplanarprojection", NodeType::color, "An image along the three axes of the object, blended by the normal.",
             {{{"position", NodeType::vector3}, {"scale", NodeType::scalar, {1, 0, 0}}, {"blend", NodeType::scalar, {1, 0, 0}}}}},
    NodeInfo{NodeOp::tangent, "tangent", NodeType::vector3, "Tangent along u, unit, in the world."},
    NodeInfo{NodeOp::normalmap, "normalmap", NodeType::vector3, "The texel of a tangent-space normal map (green up) as a unit normal in the world.", {{{"in", NodeType::vector3, {0.5f, 0.5f, 1}}, {"scale", NodeType::scalar, {1, 0, 0}}}}},
    NodeInfo{NodeOp::bump, "bump", NodeType::vector3, "The normal tilted by a height in the object's units.", {{{"height", NodeType::scalar}, {"scale", NodeType::scalar, {1, 0, 0}}, {"normal", NodeType::vector3}}}},
    NodeInfo{NodeOp::add, "add", NodeType::any, "in1 + in2", {{node_table::kIn1, node_table::kIn2}}},
    NodeInfo{NodeOp::subtract, "subtract", NodeType::any, "in1 - in2", {{node_table::kIn1, node_table::kIn2}}},
    NodeInfo{NodeOp::multiply, "multiply", NodeType::any, "in1 * in2", {{node_table::kIn1, node_table::kOne2}}},
    NodeInfo{NodeOp::divide, "divide", NodeType::any, "in1 / in2; 0 where in2 is 0", {{node_table::kIn1, node_table::kOne2}}},
    NodeInfo{NodeOp::modulo, "modulo", NodeType::any, "in1 - in2 floor(in1 / in2); 0 where in2 is 0", {{node_table::kIn1, node_table::kOne2}}},
    NodeInfo{NodeOp::absval, "absval", NodeType::any, "|in|", {{node_table::kIn}}},
    NodeInfo{NodeOp::sign, "sign", NodeType::any, "-1, 0 or 1", {{node_table::kIn}}},
    NodeInfo{NodeOp::floor, "floor", NodeType::any, "Next whole number below.", {{node_table::kIn}}},
    NodeInfo{NodeOp::ceil, "ceil", NodeType::any, "Next whole number above.", {{node_table::kIn}}},
    NodeInfo{NodeOp::round, "round", NodeType::any, "Nearest whole number.", {{node_table::kIn}}},
    NodeInfo{NodeOp::power, "power", NodeType::any, "in1 to the power in2; 0 for in1 below 0", {{node_table::kIn1, node_table::kOne2}}},
    NodeInfo{NodeOp::sin, "sin", NodeType::any, "Sine of radians.", {{node_table::kIn}}},
    NodeInfo{NodeOp::cos, "cos", NodeType::any, "Cosine of radians.", {{node_table::kIn}}},
    NodeInfo{NodeOp::asin, "asin", NodeType::any, "Its angle in radians; in kept within -1 and 1.", {{node_table::kIn}}},
    NodeInfo{NodeOp::acos, "acos", NodeType::any, "Its angle in radians; in kept within -1 and 1.", {{node_table::kIn}}},
    NodeInfo{NodeOp::atan2, "atan2", NodeType::any, "Angle of the point inx, iny in radians.", {{{"iny", NodeType::any}, {"inx", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::sqrt, "sqrt", NodeType::any, "Square root; 0 below 0.", {{node_table::kIn}}},
    NodeInfo{NodeOp::ln, "ln", NodeType::any, "Natural logarithm; that of 1e-30 below it.", {{{"in", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::exp, "exp", NodeType::any, "e to the power in.", {{node_table::kIn}}},
    NodeInfo{NodeOp::clamp, "clamp", NodeType::any, "in kept within low and high.", {{node_table::kIn, {"low", NodeType::any}, {"high", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::min, "min", NodeType::any, "The lesser.", {{node_table::kIn1, node_table::kIn2}}},
    NodeInfo{NodeOp::max, "max", NodeType::any, "The greater.", {{node_table::kIn1, node_table::kIn2}}},
    NodeInfo{NodeOp::invert, "invert", NodeType::any, "amount - in", {{node_table::kIn, {"amount", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::normalize, "normalize", NodeType::any, "in / |in|", {{node_table::kIn}}},
    NodeInfo{NodeOp::magnitude, "magnitude", NodeType::scalar, "|in|", {{{"in", NodeType::vector3}}}},
    NodeInfo{NodeOp::dotproduct, "dotproduct", NodeType::scalar, "in1 . in2", {{{"in1", NodeType::vector3}, {"in2", NodeType::vector3}}}},
    NodeInfo{NodeOp::crossproduct, "crossproduct", NodeType::vector3, "in1 x in2", {{{"in1", NodeType::vector3}, {"in2", NodeType::vector3}}}},
    NodeInfo{NodeOp::mix, "mix", NodeType::any, "bg where mix is 0, fg where it is 1; what is not seen is not read.", {{{"fg", NodeType::any}, {"bg", NodeType::any}, {"mix", NodeType::scalar}}}},
    NodeInfo{NodeOp::remap, "remap", NodeType::any, "inlow..inhigh to outlow..outhigh.",
             {{node_table::kIn, {"inlow", NodeType::any}, {"inhigh", NodeType::any, {1, 1, 1}}, {"outlow", NodeType::any}, {"outhigh", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::smoothstep, "smoothstep", NodeType::any, "0 below low, 1 above high, smooth between.", {{node_table::kIn, {"low", NodeType::any}, {"high", NodeType::any, {1, 1, 1}}}}},
    NodeInfo{NodeOp::ramplr, "ramplr", NodeType::any, "valuel at u = 0 to valuer at u = 1.", {{{"valuel", NodeType::any}, {"valuer", NodeType::any}, node_table::kPlace}}},
    NodeInfo{NodeOp::ramptb, "ramptb", NodeType::any, "valuet at v = 1 to valueb at v = 0.", {{{"valuet", NodeType::any}, {"valueb", NodeType::any}, node_table::kPlace}}},
    NodeInfo{NodeOp::splitlr, "splitlr", NodeType::any, "valuel where u is below center, else valuer.", {{{"valuel", NodeType::any}, {"valuer", NodeType::any}, {"center", NodeType::scalar, {0.5f, 0, 0}}, node_table::kPlace}}},
    NodeInfo{NodeOp::splittb, "splittb", NodeType::any, "valueb where v is below center, else valuet.", {{{"valuet", NodeType::any}, {"valueb", NodeType::any}, {"center", NodeType::scalar, {0.5f, 0, 0}}, node_table::kPlace}}},
    NodeInfo{NodeOp::luminance, "luminance", NodeType::scalar, "Relative luminance.", {{{"in", NodeType::color}}}},
    NodeInfo{NodeOp::contrast, "contrast", NodeType::any, "(in - pivot) amount + pivot", {{node_table::kIn, {"amount", NodeType::any, {1, 1, 1}}, {"pivot", NodeType::any, {0.5f, 0.5f, 0.5f}}}}},
    NodeInfo{NodeOp::saturate, "saturate", NodeType::color, "amount 0: grey, 1: as it is, above: more colour.", {{{"in", NodeType::color}, {"amount", NodeType::scalar, {1, 0, 0}}}}},
    NodeInfo{NodeOp::hsvadjust, "hsvadjust", NodeType::color, "amount: added to hue (1 is a turn), factors on saturation and value.", {{{"in", NodeType::color}, {"amount", NodeType::vector3, {0, 1, 1}}}}},
    NodeInfo{NodeOp::rgbtohsv, "rgbtohsv", NodeType::color, "Hue, saturation, value.", {{{"in", NodeType::color}}}},
    NodeInfo{NodeOp::hsvtorgb, "hsvtorgb", NodeType::color, "Back from hue, saturation, value.", {{{"in", NodeType::color}}}},
    NodeInfo{NodeOp::combine3, "combine3", NodeType::color, "Three numbers.", {{{"in1", NodeType::scalar}, {"in2", NodeType::scalar}, {"in3", NodeType::scalar}}}},
    NodeInfo{NodeOp::extract, "extract", NodeType::scalar, "Component 0, 1 or 2.", {{{"in", NodeType::any}, {"index", NodeType::scalar}}}},
    NodeInfo{NodeOp::ifgreater, "ifgreater", NodeType::any, "in1 if value1 > value2, else in2.", {{{"value1", NodeType::scalar, {1, 0, 0}}, {"value2", NodeType::scalar}, node_table::kIn1, node_table::kIn2}}},
    NodeInfo{NodeOp::switch_, "switch", NodeType::any, "in1 where which is below 1, in2 below 2, ...",
             {{{"which", NodeType::scalar}, node_table::kIn1, node_table::kIn2, {"in3", NodeType::any}, {"in4", NodeType::any}, {"in5", NodeType::any},
               {"in6", NodeType::any}, {"in7", NodeType::any}, {"in8", NodeType::any}, {"in9", NodeType::any}, {"in10", NodeType::any}}}},
    NodeInfo{NodeOp::rotate3d, "rotate3d", NodeType::vector3, "in turned about axis by amount (degrees).", {{{"in", NodeType::vector3}, {"amount", NodeType::scalar}, {"axis", NodeType::vector3, {0, 1, 0}}}}},
    NodeInfo{NodeOp::place2d, "place2d", NodeType::vector2, "texcoord about pivot: divided by scale, turned by rotate (degrees), less offset.",
             {{node_table::kPlace, {"pivot", NodeType::vector2}, {"scale", NodeType::vector2, {1, 1, 0}}, {"rotate", NodeType::scalar}, {"offset", NodeType::vector2}}}},
    NodeInfo{NodeOp::rotate2d, "rotate2d", NodeType::vector2, "in turned by amount (degrees).", {{{"in", NodeType::vector2}, {"amount", NodeType::scalar}}}},
    NodeInfo{NodeOp::blackbody, "blackbody", NodeType::color, "Colour of a glowing body at a temperature in kelvin, of luminance one.", {{{"temperature", NodeType::scalar, {5000, 0, 0}}}}},
    NodeInfo{NodeOp::noise2d, "noise2d", NodeType::scalar, "Gradient noise: amplitude about pivot; color is three independent of each other.", {{{"amplitude", NodeType::scalar, {1, 0, 0}}, {"pivot", NodeType::scalar}, node_table::kPlace}}, {{{"color", NodeType::color}}}},
    NodeInfo{NodeOp::noise3d, "noise3d", NodeType::scalar, "Gradient noise in space; color is three independent of each other.", {{{"amplitude", NodeType::scalar, {1, 0, 0}}, {"pivot", NodeType::scalar}, node_table::kAt}}, {{{"color", NodeType::color}}}},
    NodeInfo{NodeOp::fractal2d, "fractal2d", NodeType::scalar, "Octaves of noise; color is three independent of each other.",
             {{{"amplitude", NodeType::scalar, {1, 0, 0}}, {"octaves", NodeType::scalar, {3, 0, 0}}, {"lacunarity", NodeType::scalar, {2, 0, 0}}, {"diminish", NodeType::scalar, {0.5f, 0, 0}}, node_table::kPlace}}, {{{"color", NodeType::color}}}},
    NodeInfo{NodeOp::fractal3d, "fractal3d", NodeType::scalar, "Octaves of noise in space; color is three independent of each other.",
             {{{"amplitude", NodeType::scalar, {1, 0, 0}}, {"octaves", NodeType::scalar, {3, 0, 0}}, {"lacunarity", NodeType::scalar, {2, 0, 0}}, {"diminish", NodeType::scalar, {0.5f, 0, 0}}, node_table::kAt}}, {{{"color", NodeType::color}}}},
    NodeInfo{NodeOp::cellnoise2d, "cellnoise2d", NodeType::scalar, "A number in [0, 1) for each unit square.", {{node_table::kPlace}}},
    NodeInfo{NodeOp::cellnoise3d, "cellnoise3d", NodeType::scalar, "A number in [0, 1) for each unit cube.", {{node_table::kAt}}},
    NodeInfo{NodeOp::worleynoise2d, "worleynoise2d", NodeType::scalar, "Distance to the nearest of scattered points; distances: to the nearest three.", {{node_table::kPlace, {"jitter", NodeType::scalar, {1, 0, 0}}}}, {{{"f2"}, {"cell"}, {"distances", NodeType::vector3}}}},
    NodeInfo{NodeOp::worleynoise3d, "worleynoise3d", NodeType::scalar, "The same in space.", {{node_table::kAt, {"jitter", NodeType::scalar, {1, 0, 0}}}}, {{{"f2"}, {"cell"}, {"distances", NodeType::vector3}}}},
    NodeInfo{NodeOp::checkerboard, "checkerboard", NodeType::color, "Squares of two colours.",
             {{{"color1", NodeType::color, {1, 1, 1}}, {"color2", NodeType::color}, {"uvtiling", NodeType::vector2, {8, 8, 0}}, {"uvoffset", NodeType::vector2}, node_table::kPlace}}},
    NodeInfo{NodeOp::brick, "brick", NodeType::color, "A brick wall; units are those of texcoord (metres for the defaults).",
             {{node_table::kPlace, {"size", NodeType::vector2, {0.215f, 0.065f, 0}}, {"mortar_width", NodeType::scalar, {0.01f, 0, 0}}, {"row_offset", NodeType::scalar, {0.5f, 0, 0}},
               {"variation", NodeType::scalar, {0.7f, 0, 0}}, {"irregularity", NodeType::scalar, {0.3f, 0, 0}}, {"grain", NodeType::scalar, {0.4f, 0, 0}},
               {"color1", NodeType::color, {0.30f, 0.085f, 0.05f}}, {"color2", NodeType::color, {0.52f, 0.21f, 0.115f}}, {"mortar", NodeType::color, {0.46f, 0.43f, 0.39f}}}},
             {{{"height"}, {"mortar_mask"}}}},
    NodeInfo{NodeOp::wood, "wood", NodeType::color, "Growth rings about the z axis of position.",
             {{node_table::kAt, {"ring_width", NodeType::scalar, {0.02f, 0, 0}}, {"latewood", NodeType::scalar, {0.45f, 0, 0}}, {"distortion", NodeType::scalar, {1, 0, 0}},
               {"ring_variation", NodeType::scalar, {0.6f, 0, 0}}, {"grain", NodeType::scalar, {0.5f, 0, 0}}, {"rays", NodeType::scalar, {0.3f, 0, 0}},
               {"earlywood", NodeType::color, {0.50f, 0.29f, 0.135f}}, {"latewood_color", NodeType::color, {0.235f, 0.105f, 0.04f}}}},
             {{{"height"}, {"roughness"}, {"ring"}}}},
    NodeInfo{NodeOp::marble, "marble", NodeType::color, "Veined stone.",
             {{node_table::kAt, {"frequency", NodeType::scalar, {2, 0, 0}}, {"turbulence", NodeType::scalar, {1, 0, 0}}, {"sharpness", NodeType::scalar, {0.5f, 0, 0}}, {"veins", NodeType::scalar, {0.8f, 0, 0}},
               {"base", NodeType::color, {0.83f, 0.81f, 0.78f}}, {"cloud", NodeType::color, {0.6f, 0.6f, 0.6f}}, {"vein", NodeType::color, {0.13f, 0.14f, 0.16f}}}},
             {{{"vein_mask"}}}},
    NodeInfo{NodeOp::cloth, "cloth", NodeType::color, "A weave: plain 1 1 1, twill 2 2 1, satin 4 1 2; normal and direction are those of the thread, unit, in the world, where texcoord lies as the surface's does.",
             {{node_table::kPlace, {"threads", NodeType::vector2, {40, 40, 0}}, {"over", NodeType::scalar, {1, 0, 0}}, {"under", NodeType::scalar, {1, 0, 0}}, {"step", NodeType::scalar, {1, 0, 0}},
               {"thread_width", NodeType::scalar, {0.85f, 0, 0}}, {"relief", NodeType::scalar, {0.5f, 0, 0}}, {"variation", NodeType::scalar, {0.15f, 0, 0}}, {"fibres", NodeType::scalar, {0.3f, 0, 0}},
               {"warp", NodeType::color, {0.11f, 0.16f, 0.32f}}, {"weft", NodeType::color, {0.55f, 0.55f, 0.53f}}}},
             {{{"height"}, {"coverage"}, {"warp_share"}, {"normal", NodeType::vector3}, {"direction", NodeType::vector3}}}},
    NodeInfo{NodeOp::rust, "rust", NodeType::color, "Rust in patches. Its colour, height and roughness are those of rust alone: put it over what rusts by its mask.",
             {{node_table::kAt, {"spread", NodeType::scalar, {0.4f, 0, 0}}, {"frequency", NodeType::scalar, {3, 0, 0}}, {"detail", NodeType::scalar, {0.6f, 0, 0}}, {"softness", NodeType::scalar, {0.15f, 0, 0}},
               {"dark", NodeType::color, {0.055f, 0.018f, 0.009f}}, {"bright", NodeType::color, {0.42f, 0.13f, 0.025f}}}},
             {{{"mask"}, {"height"}, {"roughness"}}}},
    NodeInfo{NodeOp::flakes, "flakes", NodeType::vector3, "Flakes of metal paint: a unit normal in the world, tilted from flake to flake; flakes too small to be seen turn into roughness.",
             {{node_table::kAt, {"normal", NodeType::vector3}, {"size", NodeType::scalar, {0.01f, 0, 0}}, {"coverage", NodeType::scalar, {0.5f, 0, 0}}, {"spread", NodeType::scalar, {0.4f, 0, 0}},
               {"roughness", NodeType::scalar, {0.1f, 0, 0}}}},
             {{{"mask"}, {"random"}, {"roughness"}}}},
    NodeInfo{NodeOp::edgewear, "edgewear", NodeType::scalar, "1 on convex edges of a mesh where faces meet at `angle` degrees or more, 0 from `width` on; `contrast` hardens the rim.",
             {{node_table::kAt, {"width", NodeType::scalar, {0.02f, 0, 0}}, {"angle", NodeType::scalar, {30, 0, 0}}, {"contrast", NodeType::scalar, {1, 0, 0}}}}},
    NodeInfo{NodeOp::layer, "layer", NodeType::any, "fg on bg by mask and a blend mode: 0 over, 1 multiply, 2 screen, 3 overlay, 4 add, 5 subtract, 6 max, 7 min, 8 soft light; bg is not read below a whole 'over'.",
             {{{"bg", NodeType::any}, {"fg", NodeType::any}, {"mask", NodeType::scalar, {1, 0, 0}}, {"blend", NodeType::scalar}}}},
};
// clang-format on

/// Index into kNodes, -1 for an unknown name.
constexpr int find_node(std::string_view name) {
    for (std::size_t i = 0; i < kNodes.size(); ++i)
        if (kNodes[i].name == name) return static_cast<int>(i);
    return -1;
}

/// Whether an output (0 the main one) is a vector that stands beside a main one.
constexpr bool is_vector_output(int node, int output) {
    if (output <= 0) return false;
    const NodeInfo& info = kNodes[static_cast<std::size_t>(node)];
    return info.output_list[static_cast<std::size_t>(output - 1)].type != NodeType::scalar;
}

constexpr bool is_in_order() {
    for (std::size_t i = 0; i < kNodes.size(); ++i)
        if (kNodes[i].op != static_cast<NodeOp>(i)) return false;
    return true;
}
static_assert(is_in_order(), "kNodes stands in the order of NodeOp");

}  // namespace tessera
