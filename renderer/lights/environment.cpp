#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/core/fast_math.h"
#include "renderer/core/warp.h"
#include "renderer/lights/light.h"

namespace tessera {
namespace {

double luminance_of(Color c) {
    return 0.2126 * static_cast<double>(c.x) + 0.7152 * static_cast<double>(c.y) +
           0.0722 * static_cast<double>(c.z);
}

inline float sine_of(Vec3f d) { return std::sqrt(d.x * d.x + d.z * d.z); }

// A table's density per unit square as one per solid angle.
inline float per_solid_angle(float density, float sin_theta) {
    return density / (2.0f * kPi * kPi * sin_theta);
}

struct CornerLanes {
    std::int32_t i00[kLanes], i01[kLanes], i10[kLanes], i11[kLanes];
    float tx[kLanes], ty[kLanes];
    void set(int i, const LatLongMap::Corners& c) {
        i00[i] = c.i00, i01[i] = c.i01, i10[i] = c.i10, i11[i] = c.i11;
        tx[i] = c.tx, ty[i] = c.ty;
    }
    LatLongMap::Corners get(int i) const { return {i00[i], i01[i], i10[i], i11[i], tx[i], ty[i]}; }
};

// Karlik et al., "MIS Compensation: Optimizing Sampling Techniques in Multiple Importance
// Sampling", SIGGRAPH Asia 2019: the table's density less its mean. A map that is the same all over
// keeps what it has.
void compensate(std::vector<double>& weights, int width, double mean) {
    const auto rows = weights.size() / static_cast<std::size_t>(width);
    std::vector<double> above(weights.size());
    bool any = false;
    for (std::size_t i = 0; i < weights.size(); ++i) {
        const std::size_t y = i / static_cast<std::size_t>(width);
        const double v = (static_cast<double>(y) + 0.5) / static_cast<double>(rows);
        const double sine = std::sin(v * 3.14159265358979323846);
        above[i] = std::max(weights[i] - mean * sine, 0.0);
        any |= above[i] > 1e-3 * mean * sine;
    }
    if (any) weights = std::move(above);
}

}  // namespace

LatLongMap make_latlong_map(int width, int height, std::vector<Color> texels, Color scale,
                            double rotate_deg) {
    const double a = rotate_deg * 3.14159265358979323846 / 180.0;
    return {width,
            height,
            std::move(texels),
            scale,
            static_cast<float>(std::cos(a)),
            static_cast<float>(std::sin(a))};
}

float EnvironmentLight::density(Vec2f uv, float sin_theta) const {
    return sin_theta > 0.0f ? per_solid_angle(table.pdf(uv), sin_theta) : 0.0f;
}

std::size_t EnvironmentLight::bytes() const {
    return map.bytes() + table.bytes() + (camera ? camera->bytes() : 0) +
           (reflection ? reflection->bytes() : 0);
}

EnvironmentLight::Look EnvironmentLight::look(Vec3f d) const {
    if (map.width == 0) return {map.scale, 0.25f * kInvPi};
    const Vec2f uv = map.to_uv(d);
    return {map.texel(uv), density(uv, sine_of(d))};
}

void EnvironmentLight::look(LaneMask lanes, const Vec3Lanes& d, Look (&out)[kLanes]) const {
    if (map.width == 0) {
        for (LaneMask m = lanes; m != 0; m &= m - 1)
            out[std::countr_zero(m)] = {map.scale, 0.25f * kInvPi};
        return;
    }
    SamplePairs uv;
    float sine[kLanes];
    CornerLanes around;
    // The arithmetic of all lanes, wanted or not: it is vectorised.
    for (int i = 0; i < kLanes; ++i) {
        const Vec2f at = map.to_uv(d[i]);
        uv.x[i] = at.x, uv.y[i] = at.y;
        sine[i] = sine_of(d[i]);
    }
    for (int i = 0; i < kLanes; ++i) around.set(i, map.corners(uv.at(i)));
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out[i] = {map.blend(around.get(i)), density(uv.at(i), sine[i])};
    }
}

