#pragma once
// All lights of a scene: which one to ask, with what probability.

#include <cstdint>
#include <vector>

#include "renderer/core/light_event.h"
#include "renderer/lights/light.h"

namespace tessera {

/// What a light is to light path expressions. The faces of a mesh light are labelled by their
/// materials.
struct LightLabel {
    LightType type = LightType::light;
    int tag = 0;
};

/// Takes what rays that hit nothing see of each light.
class EscapeSink {
public:
    virtual void see(int light, int lane, Color radiance) = 0;

protected:
    ~EscapeSink() = default;
};

class LightSet {
public:
    LightSet() = default;
    /// powers: estimates in watts (any common unit); lights of power 0 are never chosen.
    LightSet(std::vector<Light> lights, const std::vector<double>& powers,
             std::vector<LightLabel> labels = {});

    bool empty() const noexcept { return lights_.empty(); }
    /// Whether sample() can find anything: false if all light is a constant sky or there is none.
    bool sampled() const noexcept { return sampled_ > 0; }
    /// Whether a ray can run into a light: false if all are points or have no angle.
    bool hittable() const noexcept { return hittable_; }
    int size() const noexcept { return static_cast<int>(lights_.size()); }
    const Light& operator[](int i) const noexcept { return lights_[i]; }
    LightLabel label(int i) const noexcept { return labels_[i]; }

    /// For each lane chooses a light by u_choice and samples it; out.pdf includes the choice.
    /// Returns the lanes that found light.
    LaneMask sample(LaneMask lanes, const LightReference (&refs)[kLanes],
                    const float (&u_choice)[kLanes], const SamplePairs& u,
                    LightSamples& out) const noexcept;
    /// Density of sample() for a point of light `index` that a ray from ref has hit.
    float pdf(int index, const LightReference& ref, Vec3f wi, Vec3f p, Vec3f n,
              std::int32_t material) const noexcept;

    /// Light from infinity along d, for rays that hit nothing. bsdf_pdf: density that made the ray,
    /// 0 if light sampling could not have made it (camera, delta): the result is weighted by the
    /// power heuristic. camera: all are camera rays; specular: lanes whose ray a specular lobe
    /// sent. sink: is told of each light, or null.
    void escaped(LaneMask lanes, LaneMask specular, const Vec3Lanes& d,
                 const float (&bsdf_pdf)[kLanes], bool camera, Color (&out)[kLanes],
                 EscapeSink* sink) const noexcept;
    /// Whether specular lobes see surroundings of their own, and what they see of them along d.
    bool own_reflection() const noexcept { return own_reflection_ >= 0; }
    Color reflection(Vec3f d) const noexcept;
    /// One ray, unweighted, for the ray tree.
    Color background(Vec3f d, bool camera) const noexcept;

    /// Mean radiance of the surroundings: the ambient light of a ray tree.
    Color ambient() const noexcept { return ambient_; }

    std::size_t bytes() const noexcept;

private:
    float probability(int i) const noexcept { return sampled_ > 0 ? choice_.probability(i) : 0.0f; }

    std::vector<Light> lights_;
    std::vector<std::uint8_t> kinds_;  // indices of the variants
    std::vector<LightLabel> labels_;
    AliasTable choice_;
    int sampled_ = 0;  // lights of positive power
    bool hittable_ = false;
    int own_reflection_ = -1;  // the light that has them
    Color ambient_{0.0f};
    std::vector<int> infinite_;  // lights that an escaping ray may see
};

/// Estimate of the power that reaches a scene of the given radius.
double light_power(const Light& light, double scene_radius, double mesh_emission = 0);

}  // namespace tessera
