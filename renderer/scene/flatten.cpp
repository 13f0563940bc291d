#include "renderer/scene/flatten.h"

#include <cmath>

namespace tessera {
namespace {

constexpr int kMaxNesting = 64;
constexpr std::size_t kMaxInstances = std::size_t(1) << 28;

bool finite(const Matrix34& m) {
    for (double v : m) {
        if (!std::isfinite(v) || std::abs(v) > 1e15) return false;
    }
    return true;
}

// Volume against the longest edge cubed: what is left of a unit cube. Flat shapes are not
// instances.
bool singular(const Affined& m) {
    const double longest = std::max(length(m.x), std::max(length(m.y), length(m.z)));
    return !(std::abs(m.determinant()) > 1e-18 * longest * longest * longest);
}

struct Flattener {
    const SceneDesc& desc;
    Problems& problems;
    std::vector<FlatInstance> out;
    std::uint32_t outermost = 0;

    void place(const InstanceDesc& instance, const Affined& parent, int material, int depth) {
        const int chosen = material >= 0 ? material : instance.material;
        if (depth > kMaxNesting) {
            problems.error(instance.loc,
                           "instance '" + instance.name + "': groups are nested more than " +
                               std::to_string(kMaxNesting) + " deep or contain themselves");
            return;
        }
        for (const Matrix34& rows : instance.transforms) {
            if (!finite(rows)) {
                problems.warn(instance.loc, "instance '" + instance.name +
                                                "': a transform with a value that is not finite or "
                                                "beyond 1e15 is left out");
                continue;
            }
            const Affined m = parent * affine_from_rows(rows);
            if (instance.of.kind == ShapeKind::group) {
                for (const InstanceDesc& member : desc.groups[instance.of.index].members)
                    place(member, m, chosen, depth + 1);
            } else if (singular(m)) {
                problems.warn(instance.loc,
                              "instance '" + instance.name +
                                  "': a transform that flattens the shape to nothing is left out");
            } else {
                if (out.size() >= kMaxInstances) {
                    problems.error(instance.loc, "more than 268435456 instances");
                    problems.throw_if_any();
                }
                out.push_back({instance.of.kind, instance.of.index, m, chosen, outermost});
            }
        }
    }
};

}  // namespace

std::vector<FlatInstance> flatten(const SceneDesc& desc, Problems& problems) {
    Flattener f{desc, problems, {}};
    for (const InstanceDesc& instance : desc.instances) {
        f.place(instance, Affined(), -1, 0);
        ++f.outermost;
    }
    return std::move(f.out);
}

}  // namespace tessera