bool EnvironmentLight::sample(Vec2f u, LightSample& s) const {
    s.infinite = s.surroundings = true;
    if (map.width == 0) {
        s.wi = warp_sphere(u);
        s.pdf = 0.25f * kInvPi;
        s.radiance = map.scale;
        return true;
    }
    const Distribution2D::Sample t = table.sample(u);
    s.wi = map.to_direction(t.uv);
    const float sin_theta = sine_of(s.wi);
    s.pdf = sin_theta > 0.0f ? per_solid_angle(t.pdf, sin_theta) : 0.0f;
    s.radiance = map.texel(t.uv);
    return s.pdf > 0.0f;
}

LaneMask EnvironmentLight::sample(LaneMask lanes, const SamplePairs& u, LightSamples& out) const {
    LaneMask made = 0;
    if (map.width == 0) {
        for (LaneMask m = lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            LightSample s;
            made |= static_cast<LaneMask>(sample(u.at(i), s)) << i;
            out.set(i, s);
        }
        return made;
    }
    SamplePairs uv;
    float density[kLanes];
    table.sample(u, uv, density);
    Vec3Lanes wi;
    CornerLanes around;
    for (int i = 0; i < kLanes; ++i) {
        around.set(i, map.corners(uv.at(i)));
        const Vec3f d = map.to_direction(uv.at(i));
        wi.set(i, d);
        const float sin_theta = sine_of(d);
        density[i] = sin_theta > 0.0f ? per_solid_angle(density[i], sin_theta) : 0.0f;
    }
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out.wi.set(i, wi[i]);
        out.pdf[i] = density[i];
        out.radiance.set(i, map.blend(around.get(i)));
        out.delta[i] = 0;
        out.infinite[i] = out.surroundings[i] = 1;
        out.material[i] = -1;
        made |= static_cast<LaneMask>(density[i] > 0.0f) << i;
    }
    return made;
}

DistantLight make_distant_light(Vec3f to_light, Color irradiance, double angle_deg,
                                bool camera_visible) {
    constexpr double kPiD = 3.14159265358979323846;
    DistantLight d;
    d.to_light = to_light;
    d.frame = Frame(d.to_light);
    d.irradiance = irradiance;
    d.camera_visible = camera_visible;
    const double half = 0.5 * angle_deg * kPiD / 180;
    if (half > 0) {
        // 1 - cos by the half angle's sine, which keeps its digits; E = L pi sin^2 on a facing
        // surface.
        d.one_minus_cos = static_cast<float>(2 * std::sin(half / 2) * std::sin(half / 2));
        d.radiance =
            d.irradiance * static_cast<float>(1 / (kPiD * std::sin(half) * std::sin(half)));
    }
    return d;
}

EnvironmentLight make_constant_environment(Color radiance, bool camera_visible) {
    LatLongMap map;
    map.scale = radiance;
    return make_environment(std::move(map), camera_visible);
}

EnvironmentLight make_environment(int width, int height, std::vector<Color> texels, Color scale,
                                  double rotate_deg, bool camera_visible) {
    return make_environment(make_latlong_map(width, height, std::move(texels), scale, rotate_deg),
                            camera_visible);
}

EnvironmentLight make_environment(LatLongMap map, bool camera_visible, EnvironmentTable table) {
    EnvironmentLight e;
    e.camera_visible = camera_visible;
    e.map = std::move(map);
    if (e.map.width == 0) return e;
    const int width = e.map.width, height = e.map.height;
    // The mean over a texel of the bilinear look-up: weights 1/8, 6/8, 1/8 each way, times the
    // texel's solid angle.
    std::vector<double> weights(std::size_t(width) * height);
    double all = 0, area = 0;
    const auto at = [&](int x, int y) {
        return luminance_of(
            e.map.texels[std::size_t(std::clamp(y, 0, height - 1)) * width + (x + width) % width]);
    };
    for (int y = 0; y < height; ++y) {
        const double sine = std::sin((y + 0.5) / height * 3.14159265358979323846);
        for (int x = 0; x < width; ++x) {
            double sum = 0;
            for (int dy = -1; dy <= 1; ++dy) {
                for (int dx = -1; dx <= 1; ++dx)
                    sum += at(x + dx, y + dy) * (dx ? 0.125 : 0.75) * (dy ? 0.125 : 0.75);
            }
            weights[std::size_t(y) * width + x] = sum * sine;
            all += sum * sine, area += sine;
        }
    }
    e.mean = all / static_cast<double>(weights.size());
    if (table == EnvironmentTable::compensated) compensate(weights, width, all / area);
    e.table = Distribution2D(width, height, weights);
    return e;
}

}  // namespace tessera
