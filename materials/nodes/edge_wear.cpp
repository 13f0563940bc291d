#include "materials/nodes/edge_wear.h"

#include "materials/nodes/lattice.h"

namespace tessera {
namespace {

// A smooth step down across the edge, its middle half way out, made steeper by the contrast.
struct Profile {
    float width, contrast;

    float step(float x) const { return 0.5f + contrast * (0.5f - x / width); }
    float at(float x) const {
        const float s = clamp01(step(x));
        return s * s * (3.0f - 2.0f * s);
    }
    // Of both sides of the edge, from it to x.
    float integral(float x) const {
        const float part = width / contrast * (upto(step(0.0f)) - upto(step(std::fabs(x))));
        return x < 0.0f ? -part : part;
    }

private:
    static float upto(float s) {
        const float t = clamp01(s);
        return t * t * t * (1.0f - 0.5f * t) + std::max(s - 1.0f, 0.0f);
    }
};

}  // namespace

float edge_wear(const CreaseTree& creases, Vec3f p, const EdgeWearParams& e, float size,
                bool front) noexcept {
    if (!(e.width > 0.0f)) return 0.0f;
    const Profile profile{within(e.width, 1e-6f, 1e6f), within(e.contrast, 1.0f, 1e3f)};
    const float w = footprint(size), reach = profile.width + 0.5f * w;
    const float angle = within(e.angle_deg, 0.0f, 180.0f) * (kPi / 180.0f);
    const float d = creases.distance(p, reach, angle - 1e-4f, front);
    if (w < 1e-3f * profile.width) return profile.at(d);
    return clamp01((profile.integral(d + 0.5f * w) - profile.integral(d - 0.5f * w)) / w);
}

}  // namespace tessera
