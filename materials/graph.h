#pragma once
// A material's nodes compiled: constants folded, equal nodes merged, nodes that nothing reads left
// out. Outputs are pulled: a node is run at most once at a point, and only if what it feeds is
// seen.

#include <bitset>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "materials/shade_input.h"
#include "renderer/api/node_table.h"
#include "renderer/api/scene_desc.h"
#include "renderer/image/texture.h"

namespace tessera {

/// A value on a wire: a number stands in x, y and z. width is the footprint of a place (texture
/// coordinates, positions), 0 for all else.
struct NodeResult {
    Vec3f v;
    float width = 0;
    Vec3f more;  // the outputs beside the main one
};

/// Where an input gets its value from.
struct Wire {
    std::int16_t op = -1;  // -1: the constant
    std::uint8_t output = 0;
    Vec3f constant;
};

class Graph {
public:
    static constexpr int kMaxOps = 256;

    struct Op {
        NodeOp op = NodeOp::constant;
        bool color = true;
        int texture = -1;
        std::uint8_t vector = 0;  // the vector output that it gives in place of the main one
        std::uint8_t inputs = 0;
        std::uint8_t bumps = 0;  // each of them asks for its height three times
        Wire in[kMaxNodeInputs];
    };

    bool empty() const noexcept { return ops_.empty(); }
    int size() const noexcept { return static_cast<int>(ops_.size()); }
    const std::vector<Op>& ops() const noexcept { return ops_; }
    bool reads_uv() const noexcept { return reads_uv_; }
    bool reads_geometry() const noexcept { return reads_geometry_; }
    bool reads_vertex_color() const noexcept { return reads_color_; }
    bool reads_tangent() const noexcept { return reads_tangent_; }
    /// Reads what only a hit knows: smooth normals, how they are seen, tangents, vertex colours.
    bool reads_attributes() const noexcept { return reads_attributes_; }
    /// How many bumps lie in the heights of bumps.
    static constexpr int kMaxBumps = 4;
    /// The least angle of creases that a node asks for, in degrees; infinite: none does.
    float crease_angle_deg() const noexcept { return crease_angle_; }

    /// Adds what an output of `nodes` needs. Throws Error(scene) when there are too many.
    Wire add(const std::vector<NodeDesc>& nodes, int node, int output);

private:
    Wire add_op(const NodeDesc& desc, const Op& op);
    void count_bumps(const NodeDesc& desc, Op& op) const;
    Wire wire_of(const std::vector<NodeDesc>& nodes, const NodeDesc& desc, std::size_t input);

    std::vector<Op> ops_;
    std::map<std::pair<int, int>, Wire> known_;  // by node and vector output
    bool reads_uv_ = false, reads_geometry_ = false, reads_color_ = false, reads_tangent_ = false;
    bool reads_attributes_ = false;
    float crease_angle_ = kInfinity;
};

/// A graph at one point.
class GraphRun {
public:
    GraphRun(const Graph& graph, const ShadeInput& in, const TextureStore* store) noexcept
        : graph_(graph), in_(in), store_(store) {}
    /// The value that a wire carries.
    Vec3f value(const Wire& wire) noexcept;
    /// How many nodes ran.
    int runs() const noexcept { return static_cast<int>(done_.count()); }

private:
    NodeResult result(const Wire& wire) noexcept;
    NodeResult run(const Graph::Op& op) noexcept;
    float facing(const Wire& view, const Wire& normal) noexcept;
    std::uint32_t name(float by) const noexcept;

    const Graph& graph_;
    const ShadeInput& in_;
    const TextureStore* store_;
    std::bitset<Graph::kMaxOps> done_;
    union Results {
        Results() noexcept {}
        NodeResult of[Graph::kMaxOps];  // made as they are asked for
    } results_;
};

/// A node of plain arithmetic, noise or pattern; inputs in the table's order, all there.
NodeResult run_node(NodeOp op, const NodeResult* in) noexcept;
/// One of its vector outputs; directions are those of a tangent frame, z outward.
Vec3f run_vector_output(NodeOp op, int output, const NodeResult* in) noexcept;

/// What random and named go by, as the number that stands in `by`.
enum class NamedBy : std::uint8_t { instance, object, material };

}  // namespace tessera
