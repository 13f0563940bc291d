#include "renderer/io/mtlx_rewrites.h"

#include <algorithm>

#include "renderer/core/nearest_name.h"
#include "renderer/io/mtlx_rewrite.h"

namespace tessera {
namespace {

using At = MtlxGraph::NodeAt;
using Result = std::optional<MtlxValue>;
using Rewrite = MtlxRewrite;
constexpr const NodeValue &kOne = Rewrite::kOne, &kZero = Rewrite::kZero;

using Values = std::vector<NodeValue>;
Result pass(Rewrite& r) { return r.in("in"); }

bool converts(MtlxType from, MtlxType to) {
    if (width_of(from) == 0 || width_of(to) == 0) return false;
    if (is_number(from) || from == to) return true;
    if (is_number(to)) return false;
    return is_color(from) == is_color(to) || width_of(from) == width_of(to);
}

Result convert(Rewrite& r) {
    MtlxValue value = r.in("in");
    if (!r.good) return std::nullopt;
    if (!converts(value.type, r.at.type)) {
        r.mismatch("in", value);
        return std::nullopt;
    }
    if (has_fourth(r.at.type) && !has_fourth(value.type))
        value.fourth = is_number(value.type) ? value.rgb : kOne;
    value.type = r.at.type;
    value.kind = MtlxValue::Kind::plain;
    return value;
}

/// One component as a number.
NodeValue component(Rewrite& r, const MtlxValue& value, int index) {
    if (index == 3) return value.fourth;
    if (is_number(value.type)) return value.rgb;
    if (value.rgb.node < 0) return node_constant(value.rgb.value[static_cast<std::size_t>(index)]);
    return r.emit(NodeOp::extract, {value.rgb, node_constant(static_cast<float>(index))});
}

Result extract(Rewrite& r) {
    const MtlxValue value = r.in("in");
    if (!r.good) return std::nullopt;
    const float index = r.graph.number(r.at, "index", 0);
    if (!(index >= 0) || index >= static_cast<float>(width_of(value.type)) ||
        index != static_cast<float>(static_cast<int>(index))) {
        r.graph.damage(r.at, "index is no component of type " + std::string(name_of(value.type)));
        return std::nullopt;
    }
    return r.out(component(r, value, static_cast<int>(index)));
}

Result separate(Rewrite& r) {
    const MtlxValue value = r.in("in");
    if (!r.good) return std::nullopt;
    const std::string& output = r.at.output;
    const std::string letters = is_color(value.type) ? "rgba" : "xyzw";
    const std::size_t index =
        output.size() == 4 && output.starts_with("out") ? letters.find(output[3]) : letters.size();
    const int most = r.at.node.category.back() - '0';
    if (index >= static_cast<std::size_t>(most) || width_of(value.type) != most) {
        r.graph.damage(r.at, "has no output '" + output + "' of what it is given");
        return std::nullopt;
    }
    MtlxValue out = r.out(component(r, value, static_cast<int>(index)));
    out.type = MtlxType::scalar;
    return out;
}

NodeValue joined(Rewrite& r, const NodeValue& x, const NodeValue& y, const NodeValue& z) {
    if (x.node < 0 && y.node < 0 && z.node < 0) return {{x.value[0], y.value[0], z.value[0]}};
    return r.emit(NodeOp::combine3, {x, y, z});
}

Result combine(Rewrite& r) {
    const int parts = r.at.node.category.back() - '0';
    const MtlxValue a = r.in("in1"), b = r.in("in2");
    if (!r.good) return std::nullopt;
    const bool fourth = has_fourth(r.at.type);
    if (parts == 2 && fourth) {  // three and one
        MtlxValue out = r.out(a.rgb);
        out.fourth = b.rgb;
        const bool given = r.at.node.child("in1") != nullptr;
        const bool fits =
            !given || (width_of(a.type) == 3 && is_color(a.type) == is_color(r.at.type));
        if (!fits) r.mismatch("in1", a);
        return r.good ? Result(out) : std::nullopt;
    }
    const MtlxValue c = parts > 2 ? r.in("in3") : r.out(kZero);
    const MtlxValue d = parts > 3 ? r.in("in4") : r.out(kZero);
    if (width_of(r.at.type) != parts) {
        r.graph.damage(r.at, "does not come in type '" + std::string(name_of(r.at.type)) + "'");
        return std::nullopt;
    }
    int number = 0;
    for (const MtlxValue& part : {a, b, c, d}) {
        const std::string name = "in" + std::to_string(++number);
        if (r.at.node.child(name) && !is_number(part.type)) r.mismatch(name, part);
    }
    if (!r.good) return std::nullopt;
    MtlxValue out = r.out(joined(r, a.rgb, b.rgb, c.rgb));
    out.fourth = d.rgb;
    return out;
}

/// swizzle of documents before 1.39: channels = "bgr", "xxx", "r1".
Result swizzle(Rewrite& r) {
    const MtlxValue value = r.in("in");
    const std::string channels = r.graph.text(r.at, "channels", "");
    const auto width = static_cast<std::size_t>(width_of(r.at.type));
    const auto own = static_cast<std::size_t>(width_of(value.type));
    Values parts;
    for (const char c : channels) {
        std::size_t index = std::string_view("rgba").find(c);
        if (index == std::string_view::npos) index = std::string_view("xyzw").find(c);
        if (c == '0' || c == '1')
            parts.push_back(node_constant(c == '1' ? 1.0f : 0.0f));
        else if (index < own)
            parts.push_back(component(r, value, static_cast<int>(index)));
        else
            r.good = false;
    }
    if (!r.good || width == 0 || parts.size() != width) {
        r.graph.damage(r.at, "channels are '" + channels + "', must be " + std::to_string(width) +
                                 " of type " + std::string(name_of(value.type)));
        return std::nullopt;
    }
    if (width == 1) return r.out(parts[0]);
    MtlxValue out = r.out(joined(r, parts[0], parts[1], width > 2 ? parts[2] : kZero));
    if (width > 3) out.fourth = parts[3];
    return out;
}

/// Comparisons: what > cannot say by itself.
Result compare(Rewrite& r) {
    const bool equal = r.at.node.category == "ifequal";
    const bool to_boolean = r.at.type == MtlxType::boolean;
    const NodeValue v1 = r.in("value1", 1).rgb, v2 = r.in("value2", 0).rgb;
    const MtlxValue yes = to_boolean ? r.out(kOne) : r.matching("in1");
    const MtlxValue no = to_boolean ? r.out(kZero) : r.matching("in2");
    if (!r.good) return std::nullopt;
    return r.each({yes, no}, [&](const Values& v) {
        if (!equal) return r.emit(NodeOp::ifgreater, {v2, v1, v[1], v[0]});
        const NodeValue not_less = r.emit(NodeOp::ifgreater, {v2, v1, v[1], v[0]});
        return r.emit(NodeOp::ifgreater, {v1, v2, v[1], not_less});
    });
}

Result logic(Rewrite& r) {
    const std::string& category = r.at.node.category;
    if (category == "not") return r.out(r.emit(NodeOp::invert, {r.in("in").rgb, kOne}));
    const NodeValue a = r.in("in1").rgb, b = r.in("in2").rgb;
    if (category == "and") return r.out(r.emit(NodeOp::min, {a, b}));
    if (category == "or") return r.out(r.emit(NodeOp::max, {a, b}));
    return r.out(r.emit(NodeOp::absval, {r.emit(NodeOp::subtract, {a, b})}));
}

/// |x|^p with x's sign.
NodeValue signed_power(Rewrite& r, const NodeValue& x, const NodeValue& p) {
    const NodeValue size = r.emit(NodeOp::power, {r.emit(NodeOp::absval, {x}), p});
    return r.emit(NodeOp::multiply, {r.emit(NodeOp::sign, {x}), size});
}

Result arithmetic(Rewrite& r) {
    const std::string& category = r.at.node.category;
    if (category == "safepower") {
        const MtlxValue a = r.matching("in1"), b = r.matching("in2", 1);
        return r.each({a, b}, [&](const Values& v) { return signed_power(r, v[0], v[1]); });
    }
    const MtlxValue in = r.matching("in");
    return r.each({in}, [&](const Values& v) {
        if (category == "fract") return r.emit(NodeOp::modulo, {v[0], kOne});
        return r.emit(NodeOp::divide, {r.emit(NodeOp::sin, {v[0]}), r.emit(NodeOp::cos, {v[0]})});
    });
}

Result distance(Rewrite& r) {
    const MtlxValue a = r.in("in1"), b = r.in("in2");
    NodeValue difference = r.emit(NodeOp::subtract, {a.rgb, b.rgb});
    if (a.type == MtlxType::vector2)
        difference = r.emit(NodeOp::multiply, {difference, {{1, 1, 0}}});
    if (a.type != b.type || has_fourth(a.type)) r.mismatch("in1", a);
    return r.out(r.emit(NodeOp::magnitude, {difference}));
}

Result range(Rewrite& r) {
    const MtlxValue in = r.matching("in"), low = r.matching("inlow"),
                    high = r.matching("inhigh", 1), gamma = r.matching("gamma", 1),
                    out_low = r.matching("outlow"), out_high = r.matching("outhigh", 1);
    const bool clamped = r.graph.number(r.at, "doclamp", 0) != 0;
    const bool straight = gamma.is_constant() && gamma.rgb.value == Float3{1, 1, 1};
    return r.each({in, low, high, gamma, out_low, out_high}, [&](const Values& v) {
        NodeValue x = v[0];
        if (straight) {
            x = r.emit(NodeOp::remap, {x, v[1], v[2], v[4], v[5]});
        } else {
            x = r.emit(NodeOp::remap, {x, v[1], v[2], kZero, kOne});
            x = signed_power(r, x, r.emit(NodeOp::divide, {kOne, v[3]}));
            x = r.emit(NodeOp::remap, {x, kZero, kOne, v[4], v[5]});
        }
        return clamped ? r.emit(NodeOp::clamp, {x, v[4], v[5]}) : x;
    });
}

Result blend(Rewrite& r) {
    const std::string& category = r.at.node.category;
    const MtlxValue fg = r.matching("fg"), bg = r.matching("bg");
    const NodeValue share = r.in("mix", 1).rgb;
    const bool whole = !r.at.node.child("mix");
    return r.each({fg, bg}, [&](const Values& v) {
        NodeValue x;
        if (category == "plus") {
            x = r.emit(NodeOp::add, {v[1], v[0]});
        } else if (category == "minus") {
            x = r.emit(NodeOp::subtract, {v[1], v[0]});
        } else if (category == "difference") {
            x = r.emit(NodeOp::absval, {r.emit(NodeOp::subtract, {v[1], v[0]})});
        } else if (category == "dodge") {
            x = r.emit(NodeOp::divide, {v[1], r.emit(NodeOp::invert, {v[0], kOne})});
        } else if (category == "burn") {  // black where fg is
            const NodeValue b = r.emit(NodeOp::invert, {v[1], kOne});
            x = r.emit(NodeOp::invert, {r.emit(NodeOp::divide, {b, v[0]}), kOne});
            const NodeValue there = r.emit(NodeOp::absval, {r.emit(NodeOp::sign, {v[0]})});
            x = r.emit(NodeOp::multiply, {x, there});
        } else {  // screen
            const NodeValue f = r.emit(NodeOp::invert, {v[0], kOne});
            const NodeValue b = r.emit(NodeOp::invert, {v[1], kOne});
            x = r.emit(NodeOp::invert, {r.emit(NodeOp::multiply, {f, b}), kOne});
        }
        return whole ? x : r.emit(NodeOp::mix, {x, v[1], share});
    });
}

/// A share for each component is more than our node takes.
Result mix(Rewrite& r) {
    const MtlxValue fg = r.matching("fg"), bg = r.matching("bg"), share = r.matching("mix");
    return r.each({fg, bg, share}, [&](const Values& v) {
        if (is_number(share.type)) return r.emit(NodeOp::mix, {v[0], v[1], v[2]});
        const NodeValue way = r.emit(NodeOp::subtract, {v[0], v[1]});
        return r.emit(NodeOp::add, {v[1], r.emit(NodeOp::multiply, {way, v[2]})});
    });
}

Result ramp4(Rewrite& r) {
    NodeValue place;
    const bool placed = r.at.node.child("texcoord") != nullptr;
    place = placed ? r.in("texcoord").rgb : r.emit(NodeOp::texcoord, {});
    const MtlxValue tl = r.matching("valuetl"), tr = r.matching("valuetr"),
                    bl = r.matching("valuebl"), br = r.matching("valuebr");
    return r.each({tl, tr, bl, br}, [&](const Values& v) {
        const NodeValue top = r.emit(NodeOp::ramplr, {v[0], v[1], place});
        return r.emit(NodeOp::ramptb, {top, r.emit(NodeOp::ramplr, {v[2], v[3], place}), place});
    });
}

Result masked(Rewrite& r) {
    const MtlxValue in = r.matching("in");
    NodeValue share = r.in("mask", r.at.node.category == "inside" ? 1 : 0).rgb;
    if (r.at.node.category == "outside") share = r.emit(NodeOp::invert, {share, kOne});
    return r.each({in}, [&](const Values& v) { return r.emit(NodeOp::multiply, {v[0], share}); });
}

struct Row {
    std::string_view category;
    Result (*make)(Rewrite&);
    std::vector<std::string_view> inputs;
};

const std::vector<Row>& rows() {
    static const std::vector<Row> all{
        {"dot", pass, {"in", "note"}},
        {"convert", convert, {"in"}},
        {"extract", extract, {"in", "index"}},
        {"separate2", separate, {"in"}},
        {"separate3", separate, {"in"}},
        {"separate4", separate, {"in"}},
        {"combine2", combine, {"in1", "in2"}},
        {"combine3", combine, {"in1", "in2", "in3"}},
        {"combine4", combine, {"in1", "in2", "in3", "in4"}},
        {"swizzle", swizzle, {"in", "channels"}},
        {"ifgreatereq", compare, {"value1", "value2", "in1", "in2"}},
        {"ifequal", compare, {"value1", "value2", "in1", "in2"}},
        {"and", logic, {"in1", "in2"}},
        {"or", logic, {"in1", "in2"}},
        {"xor", logic, {"in1", "in2"}},
        {"not", logic, {"in"}},
        {"fract", arithmetic, {"in"}},
        {"tan", arithmetic, {"in"}},
        {"safepower", arithmetic, {"in1", "in2"}},
        {"distance", distance, {"in1", "in2"}},
        {"range", range, {"in", "inlow", "inhigh", "gamma", "outlow", "outhigh", "doclamp"}},
        {"mix", mix, {"fg", "bg", "mix"}},
        {"plus", blend, {"fg", "bg", "mix"}},
        {"minus", blend, {"fg", "bg", "mix"}},
        {"difference", blend, {"fg", "bg", "mix"}},
        {"screen", blend, {"fg", "bg", "mix"}},
        {"burn", blend, {"fg", "bg", "mix"}},
        {"dodge", blend, {"fg", "bg", "mix"}},
        {"inside", masked, {"in", "mask"}},
        {"outside", masked, {"in", "mask"}},
        {"noise2d", rewrite_noise, {"amplitude", "pivot", "texcoord"}},
        {"noise3d", rewrite_noise, {"amplitude", "pivot", "position"}},
        {"fractal2d",
         rewrite_noise,
         {"amplitude", "octaves", "lacunarity", "diminish", "texcoord"}},
        {"fractal3d",
         rewrite_noise,
         {"amplitude", "octaves", "lacunarity", "diminish", "position"}},
        {"worleynoise2d", rewrite_worley, {"texcoord", "jitter", "style"}},
        {"worleynoise3d", rewrite_worley, {"position", "jitter", "style"}},
        {"ramp4", ramp4, {"valuetl", "valuetr", "valuebl", "valuebr", "texcoord"}},
    };
    return all;
}

const Row* find_row(std::string_view category) {
    const auto found = std::find_if(rows().begin(), rows().end(),
                                    [&](const Row& row) { return row.category == category; });
    return found == rows().end() ? nullptr : &*found;
}

}  // namespace

bool is_mtlx_rewritten(std::string_view category) { return find_row(category) != nullptr; }

std::vector<std::string_view> mtlx_rewritten_nodes() {
    std::vector<std::string_view> names;
    for (const Row& row : rows()) names.push_back(row.category);
    return names;
}

std::optional<MtlxValue> read_mtlx_rewritten(MtlxGraph& graph, const At& at) {
    const Row& row = *find_row(at.node.category);
    for (const MtlxElement* element : at.node.children) {
        const std::string name = element->name();
        if (element->category != "input" ||
            std::find(row.inputs.begin(), row.inputs.end(), name) != row.inputs.end())
            continue;
        const std::vector<std::string> names(row.inputs.begin(), row.inputs.end());
        graph.damage(element->loc, at.node.subject() + ": has no input '" + name + "'" +
                                       did_you_mean(name, names));
    }
    Rewrite rewrite{graph, at};
    const Result result = row.make(rewrite);
    return rewrite.good ? result : std::nullopt;
}

}  // namespace tessera
