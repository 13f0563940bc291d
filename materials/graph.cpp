#include "materials/graph.h"

#include <algorithm>
#include <cmath>

#include "materials/fresnel.h"
#include "materials/nodes/edge_wear.h"
#include "materials/relief.h"
#include "renderer/core/sampler.h"

namespace tessera {
namespace {

// Flatter creases are those of a rounding, which is to be left alone.
constexpr float kLeastCrease_deg = 2.0f;

bool reads_point(NodeOp op) {
    switch (op) {
        case NodeOp::texcoord:
        case NodeOp::position:
        case NodeOp::normal:
        case NodeOp::geomcolor:
        case NodeOp::viewdirection:
        case NodeOp::facingratio:
        case NodeOp::fresnel:
        case NodeOp::random:
        case NodeOp::named:
        case NodeOp::image:
        case NodeOp::triplanar:
        case NodeOp::tangent:
        case NodeOp::normalmap:
        case NodeOp::bump:
        case NodeOp::edgewear:
            return true;
        default:
            return false;
    }
}

bool same(const Wire& a, const Wire& b) {
    return a.op == b.op && a.output == b.output && (a.op >= 0 || a.constant == b.constant);
}

bool same(const Graph::Op& a, const Graph::Op& b) {
    if (a.op != b.op || a.texture != b.texture || a.vector != b.vector || a.inputs != b.inputs)
        return false;
    for (int i = 0; i < a.inputs; ++i)
        if (!same(a.in[i], b.in[i])) return false;
    return true;
}

NamedBy whose(float by) {
    return by >= 2.0f ? NamedBy::material : (by >= 1.0f ? NamedBy::object : NamedBy::instance);
}

// Objects are told apart by face; the rest is known of any point.
bool goes_by_object(const Graph::Op& op) {
    if (op.op != NodeOp::random && op.op != NodeOp::named) return false;
    return op.in[1].op >= 0 || whose(op.in[1].constant.x) == NamedBy::object;
}

// As many as a node has are written; clearing the rest would take longer than many a node.
struct Inputs {
    Inputs() {}
    union {
        NodeResult at[kMaxNodeInputs];
    };
};

Vec3f output_of(const NodeResult& r, int output) {
    return output == 0 ? r.v : Vec3f(r.more[output - 1]);
}

}  // namespace

// Directions that are zero when none is given: how the surface faces the viewer is known.
bool faces(NodeOp op) { return op == NodeOp::facingratio || op == NodeOp::fresnel; }

// Whose wires carry directions of the world, found in a tangent frame.
bool in_tangent_frame(const Graph::Op& op) { return op.op == NodeOp::cloth && op.vector > 0; }

// An input for a place or normal that is given none takes the surface's own.
Wire Graph::wire_of(const std::vector<NodeDesc>& nodes, const NodeDesc& desc, std::size_t input) {
    const NodeInputInfo& info = kNodes[static_cast<std::size_t>(desc.type)].inputs()[input];
    if (desc.given[input]) {
        const NodeValue& v = desc.inputs[input];
        if (v.node >= 0) return add(nodes, v.node, v.output);
        return {-1, 0, Vec3f(v.value)};
    }
    for (const NodeOp op : {NodeOp::texcoord, NodeOp::position, NodeOp::normal}) {
        const NodeInfo& of_surface = kNodes[static_cast<std::size_t>(op)];
        if (info.name != of_surface.name || faces(kNodes[static_cast<std::size_t>(desc.type)].op))
            continue;
        Op own;
        own.op = op;
        own.inputs = static_cast<std::uint8_t>(of_surface.inputs().size());
        return add_op(desc, own);
    }
    const auto& i = info.initial;
    if (info.type == NodeType::scalar) return {-1, 0, Vec3f(i[0])};
    return {-1, 0, Vec3f(i)};
}

Wire Graph::add(const std::vector<NodeDesc>& nodes, int node, int output) {
    const int vector =
        is_vector_output(nodes[static_cast<std::size_t>(node)].type, output) ? output : 0;
    const auto found = known_.find({node, vector});
    Wire wire;
    if (found != known_.end()) {
        wire = found->second;
    } else {
        const NodeDesc& desc = nodes[static_cast<std::size_t>(node)];
        Op op;
        op.op = kNodes[static_cast<std::size_t>(desc.type)].op;
        op.color = desc.color;
        op.texture = desc.texture;
        op.vector = static_cast<std::uint8_t>(vector);
        op.inputs = static_cast<std::uint8_t>(desc.inputs.size());
        for (std::size_t i = 0; i < desc.inputs.size(); ++i) op.in[i] = wire_of(nodes, desc, i);
        count_bumps(desc, op);
        wire = add_op(desc, op);
        known_[{node, vector}] = wire;
    }
    if (wire.op >= 0 && vector == 0) wire.output = static_cast<std::uint8_t>(output);
    return wire;
}

void Graph::count_bumps(const NodeDesc& desc, Op& op) const {
    for (int i = 0; i < op.inputs; ++i) {
        if (op.in[i].op < 0) continue;
        const int below = ops_[static_cast<std::size_t>(op.in[i].op)].bumps;
        const int here = below + (op.op == NodeOp::bump && i == 0 ? 1 : 0);
        op.bumps = static_cast<std::uint8_t>(std::max<int>(op.bumps, here));
    }
    if (op.bumps > kMaxBumps)
        throw Error(
            ExitCode::scene, desc.loc,
            "bumps in the heights of bumps go " + std::to_string(kMaxBumps) + " deep at most");
}

Wire Graph::add_op(const NodeDesc& desc, const Op& op) {
    if (!reads_point(op.op)) {
        NodeResult in[kMaxNodeInputs];
        bool constant = kNodes[static_cast<std::size_t>(op.op)].outputs().empty();
        for (int i = 0; i < op.inputs; ++i) {
            constant &= op.in[i].op < 0;
            in[i].v = op.in[i].constant;
        }
        if (constant) return {-1, 0, run_node(op.op, in).v};
        // A mix that is decided is what it is decided for.
        if (op.op == NodeOp::mix && op.in[2].op < 0) {
            if (op.in[2].constant.x <= 0.0f) return op.in[1];
            if (op.in[2].constant.x >= 1.0f) return op.in[0];
        }
        if (op.op == NodeOp::layer && op.in[2].op < 0) {
            if (op.in[2].constant.x <= 0.0f) return op.in[0];
            const bool over = op.in[3].op < 0 && op.in[3].constant.x < 0.5f;
            if (op.in[2].constant.x >= 1.0f && over) return op.in[1];
        }
    }
    for (std::size_t i = 0; i < ops_.size(); ++i)
        if (same(ops_[i], op)) return {static_cast<std::int16_t>(i), 0, {}};
    if (ops_.size() >= kMaxOps)
        throw Error(ExitCode::scene, desc.loc,
                    "a material's graph may have " + std::to_string(kMaxOps) + " nodes at most");
    reads_uv_ |= op.op == NodeOp::texcoord || op.op == NodeOp::image;
    reads_geometry_ |= op.op == NodeOp::position || op.op == NodeOp::normal ||
                       op.op == NodeOp::facingratio || op.op == NodeOp::random ||
                       op.op == NodeOp::viewdirection || op.op == NodeOp::fresnel ||
                       op.op == NodeOp::named || op.op == NodeOp::triplanar ||
                       op.op == NodeOp::bump || op.op == NodeOp::edgewear;
    reads_tangent_ |= op.op == NodeOp::tangent || op.op == NodeOp::normalmap ||
                      op.op == NodeOp::bump || in_tangent_frame(op);
    reads_color_ |= op.op == NodeOp::geomcolor;
    reads_attributes_ |= reads_color_ || reads_tangent_ || op.op == NodeOp::normal ||
                         op.op == NodeOp::triplanar || op.op == NodeOp::facingratio ||
                         op.op == NodeOp::fresnel || op.op == NodeOp::viewdirection ||
                         goes_by_object(op);
    if (op.op == NodeOp::edgewear) {
        const float angle = op.in[2].op < 0 ? op.in[2].constant.x : 0.0f;
        crease_angle_ = std::min(crease_angle_, std::max(angle, kLeastCrease_deg));
    }
    ops_.push_back(op);
    return {static_cast<std::int16_t>(ops_.size() - 1), 0, {}};
}

Vec3f GraphRun::value(const Wire& wire) noexcept {
    return wire.op < 0 ? wire.constant : result(wire).v;
}

NodeResult GraphRun::result(const Wire& wire) noexcept {
    if (wire.op < 0) return {wire.constant, 0.0f, {}};
    const auto at = static_cast<std::size_t>(wire.op);
    if (!done_[at]) {
        results_.of[at] = run(graph_.ops()[at]);
        done_[at] = true;
    }
    NodeResult r = results_.of[at];
    if (wire.output > 0) r = {output_of(r, wire.output), 0.0f, {}};
    return r;
}

NodeResult GraphRun::run(const Graph::Op& op) noexcept {
    const auto texel = [&](float u, float v, float width) {
        return store_->sample(op.texture, u, v, width, in_.seed);
    };
    switch (op.op) {
        case NodeOp::texcoord:
            return {{in_.uv.x, in_.uv.y, 0.0f}, in_.uv_width, {}};
        case NodeOp::position:
            if (value(op.in[0]).x > 0.5f) return {in_.p_world, in_.p_width, {}};
            return {in_.p_object, in_.p_width * in_.object_scale, {}};
        case NodeOp::normal:
            return {in_.n, 0.0f, {}};
        case NodeOp::geomcolor:
            return {in_.vertex_color, 0.0f, {}};
        case NodeOp::viewdirection:
            return {in_.view, 0.0f, {}};
        case NodeOp::facingratio: {
            const float along = facing(op.in[0], op.in[1]);
            const float forward = value(op.in[2]).x > 0.5f ? std::fabs(along) : along;
            return {Vec3f(value(op.in[3]).x > 0.5f ? 1.0f - forward : forward), 0.0f, {}};
        }
        case NodeOp::fresnel: {
            const float cosine = std::min(std::fabs(facing(Wire(), op.in[1])), 1.0f);
            const float ior = std::clamp(value(op.in[0]).x, 1e-3f, 1e3f);
            return {Vec3f(fresnel_dielectric(cosine, ior)), 0.0f, {}};
        }
        case NodeOp::random: {
            const auto seed = static_cast<std::uint32_t>(value(op.in[0]).x * 256.0f + 0.5f);
            const std::uint32_t who = name(value(op.in[1]).x);
            const std::uint32_t h = hash_combine(hash_combine(0x72616e64u, who), seed);
            return {Vec3f(static_cast<float>(h >> 8) * 0x1p-24f), 0.0f, {}};
        }
        case NodeOp::named: {
            const Vec3f halves = value(op.in[0]);
            const std::uint32_t who = whose(value(op.in[1]).x) == NamedBy::instance
                                          ? in_.instance_name
                                          : name(value(op.in[1]).x);
            const bool is = halves.x == static_cast<float>(who & 0xffffu) &&
                            halves.y == static_cast<float>(who >> 16);
            return {Vec3f(is ? 1.0f : 0.0f), 0.0f, {}};
        }
        case NodeOp::image: {
            if (op.texture < 0) return {Vec3f{1, 0, 1}, 0.0f, Vec3f(1.0f)};
            const NodeResult at = result(op.in[0]);
            const Vec3f tiling = value(op.in[1]), offset = value(op.in[2]);
            const float stretch = std::max(std::fabs(tiling.x), std::fabs(tiling.y));
            const Texel t = texel(at.v.x * tiling.x + offset.x, at.v.y * tiling.y + offset.y,
                                  at.width * stretch);
            return {{t[0], t[1], t[2]}, 0.0f, Vec3f(t[3])};
        }
        case NodeOp::triplanar: {
            if (op.texture < 0) return {Vec3f{1, 0, 1}, 0.0f, {}};
            const NodeResult at = result(op.in[0]);
            const float scale = value(op.in[1]).x, width = at.width * std::fabs(scale);
            const float sharp = 1.0f + 15.0f * (1.0f - clamp01(value(op.in[2]).x));
            const Vec3f p = at.v * scale;
            Vec3f w{std::pow(std::fabs(in_.n.x), sharp), std::pow(std::fabs(in_.n.y), sharp),
                    std::pow(std::fabs(in_.n.z), sharp)};
            w *= 1.0f / std::max(w.x + w.y + w.z, 1e-20f);
            Vec3f sum;
            const auto along = [&](float weight, float u, float v) {
                if (!(weight > 0.0f)) return;
                const Texel t = texel(u, v, width);
                sum += Vec3f{t[0], t[1], t[2]} * weight;
            };
            along(w.x, p.z, p.y);
            along(w.y, p.x, p.z);
            along(w.z, p.x, p.y);
            return {sum, 0.0f, {}};
        }
        case NodeOp::tangent:
            return {frame_along(outward_normal(in_), in_.dpdu).s, 0.0f, {}};
        case NodeOp::normalmap: {
            const Vec3f local = unpacked_normal(value(op.in[0]), value(op.in[1]).x);
            return {normal_from_tangent_space(in_, local), 0.0f, {}};
        }
        case NodeOp::bump: {
            const float scale = value(op.in[1]).x;
            const auto height = [&](const ShadeInput& at) {
                return GraphRun(graph_, at, store_).value(op.in[0]).x * scale;
            };
            return {bumped_normal(value(op.in[2]), in_, object_unit(in_), height), 0.0f, {}};
        }
        case NodeOp::edgewear: {
            if (!in_.creases) return {};
            const NodeResult at = result(op.in[0]);
            const EdgeWearParams wear{value(op.in[1]).x, value(op.in[2]).x, value(op.in[3]).x};
            return {Vec3f(edge_wear(*in_.creases, at.v, wear, at.width, in_.front)), 0.0f, {}};
        }
        // What is decided by one input leaves the others alone.
        case NodeOp::mix: {
            const float t = clamp01(value(op.in[2]).x);
            if (t <= 0.0f) return result(op.in[1]);
            if (t >= 1.0f) return result(op.in[0]);
            break;
        }
        case NodeOp::layer: {
            const float mask = clamp01(value(op.in[2]).x);
            if (mask <= 0.0f) return result(op.in[0]);
            if (mask >= 1.0f && value(op.in[3]).x < 0.5f) return result(op.in[1]);
            break;
        }
        case NodeOp::ifgreater:
            return result(value(op.in[0]).x > value(op.in[1]).x ? op.in[2] : op.in[3]);
        case NodeOp::switch_: {
            const float which = value(op.in[0]).x;
            const int at = which >= 9.0f ? 9 : (which >= 0.0f ? static_cast<int>(which) : 0);
            return result(op.in[1 + at]);
        }
        default:
            break;
    }
    Inputs in;
    for (int i = 0; i < op.inputs; ++i) in.at[i] = result(op.in[i]);
    if (op.vector == 0) return run_node(op.op, in.at);
    const Vec3f v = run_vector_output(op.op, op.vector, in.at);
    if (!in_tangent_frame(op)) return {v, 0.0f, {}};
    return {normal_from_tangent_space(in_, v), 0.0f, {}};
}

// Cosine between a normal and the way to the viewer; directions of no length are the surface's own.
float GraphRun::facing(const Wire& view, const Wire& normal) noexcept {
    const Vec3f v = value(view), n = value(normal);
    const float lv = length(v), ln = length(n);
    if (!(lv > 0.0f) && !(ln > 0.0f)) return in_.front ? in_.facing : -in_.facing;
    const Vec3f along = lv > 0.0f ? v / lv : in_.view;
    return -dot(along, ln > 0.0f ? n / ln : outward_normal(in_));
}

std::uint32_t GraphRun::name(float by) const noexcept {
    switch (whose(by)) {
        case NamedBy::object:
            return in_.object_name;
        case NamedBy::material:
            return in_.material_name;
        default:
            return in_.instance;
    }
}

}  // namespace tessera
