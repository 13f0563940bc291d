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

// u = 0.5 looks along -z, u grows toward +x; v = 0 is +y. d is a unit vector.
inline Vec2f uv_of(const EnvironmentLight& e, Vec3f d) {
    const float x = e.cos_rotate * d.x - e.sin_rotate * d.z,
                z = e.sin_rotate * d.x + e.cos_rotate * d.z;
    return {0.5f + atan2_turn(x, -z), 2.0f * atan2_turn(std::sqrt(x * x + z * z), d.y)};
}

inline Vec3f direction_of(const EnvironmentLight& e, Vec2f uv) {
    const SinCos phi = sincos_turn(uv.x), theta = sincos_turn(0.5f * uv.y);
    // phi is measured from u = 0, half a turn away from -z.
    const Vec3f w{-theta.sin * phi.sin, theta.cos, theta.sin * phi.cos};
    return {e.cos_rotate * w.x + e.sin_rotate * w.z, w.y, -e.sin_rotate * w.x + e.cos_rotate * w.z};
}

inline float sine_of(Vec3f d) { return std::sqrt(d.x * d.x + d.z * d.z); }

// A table's density per unit square as one per solid angle.
inline float per_solid_angle(float density, float sin_theta) {
    return density / (2.0f * kPi * kPi * sin_theta);
}

}  // namespace

Vec2f EnvironmentLight::to_uv(Vec3f d) const { return uv_of(*this, d); }

Vec3f EnvironmentLight::to_direction(Vec2f uv) const { return direction_of(*this, uv); }

inline EnvironmentLight::Corners EnvironmentLight::corners(Vec2f uv) const {
    const float x = uv.x * static_cast<float>(width) - 0.5f,
                y = uv.y * static_cast<float>(height) - 0.5f;
    const float fx = std::floor(x), fy = std::floor(y);
    const int ix = static_cast<int>(fx), iy = static_cast<int>(fy);
    const int x0 = ix < 0 ? ix + width : ix, x1 = ix + 1 >= width ? ix + 1 - width : ix + 1;
    const int y0 = iy < 0 ? 0 : iy, y1 = iy + 1 >= height ? height - 1 : iy + 1;
    return {y0 * width + x0, y0 * width + x1, y1 * width + x0, y1 * width + x1, x - fx, y - fy};
}

Color EnvironmentLight::texel(Vec2f uv) const { return blend(corners(uv)); }

Color EnvironmentLight::blend(const Corners& c) const {
    const auto at = [&](int i) { return texels[static_cast<std::size_t>(i)]; };
    return lerp(lerp(at(c.i00), at(c.i01), c.tx), lerp(at(c.i10), at(c.i11), c.tx), c.ty) * scale;
}

float EnvironmentLight::density(Vec2f uv, float sin_theta) const {
    return sin_theta > 0.0f ? per_solid_angle(table.pdf(uv), sin_theta) : 0.0f;
}

EnvironmentLight::Look EnvironmentLight::look(Vec3f d) const {
    if (width == 0) return {scale, 0.25f * kInvPi};
    const Vec2f uv = to_uv(d);
    return {texel(uv), density(uv, sine_of(d))};
}

void EnvironmentLight::look(LaneMask lanes, const Vec3Lanes& d, Look (&out)[kLanes]) const {
    if (width == 0) {
        for (LaneMask m = lanes; m != 0; m &= m - 1)
            out[std::countr_zero(m)] = {scale, 0.25f * kInvPi};
        return;
    }
    SamplePairs uv;
    float sine[kLanes];
    CornerLanes around;
    // The arithmetic of all lanes, wanted or not: it is vectorised.
    for (int i = 0; i < kLanes; ++i) {
        const Vec2f at = uv_of(*this, d[i]);
        uv.x[i] = at.x, uv.y[i] = at.y;
        sine[i] = sine_of(d[i]);
    }
    for (int i = 0; i < kLanes; ++i) around.set(i, corners(uv.at(i)));
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out[i] = {blend(around.get(i)), density(uv.at(i), sine[i])};
    }
}

bool EnvironmentLight::sample(Vec2f u, LightSample& s) const {
    s.infinite = true;
    if (width == 0) {
        s.wi = warp_sphere(u);
        s.pdf = 0.25f * kInvPi;
        s.radiance = scale;
        return true;
    }
    const Distribution2D::Sample t = table.sample(u);
    s.wi = to_direction(t.uv);
    const float sin_theta = sine_of(s.wi);
    s.pdf = sin_theta > 0.0f ? per_solid_angle(t.pdf, sin_theta) : 0.0f;
    s.radiance = texel(t.uv);
    return s.pdf > 0.0f;
}

LaneMask EnvironmentLight::sample(LaneMask lanes, const SamplePairs& u, LightSamples& out) const {
    LaneMask made = 0;
    if (width == 0) {
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
        around.set(i, corners(uv.at(i)));
        const Vec3f d = direction_of(*this, uv.at(i));
        wi.set(i, d);
        const float sin_theta = sine_of(d);
        density[i] = sin_theta > 0.0f ? per_solid_angle(density[i], sin_theta) : 0.0f;
    }
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out.wi.set(i, wi[i]);
        out.pdf[i] = density[i];
        out.radiance.set(i, blend(around.get(i)));
        out.delta[i] = 0;
        out.infinite[i] = 1;
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
    EnvironmentLight e;
    e.scale = radiance;
    e.camera_visible = camera_visible;
    return e;
}

EnvironmentLight make_environment(int width, int height, std::vector<Color> texels, Color scale,
                                  double rotate_deg, bool camera_visible) {
    EnvironmentLight e;
    e.width = width;
    e.height = height;
    e.texels = std::move(texels);
    e.scale = scale;
    e.camera_visible = camera_visible;
    const double a = rotate_deg * 3.14159265358979323846 / 180.0;
    e.cos_rotate = static_cast<float>(std::cos(a));
    e.sin_rotate = static_cast<float>(std::sin(a));
    // The mean over a texel of the bilinear look-up: weights 1/8, 6/8, 1/8 each way, times the
    // texel's solid angle.
    std::vector<double> weights(std::size_t(width) * height);
    const auto at = [&](int x, int y) {
        return luminance_of(
            e.texels[std::size_t(std::clamp(y, 0, height - 1)) * width + (x + width) % width]);
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
        }
    }
    e.table = Distribution2D(width, height, weights);
    return e;
}

}  // namespace tessera
