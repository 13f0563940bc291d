#pragma once
// Emitters as values. Positions are in the scene's own space, radiance in W/m^2/sr in the working
// space.

#include <cstdint>
#include <memory>
#include <span>
#include <variant>
#include <vector>

#include "renderer/core/affine.h"
#include "renderer/core/distribution.h"
#include "renderer/core/frame.h"
#include "renderer/core/ray.h"
#include "renderer/core/sampler.h"
#include "renderer/core/vec.h"
#include "renderer/lights/latlong_map.h"

namespace tessera {

/// A direction toward a light from some point, with what is needed to test that nothing is between.
struct LightSample {
    Vec3f wi;        // unit
    Color radiance;  // arriving along wi if nothing is between; for delta lights the irradiance a
                     // surface facing wi would get
    float pdf =
        0;  // per solid angle, the choice of the light included; for delta lights that choice alone
    bool delta = false;
    bool infinite = false;      // no point: the light is at infinity
    bool surroundings = false;  // of an environment: specular lobes may see another one
    Vec3f p, p_error, n;        // point on the light, its error bound, its normal (zero for points)
    std::int32_t material = -1;   // >= 0: radiance comes from this material's emission at uv
    std::uint32_t placement = 0;  // of that mesh
    Vec2f uv;
};

/// Those of a block.
struct LightSamples {
    Vec3Lanes wi, p, p_error, n;
    Vec3Lanes radiance;
    float pdf[kLanes];
    std::uint32_t delta[kLanes], infinite[kLanes], surroundings[kLanes];
    std::int32_t material[kLanes];
    std::uint32_t placement[kLanes];
    Lanes<Vec2f> uv;
    std::int32_t light[kLanes];  // which one; set by LightSet

    void set(int lane, const LightSample& s);
};

/// Where light is wanted: reduced to what a light may depend on.
struct LightReference {
    Vec3f p;
};

struct PointLight {
    Vec3f position;
    Color intensity;
};

struct SpotLight {
    Vec3f position, direction;
    Color intensity;
    float cos_outer = 0, cos_inner = 0;
    float falloff(float cos) const;
};

struct DistantLight {
    Vec3f to_light;  // unit
    Color irradiance;
    float one_minus_cos = 0;  // of the half angle; 0: a delta light
    Color radiance{0.0f};
    bool camera_visible = true;
    Frame frame{to_light};
    /// As sample_light, for the lanes of a block.
    LaneMask sample(LaneMask lanes, const SamplePairs& u, LightSamples& out) const;
};

struct QuadLight {
    Vec3f corner, edge_u, edge_v, normal;
    Vec3f axis_u, axis_v;  // unit
    float length_u = 0, length_v = 0;
    Color radiance;
    float area = 0;
    bool rectangle = false;  // right angles: sampled by solid angle
    bool two_sided = false;
};

struct DiscLight {
    Vec3f center, normal;
    float radius = 1;
    Color radiance;
    bool two_sided = false;
    std::int32_t material = -1;  // as in LightSample
};

struct SphereLight {
    Vec3f center;
    float radius = 1;
    Color radiance;
    std::int32_t material = -1;
};

/// The emissive faces of a mesh in its own space; its instances share them.
struct EmissiveFaces {
    struct Triangle {
        Vec3f a, ab, ac;
        Vec2f ta, tab, tac;
        std::int32_t material;
    };
    std::vector<Triangle> triangles;
    AliasTable pick;
    std::vector<std::pair<std::int32_t, float>> density;  // material -> pdf per area
    std::size_t bytes() const;
};

/// The emissive faces of one placed mesh; emits from both sides.
struct MeshLight {
    std::shared_ptr<const EmissiveFaces> faces;
    bool placed = false;  // by to_world, which can be inverted; else the faces are in place
    Affinef to_world;
    float determinant = 1, condition = 1;  // of to_world
    std::uint32_t placement = 0;
    /// pdf per area in place of a point with normal n on a face of the material.
    float density_of(std::int32_t material, Vec3f n) const;
};

/// A lat-long map or a constant all around, which is what surfaces are lit by. Where `camera` or
/// `reflection` is set, camera rays or the rays of specular lobes see that one in its place.
struct EnvironmentLight {
    LatLongMap map;
    Distribution2D table;  // of the light above its mean, see make_environment
    double mean = 0;       // luminance per texel times its sine, before scale
    bool camera_visible = true;
    std::shared_ptr<const LatLongMap> camera, reflection;

    struct Look {
        Color radiance{0.0f};
        float pdf = 0;  // per solid angle, of sampling the table
    };
    Look look(Vec3f d) const;
    bool sample(Vec2f u, LightSample& out) const;
    /// Both ways for sixteen lanes at once, with sample_light's and look's bits. sample returns the
    /// lanes that got a sample.
    LaneMask sample(LaneMask lanes, const SamplePairs& u, LightSamples& out) const;
    void look(LaneMask lanes, const Vec3Lanes& d, Look (&out)[kLanes]) const;
    float density(Vec2f uv, float sin_theta) const;
    std::size_t bytes() const;
};

using Light = std::variant<PointLight, SpotLight, DistantLight, QuadLight, DiscLight, SphereLight,
                           MeshLight, EnvironmentLight>;

/// pdf without the choice of the light; nothing when the light cannot be seen from there.
bool sample_light(const Light& light, const LightReference& ref, Vec2f u,
                  LightSample& out) noexcept;

/// pdf per solid angle with which sample_light makes the direction wi from ref to the point p with
/// normal n on a light that a ray has hit (area lights). material: of the face, for mesh lights.
float light_pdf(const Light& light, const LightReference& ref, Vec3f wi, Vec3f p, Vec3f n,
                std::int32_t material) noexcept;

/// Radiance leaving an area light's body toward -wi from a point with normal n.
Color light_radiance(const Light& light, Vec3f wi, Vec3f n) noexcept;

/// Solid angle of a rectangle, precise for > kMinSolidAngle; below that the caller samples by area.
inline constexpr float kMinSolidAngle = 0.05f;

/// edge_u and edge_v span the quad; it emits along edge_u x edge_v. Area 0: the quad is degenerate.
QuadLight make_quad_light(Vec3d corner, Vec3d edge_u, Vec3d edge_v, Color radiance, bool two_sided);

/// A sun: to_light is a unit vector, irradiance that of a surface facing it, angle_deg its breadth.
DistantLight make_distant_light(Vec3f to_light, Color irradiance, double angle_deg,
                                bool camera_visible);
enum class EnvironmentTable : std::uint8_t { compensated, plain };
EnvironmentLight make_constant_environment(Color radiance, bool camera_visible);
/// A compensated table leaves out what lies below the mean: those directions are for whoever asks
/// to find by the surface's own sampling, weighed with the table's by multiple importance sampling.
EnvironmentLight make_environment(LatLongMap map, bool camera_visible,
                                  EnvironmentTable table = EnvironmentTable::compensated);
/// texels: width x height RGB from the top. Sanitised by the caller.
EnvironmentLight make_environment(int width, int height, std::vector<Color> texels, Color scale,
                                  double rotate_deg, bool camera_visible);

}  // namespace tessera
