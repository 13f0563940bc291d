#include "materials/medium.h"

#include <algorithm>
#include <cmath>

namespace tessera {
namespace {

template <class Function>
Color by_channel(Color a, Color b, Function f) {
    return {f(a.x, b.x), f(a.y, b.y), f(a.z, b.z)};
}

}  // namespace

Medium transmission_medium(const SurfaceParams& p) {
    if (!(p.transmission_depth > 0.0f)) return {};
    const float per_unit = 1.0f / p.transmission_depth;
    // A colour of nothing would absorb without bound.
    const auto extinction = [&](float c, float) {
        return -std::log(std::clamp(c, 1e-6f, 1.0f)) * per_unit;
    };
    Medium m;
    m.anisotropy = std::clamp(p.transmission_scatter_anisotropy, -0.99f, 0.99f);
    m.extinction = by_channel(p.transmission_color, Color(0.0f), extinction);
    const Color scattering = p.transmission_scatter * per_unit;
    // Where more is scattered than is lost, all channels lose as much more.
    const Color absorbed = m.extinction - scattering;
    const float missing = std::max(-min_component(absorbed), 0.0f);
    m.extinction += Color(missing);
    m.albedo = by_channel(scattering, m.extinction,
                          [](float s, float e) { return e > 0.0f ? std::min(s / e, 1.0f) : 0.0f; });
    return m;
}

float single_scattering_albedo(float color, float anisotropy) {
    const float c = std::clamp(color, 0.0f, 0.999f);
    const float s = 4.09712f + 4.20863f * c - std::sqrt(9.59217f + 41.6808f * c + 17.7126f * c * c);
    return std::clamp((1.0f - s * s) / (1.0f - anisotropy * s * s), 0.0f, 1.0f);
}

Medium subsurface_medium(const SurfaceParams& p) {
    Medium m;
    m.anisotropy = std::clamp(p.subsurface_scatter_anisotropy, -0.99f, 0.99f);
    m.extinction = by_channel(p.subsurface_radius_scale, Color(0.0f), [&](float scale, float) {
        return 1.0f / std::max(scale * p.subsurface_radius, 1e-20f);
    });
    m.albedo = by_channel(p.subsurface_color, Color(0.0f), [&](float c, float) {
        return single_scattering_albedo(c, m.anisotropy);
    });
    return m;
}

}  // namespace tessera
