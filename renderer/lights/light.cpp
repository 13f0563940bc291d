#include "renderer/lights/light.h"

#include <bit>
#include <cmath>

#include "renderer/core/robust.h"
#include "renderer/core/warp.h"
#include "renderer/lights/spherical_rectangle.h"

namespace tessera {
namespace {

float distance2_over_cos(Vec3f from, Vec3f to, Vec3f n, Vec3f wi) {
    return length2(to - from) / std::fabs(dot(n, wi));
}

bool rectangle_by_solid_angle(const QuadLight& l, Vec3f p) {
    if (!l.rectangle) return false;
    // A cheap bound first: seen from p the rectangle is at most area / d^2 large.
    const Vec3f middle = l.corner + (l.edge_u + l.edge_v) * 0.5f - p;
    const float d2 = length2(middle);
    return std::fabs(dot(middle, l.normal)) * l.area > 0.5f * kMinSolidAngle * d2 * std::sqrt(d2);
}

// Fills in the sample of a point on a surface that was chosen with `density` per area.
bool from_area(Vec3f ref, Vec3f p, Vec3f n, float density, LightSample& s) {
    const Vec3f d = p - ref;
    const float d2 = length2(d);
    if (!(d2 > 0.0f)) return false;
    s.wi = d / std::sqrt(d2);
    const float cos = std::fabs(dot(n, s.wi));
    if (!(cos > 1e-7f)) return false;
    s.pdf = density * d2 / cos;
    s.p = p;
    s.n = n;
    return std::isfinite(s.pdf);
}

bool sample(const PointLight& l, const LightReference& ref, Vec2f, LightSample& s) {
    const Vec3f d = l.position - ref.p;
    const float d2 = length2(d);
    if (!(d2 > 0.0f)) return false;
    s.wi = d / std::sqrt(d2);
    s.radiance = l.intensity / d2;
    s.pdf = 1;
    s.delta = true;
    s.p = l.position;
    return true;
}

bool sample(const SpotLight& l, const LightReference& ref, Vec2f u, LightSample& s) {
    if (!sample(PointLight{l.position, l.intensity}, ref, u, s)) return false;
    const float f = l.falloff(-dot(s.wi, l.direction));
    s.radiance *= f;
    return f > 0.0f;
}

bool sample(const DistantLight& l, const LightReference&, Vec2f u, LightSample& s) {
    s.infinite = true;
    s.delta = l.one_minus_cos == 0.0f;
    s.wi = s.delta ? l.to_light : l.frame.to_world(warp_cone(u, l.one_minus_cos));
    s.radiance = s.delta ? l.irradiance : l.radiance;
    s.pdf = s.delta ? 1.0f : 1.0f / (2.0f * kPi * l.one_minus_cos);
    return true;
}

bool sample(const QuadLight& l, const LightReference& ref, Vec2f u, LightSample& s) {
    s.p_error = abs(l.corner) * gamma_bound(7) + Vec3f((l.length_u + l.length_v) * gamma_bound(7));
    s.radiance = l.radiance;
    if (!l.two_sided && dot(ref.p - l.corner, l.normal) <= 0.0f) return false;
    if (rectangle_by_solid_angle(l, ref.p)) {
        const SphericalRectangle r(l.corner, l.axis_u, l.axis_v, l.normal, l.length_u, l.length_v,
                                   ref.p);
        if (r.solid_angle > kMinSolidAngle) {
            s.p = r.sample(u);
            s.n = l.normal;
            s.pdf = 1.0f / r.solid_angle;
            s.wi = normalize(s.p - ref.p);
            return true;
        }
    }
    return from_area(ref.p, l.corner + l.edge_u * u.x + l.edge_v * u.y, l.normal, 1.0f / l.area, s);
}

bool sample(const DiscLight& l, const LightReference& ref, Vec2f u, LightSample& s) {
    s.p_error = (abs(l.center) + Vec3f(l.radius)) * gamma_bound(8);
    s.radiance = l.radiance;
    s.material = l.material;
    if (!l.two_sided && dot(ref.p - l.center, l.normal) <= 0.0f) return false;
    const Vec2f d = warp_disc_concentric(u);
    const Vec3f p = l.center + Frame(l.normal).to_world({d.x * l.radius, d.y * l.radius, 0});
    return from_area(ref.p, p, l.normal, 1.0f / (kPi * l.radius * l.radius), s);
}

// 1 - cos of the cone under which a sphere is seen; 0 from inside.
float cone_of(const SphereLight& l, Vec3f p) {
    const float d2 = length2(l.center - p), sin2 = l.radius * l.radius / d2;
    if (!(sin2 < 0.9999f)) return 0.0f;
    return sin2 / (1.0f + std::sqrt(1.0f - sin2));
}

bool sample(const SphereLight& l, const LightReference& ref, Vec2f u, LightSample& s) {
    s.p_error = (abs(l.center) + Vec3f(l.radius)) * gamma_bound(16);
    s.radiance = l.radiance;
    s.material = l.material;
    const float one_minus_cos = cone_of(l, ref.p);
    if (one_minus_cos == 0.0f) {  // inside, or nearly touching: by area
        const Vec3f n = warp_sphere(u);
        return from_area(ref.p, l.center + n * l.radius, n,
                         1.0f / (4.0f * kPi * l.radius * l.radius), s);
    }
    const Vec3f axis = l.center - ref.p;
    const float d = length(axis);
    const Vec3f local = warp_cone(u, one_minus_cos);
    s.wi = Frame(axis / d).to_world(local);
    // Nearest of the two crossings; the middle of the chord is the point closest to the centre.
    const float half = safe_sqrt(l.radius * l.radius - d * d * (1.0f - local.z) * (1.0f + local.z));
    s.p = ref.p + s.wi * (d * local.z - half);
    s.n = normalize(s.p - l.center);
    s.p = l.center + s.n * l.radius;
    s.pdf = 1.0f / (2.0f * kPi * one_minus_cos);
    return true;
}

bool sample(const MeshLight& l, const LightReference& ref, Vec2f u, LightSample& s) {
    const AliasTable::Pick pick =
        l.faces->pick.sample(u.x, hash_u32(std::bit_cast<std::uint32_t>(u.y)));
    const EmissiveFaces::Triangle& t = l.faces->triangles[pick.index];
    const Vec2f b = warp_triangle({pick.remainder, u.y});
    s.material = t.material;
    s.placement = l.placement;
    s.uv = t.ta + t.tab * b.x + t.tac * b.y;
    Vec3f p = t.a + t.ab * b.x + t.ac * b.y, ab = t.ab, ac = t.ac;
    s.p_error = abs(t.a) * gamma_bound(9) + (abs(t.ab) + abs(t.ac)) * gamma_bound(9);
    if (l.placed) {
        s.p_error = error_in_place(l.to_world, l.condition, p, s.p_error);
        p = l.to_world.point(p);
        ab = l.to_world.vector(ab);
        ac = l.to_world.vector(ac);
    }
    const Vec3f n = cross(ab, ac);
    const float twice_area = length(n);
    if (!(twice_area > 0.0f)) return false;
    return from_area(ref.p, p, n / twice_area, 2.0f * pick.probability / twice_area, s);
}

bool sample(const EnvironmentLight& l, const LightReference&, Vec2f u, LightSample& s) {
    return l.sample(u, s);
}

}  // namespace

void LightSamples::set(int lane, const LightSample& s) {
    wi.set(lane, s.wi);
    p.set(lane, s.p);
    p_error.set(lane, s.p_error);
    n.set(lane, s.n);
    radiance.set(lane, s.radiance);
    pdf[lane] = s.pdf;
    delta[lane] = s.delta;
    infinite[lane] = s.infinite;
    surroundings[lane] = s.surroundings;
    material[lane] = s.material;
    placement[lane] = s.placement;
    uv[lane] = s.uv;
}

QuadLight make_quad_light(Vec3d corner, Vec3d edge_u, Vec3d edge_v, Color radiance,
                          bool two_sided) {
    QuadLight q;
    const Vec3d n = cross(edge_u, edge_v);
    const double area = length(n), lu = length(edge_u), lv = length(edge_v);
    q.corner = Vec3f(corner);
    q.edge_u = Vec3f(edge_u);
    q.edge_v = Vec3f(edge_v);
    q.area = static_cast<float>(area);
    q.radiance = radiance;
    q.two_sided = two_sided;
    if (!(area > 0)) return q;
    q.normal = Vec3f(n / area);
    q.axis_u = Vec3f(edge_u / lu);
    q.axis_v = Vec3f(edge_v / lv);
    q.length_u = static_cast<float>(lu);
    q.length_v = static_cast<float>(lv);
    q.rectangle = std::abs(dot(edge_u, edge_v)) < 1e-6 * lu * lv;
    return q;
}

float SpotLight::falloff(float cos) const {
    if (cos <= cos_outer) return 0.0f;
    if (cos >= cos_inner) return 1.0f;
    const float t = (cos - cos_outer) / (cos_inner - cos_outer);
    return t * t * (3.0f - 2.0f * t);
}

float MeshLight::density_of(std::int32_t material, Vec3f n) const {
    // The map stretches areas that face n in place by |det| / |M^T n|.
    const float scale = placed ? length(to_world.transposed(n)) / std::fabs(determinant) : 1.0f;
    for (const auto& [m, d] : faces->density) {
        if (m == material) return d * scale;
    }
    return 0.0f;
}

std::size_t EmissiveFaces::bytes() const {
    return triangles.capacity() * sizeof(Triangle) + pick.bytes();
}

LaneMask DistantLight::sample(LaneMask lanes, const SamplePairs& u, LightSamples& out) const {
    Vec3Lanes wi;
    for (int i = 0; i < kLanes; ++i) wi.set(i, frame.to_world(warp_cone(u.at(i), one_minus_cos)));
    LightSample all;
    tessera::sample(*this, {}, {}, all);
    for (LaneMask m = lanes; m != 0; m &= m - 1) {
        const int i = std::countr_zero(m);
        out.wi.set(i, all.delta ? to_light : wi[i]);
        out.pdf[i] = all.pdf;
        out.radiance.set(i, all.radiance);
        out.delta[i] = all.delta;
        out.infinite[i] = 1;
        out.surroundings[i] = 0;
        out.material[i] = -1;
    }
    return lanes;
}

bool sample_light(const Light& light, const LightReference& ref, Vec2f u,
                  LightSample& out) noexcept {
    return std::visit([&](const auto& l) { return sample(l, ref, u, out); }, light);
}

float light_pdf(const Light& light, const LightReference& ref, Vec3f wi, Vec3f p, Vec3f n,
                std::int32_t material) noexcept {
    if (const auto* l = std::get_if<QuadLight>(&light)) {
        if (rectangle_by_solid_angle(*l, ref.p)) {
            const SphericalRectangle r(l->corner, l->axis_u, l->axis_v, l->normal, l->length_u,
                                       l->length_v, ref.p);
            if (r.solid_angle > kMinSolidAngle) return 1.0f / r.solid_angle;
        }
        return distance2_over_cos(ref.p, p, n, wi) / l->area;
    }
    if (const auto* l = std::get_if<SphereLight>(&light)) {
        const float one_minus_cos = cone_of(*l, ref.p);
        if (one_minus_cos > 0.0f) return 1.0f / (2.0f * kPi * one_minus_cos);
        return distance2_over_cos(ref.p, p, n, wi) / (4.0f * kPi * l->radius * l->radius);
    }
    if (const auto* l = std::get_if<DiscLight>(&light)) {
        return distance2_over_cos(ref.p, p, n, wi) / (kPi * l->radius * l->radius);
    }
    if (const auto* l = std::get_if<MeshLight>(&light)) {
        return distance2_over_cos(ref.p, p, n, wi) * l->density_of(material, n);
    }
    return 0.0f;
}

Color light_radiance(const Light& light, Vec3f wi, Vec3f n) noexcept {
    const bool front = dot(wi, n) < 0.0f;
    if (const auto* l = std::get_if<QuadLight>(&light))
        return front || l->two_sided ? l->radiance : Color(0.0f);
    if (const auto* l = std::get_if<DiscLight>(&light))
        return front || l->two_sided ? l->radiance : Color(0.0f);
    if (const auto* l = std::get_if<SphereLight>(&light)) return l->radiance;
    return Color(0.0f);
}

}  // namespace tessera
