#include "renderer/lights/light_set.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <set>

#include "renderer/core/warp.h"
#include "renderer/lights/mesh_lights.h"

namespace tessera {
namespace {

constexpr double kPiD = 3.14159265358979323846;

double mean_of(Color c) {
    return (static_cast<double>(c.x) + static_cast<double>(c.y) + static_cast<double>(c.z)) / 3.0;
}

// A light is asked at least this share of the time that equal chances would give it: power says
// nothing of distance.
constexpr double kFloor = 0.1;

// By the chord: 1 - cos is exact for small angles so, where the dot product is not.
inline bool is_towards(const DistantLight& l, Vec3f d) {
    return 0.5f * length2(d - l.to_light) <= l.one_minus_cos;
}

LaneMask lanes_towards(const DistantLight& l, const Vec3Lanes& d) {
    LaneFlags flags;
    for (int i = 0; i < kLanes; ++i) flags.is[i] = is_towards(l, d[i]);
    return flags.mask();
}

EnvironmentLight::Look seen_along(const DistantLight& l, Vec3f d) {
    if (!is_towards(l, d)) return {};
    return {l.radiance, 1.0f / (2.0f * kPi * l.one_minus_cos)};
}

// What these lanes see is another map's.
void replace(const LatLongMap& map, LaneMask lanes, const Vec3Lanes& d,
             EnvironmentLight::Look (&seen)[kLanes]) {
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        seen[i].radiance = map.look(d[i]);
    }
}

// Over the sphere: rows weigh by their sine.
Color mean_radiance(const LatLongMap& e) {
    if (e.width == 0) return e.scale;
    Vec3d sum;
    double weight = 0;
    for (int y = 0; y < e.height; ++y) {
        const double sine = std::sin((y + 0.5) / e.height * kPiD);
        for (int x = 0; x < e.width; ++x)
            sum += Vec3d(e.texels[std::size_t(y) * e.width + x]) * sine;
        weight += sine * e.width;
    }
    return Vec3f(sum / weight) * e.scale;
}

}  // namespace

LightSet::LightSet(std::vector<Light> lights, const std::vector<double>& powers,
                   std::vector<LightLabel> labels)
    : lights_(std::move(lights)), labels_(std::move(labels)) {
    labels_.resize(lights_.size());
    double sum = 0;
    int alive = 0;
    for (double p : powers) sum += p, alive += p > 0;
    std::vector<double> weights;
    for (double p : powers)
        weights.push_back(p > 0 ? (1 - kFloor) * p / sum + kFloor / alive : 0.0);
    choice_ = AliasTable(weights);
    sampled_ = alive;
    for (int i = 0; i < size(); ++i) {
        kinds_.push_back(static_cast<std::uint8_t>(lights_[i].index()));
        const auto* distant = std::get_if<DistantLight>(&lights_[i]);
        if (std::holds_alternative<EnvironmentLight>(lights_[i]) ||
            (distant && distant->one_minus_cos > 0.0f)) {
            infinite_.push_back(i);
        }
        const bool delta = std::holds_alternative<PointLight>(lights_[i]) ||
                           std::holds_alternative<SpotLight>(lights_[i]) ||
                           (distant && distant->one_minus_cos == 0.0f);
        hittable_ |= !delta;
        if (const auto* e = std::get_if<EnvironmentLight>(&lights_[i])) {
            if (e->reflection) own_reflection_ = i;
            ambient_ += mean_radiance(e->map);
        }
    }
}

LaneMask LightSet::sample(LaneMask lanes, const LightReference (&refs)[kLanes],
                          const float (&u_choice)[kLanes], const SamplePairs& u,
                          LightSamples& out) const noexcept {
    constexpr std::size_t kMany = 4096;  // from here on 24 bits show
    const bool many = lights_.size() > kMany;
    AliasTable::Pick picks[kLanes];
    LaneMask of_kind[std::variant_size_v<Light>] = {};
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        picks[i] = many
                       ? choice_.sample(u_choice[i], hash_u32(std::bit_cast<std::uint32_t>(u.x[i])))
                       : choice_.sample(u_choice[i]);
        const LaneMask chosen = static_cast<LaneMask>(picks[i].probability > 0.0f);
        of_kind[kinds_[picks[i].index]] |= chosen << i;
        __builtin_prefetch(&lights_[picks[i].index]);  // there may be a million
    }
    // Kind by kind: lanes that do the same thing follow each other.
    LaneMask made = 0;
    for (LaneMask rest : of_kind) {
        while (rest != 0) {
            const int first = std::countr_zero(rest);
            const Light& light = lights_[picks[first].index];
            LaneMask same = 1u << first;
            if (std::holds_alternative<MeshLight>(light)) {
                const Light* chosen[kLanes];
                for (LaneMask m = rest; m != 0; m &= m - 1) {
                    const int i = std::countr_zero(m);
                    chosen[i] = &lights_[picks[i].index];
                }
                made |= sample_mesh_lights(rest, chosen, refs, u, out);
                break;
            }
            const auto* sky = std::get_if<EnvironmentLight>(&light);
            const auto* sun = std::get_if<DistantLight>(&light);
            if (sky || sun) {
                for (LaneMask m = rest; m != 0; m &= m - 1) {
                    const int i = std::countr_zero(m);
                    if (picks[i].index == picks[first].index) same |= 1u << i;
                }
                made |= sky ? sky->sample(same, u, out) : sun->sample(same, u, out);
            } else {
                LightSample s;
                if (sample_light(light, refs[first], u.at(first), s)) {
                    made |= same;
                    out.set(first, s);
                }
            }
            rest &= ~same;
        }
    }
    for (LaneMask m = made; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out.pdf[i] *= picks[i].probability;
        out.light[i] = static_cast<std::int32_t>(picks[i].index);
    }
    return made;
}

