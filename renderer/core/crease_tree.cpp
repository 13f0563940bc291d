#include "renderer/core/crease_tree.h"

#include <algorithm>

namespace tessera {
namespace {

constexpr std::uint32_t kLeafSize = 8;

Vec3f middle(const Crease& c) { return c.a * 0.5f + c.b * 0.5f; }

float box_distance2(Vec3f lo, Vec3f hi, Vec3f p) {
    return length2(max(max(lo - p, p - hi), Vec3f(0.0f)));
}

float segment_distance2(const Crease& c, Vec3f p) {
    const Vec3f along = c.b - c.a, from = p - c.a;
    const float l2 = length2(along);
    const float t = l2 > 0.0f ? clamp01(dot(from, along) / l2) : 0.0f;
    return length2(from - along * t);
}

}  // namespace

CreaseTree::CreaseTree(std::vector<Crease> creases) : creases_(std::move(creases)) {
    std::erase_if(creases_, [](const Crease& c) { return !is_finite(c.a) || !is_finite(c.b); });
    creases_.shrink_to_fit();
    if (creases_.empty()) return;
    build(0, static_cast<std::uint32_t>(creases_.size()));
    nodes_.shrink_to_fit();
}

// Halves at the median of the widest axis, so that the tree is as deep as its count's logarithm.
std::uint32_t CreaseTree::build(std::uint32_t first, std::uint32_t last) {
    Node node{Vec3f(kInfinity), Vec3f(-kInfinity), first, last, 0};
    Vec3f lo = node.lo, hi = node.hi;
    for (std::uint32_t i = first; i < last; ++i) {
        const Crease& c = creases_[i];
        node.lo = min(node.lo, min(c.a, c.b)), node.hi = max(node.hi, max(c.a, c.b));
        lo = min(lo, middle(c)), hi = max(hi, middle(c));
    }
    const auto at = static_cast<std::uint32_t>(nodes_.size());
    nodes_.push_back(node);
    if (last - first <= kLeafSize) return at;
    const Vec3f span = hi - lo;
    const int axis = span.x >= span.y && span.x >= span.z ? 0 : (span.y >= span.z ? 1 : 2);
    const std::uint32_t half = first + (last - first) / 2;
    std::nth_element(
        creases_.begin() + first, creases_.begin() + half, creases_.begin() + last,
        [&](const Crease& a, const Crease& b) { return middle(a)[axis] < middle(b)[axis]; });
    build(first, half);
    nodes_[at].right = build(half, last);
    return at;
}

std::size_t CreaseTree::bytes() const noexcept {
    return creases_.capacity() * sizeof(Crease) + nodes_.capacity() * sizeof(Node);
}

float CreaseTree::distance(Vec3f p, float reach, float least, bool front) const noexcept {
    float best = reach * reach;
    struct Waiting {
        std::uint32_t node;
        float d2;
    };
    // Deep enough for 2^32 creases: of each level's two nodes one waits.
    Waiting waiting[33];
    int count = 0;
    const auto to_box = [&](std::uint32_t at) {
        return Waiting{at, box_distance2(nodes_[at].lo, nodes_[at].hi, p)};
    };
    if (!nodes_.empty()) waiting[count++] = to_box(0);
    while (count > 0) {
        const Waiting next = waiting[--count];
        if (!(next.d2 < best)) continue;
        const Node& node = nodes_[next.node];
        if (node.right != 0) {
            Waiting near = to_box(next.node + 1), far = to_box(node.right);
            if (far.d2 < near.d2) std::swap(near, far);
            if (far.d2 < best) waiting[count++] = far;
            if (near.d2 < best) waiting[count++] = near;
            continue;
        }
        for (std::uint32_t i = node.first; i < node.last; ++i) {
            const Crease& c = creases_[i];
            if ((front ? c.bend : -c.bend) >= least) best = std::min(best, segment_distance2(c, p));
        }
    }
    return best < reach * reach ? std::sqrt(best) : reach;
}

}  // namespace tessera