float LightSet::pdf(int index, const LightReference& ref, Vec3f wi, Vec3f p, Vec3f n,
                    std::int32_t material) const noexcept {
    const float choice = probability(index);
    return choice > 0.0f ? choice * light_pdf(lights_[index], ref, wi, p, n, material) : 0.0f;
}

void LightSet::escaped(LaneMask lanes, LaneMask specular, const Vec3Lanes& d,
                       const float (&bsdf_pdf)[kLanes], bool camera, Color (&out)[kLanes],
                       EscapeSink* sink) const noexcept {
    for (LaneMask m = lanes; m != 0; m &= m - 1) out[std::countr_zero(m)] = Color(0.0f);
    EnvironmentLight::Look seen[kLanes];
    for (int light : infinite_) {
        LaneMask seeing = lanes;
        if (const auto* sky = std::get_if<EnvironmentLight>(&lights_[light])) {
            if (camera && !sky->camera_visible) continue;
            sky->look(lanes, d, seen);
            if (camera && sky->camera) replace(*sky->camera, lanes, d, seen);
            if (!camera && sky->reflection) replace(*sky->reflection, lanes & specular, d, seen);
        } else {
            const auto& sun = std::get<DistantLight>(lights_[light]);
            if (camera && !sun.camera_visible) continue;
            seeing &= lanes_towards(sun, d);
            for (LaneMask m = seeing; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                seen[i] = seen_along(sun, d[i]);
            }
        }
        const float choice = probability(light);
        for (LaneMask m = seeing; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            const float weight =
                bsdf_pdf[i] > 0.0f ? mis_power(bsdf_pdf[i], choice * seen[i].pdf) : 1.0f;
            out[i] += seen[i].radiance * weight;
            if (sink) sink->see(light, i, seen[i].radiance * weight);
        }
    }
}

Color LightSet::reflection(Vec3f d) const noexcept {
    return std::get<EnvironmentLight>(lights_[own_reflection_]).reflection->look(d);
}

Color LightSet::background(Vec3f d, bool camera) const noexcept {
    Color sum(0.0f);
    for (int light : infinite_) {
        if (const auto* sky = std::get_if<EnvironmentLight>(&lights_[light])) {
            const LatLongMap* own = (camera ? sky->camera : sky->reflection).get();
            if (!camera || sky->camera_visible) sum += (own ? *own : sky->map).look(d);
        } else {
            const auto& sun = std::get<DistantLight>(lights_[light]);
            if (!camera || sun.camera_visible) sum += seen_along(sun, d).radiance;
        }
    }
    return sum;
}

std::size_t LightSet::bytes() const noexcept {
    std::size_t sum = lights_.capacity() * sizeof(Light) + choice_.bytes();
    std::set<const EmissiveFaces*> shared;
    for (const Light& light : lights_) {
        if (const auto* e = std::get_if<EnvironmentLight>(&light)) sum += e->bytes();
        if (const auto* m = std::get_if<MeshLight>(&light)) shared.insert(m->faces.get());
    }
    for (const EmissiveFaces* faces : shared) sum += faces->bytes();
    return sum;
}

double light_power(const Light& light, double scene_radius, double mesh_emission) {
    const double disc = kPiD * scene_radius * scene_radius;
    struct Power {
        double disc, mesh_emission;
        double operator()(const PointLight& l) const { return 4 * kPiD * mean_of(l.intensity); }
        double operator()(const SpotLight& l) const {
            return 2 * kPiD * (1 - 0.5 * static_cast<double>(l.cos_inner + l.cos_outer)) *
                   mean_of(l.intensity);
        }
        double operator()(const DistantLight& l) const { return mean_of(l.irradiance) * disc; }
        double operator()(const QuadLight& l) const {
            return kPiD * static_cast<double>(l.area) * mean_of(l.radiance) * (l.two_sided ? 2 : 1);
        }
        double operator()(const DiscLight& l) const {
            const double r = static_cast<double>(l.radius);
            return kPiD * kPiD * r * r * mean_of(l.radiance) * (l.two_sided ? 2 : 1);
        }
        double operator()(const SphereLight& l) const {
            const double r = static_cast<double>(l.radius);
            return kPiD * 4 * kPiD * r * r * mean_of(l.radiance);
        }
        double operator()(const MeshLight&) const { return 2 * kPiD * mesh_emission; }
        double operator()(const EnvironmentLight& l) const {
            // A constant sky is found best by the rays that surfaces send anyway.
            if (l.map.width == 0) return 0;
            // The table's weights carry the sine; their mean over the sphere is mean * pi / 2.
            const double radiance = l.mean * kPiD / 2 * mean_of(l.map.scale);
            return kPiD * disc * radiance;
        }
    };
    return std::max(0.0, std::visit(Power{disc, mesh_emission}, light));
}

}  // namespace tessera
