#pragma once
// A layer of fibres (velvet, dust, peach fuzz) as a linearly transformed cosine. Zeltner, Burley,
// Chiang, "Practical Multiple-Scattering Sheen Using Linearly Transformed Cosines", SIGGRAPH Talks
// 2022; albedo and matrix by the rational fits of MaterialX 1.39 to their table.

#include "materials/lobe.h"
#include "renderer/core/warp.h"

namespace tessera {

struct FuzzLobe {
    static constexpr bool kDelta = false;
    float a_inv = 1, b_inv = 0;  // the inverse matrix: (a 0 b; 0 a 0; 0 0 1)
    float reflectance = 0;       // directional albedo toward wo

    struct Lanes {
        float a_inv[kLanes], b_inv[kLanes], reflectance[kLanes];
        void set(int i, const FuzzLobe& l) {
            a_inv[i] = l.a_inv, b_inv[i] = l.b_inv, reflectance[i] = l.reflectance;
        }
        FuzzLobe get(int i) const { return {a_inv[i], b_inv[i], reflectance[i]}; }
    };

    /// Seen at the cosine x; roughness y in [0, 1].
    static FuzzLobe seen_at(float x, float y) {
        y = std::max(y, 0.01f);
        const float s = y * (0.0206607f + 1.58491f * y) / (0.0379424f + y * (1.32227f + y));
        const float m =
            y * (-0.193854f + y * (-1.14885f + y * (1.7932f - 0.95943f * y * y))) / (0.046391f + y);
        const float o = y * (0.000654023f + (-0.0207818f + 0.119681f * y) * y) /
                        (1.26264f + y * (-1.92021f + y));
        const float t = (x - m) / s;
        const float albedo = std::exp(-0.5f * t * t) / (s * std::sqrt(2.0f * kPi)) + o;
        const float a =
            (2.58126f * x + 0.813703f * y) * y / (1.0f + 0.310327f * x * x + 2.60994f * x * y);
        const float b = safe_sqrt(1.0f - x) * (y - 1.0f) * y * y * y /
                        (0.0000254053f + 1.71228f * x - 1.71506f * x * y + 1.34174f * y * y);
        return {a, b, clamp01(albedo)};
    }

    LobeEval eval(Vec3f wo, Vec3f wi) const {
        const Turn turn(wo);
        const Vec3f w = turn.to_plane(wi);
        const Vec3f c{a_inv * w.x + b_inv * w.z, a_inv * w.y, w.z};
        const float l2 = length2(c);
        // cosine / pi of the untransformed direction times the Jacobian a^2 / length^3
        const float p = c.z * a_inv * a_inv * kInvPi / (l2 * l2);
        const bool above = wi.z > 0.0f;
        return {pick(above, Color(p * reflectance), Color(0.0f)), pick(above, p, 0.0f)};
    }
    LobeDirection direction(Vec3f wo, Vec2f u, float) const {
        const Vec3f c = warp_cosine(u);
        const Vec3f w = normalize(Vec3f{c.x - c.z * b_inv, c.y, c.z * a_inv});
        return {Turn(wo).from_plane(w), 1.0f, LobeClass::glossy};
    }
    float spread() const { return 0.2f; }
    Color albedo(Vec3f) const { return Color(reflectance); }

private:
    // The frame whose x axis is wo's direction along the surface.
    struct Turn {
        float cos, sin;
        explicit Turn(Vec3f wo) {
            const float r = std::sqrt(wo.x * wo.x + wo.y * wo.y);
            const bool there = r > 1e-7f;
            cos = there ? wo.x / r : 1.0f, sin = there ? wo.y / r : 0.0f;
        }
        Vec3f to_plane(Vec3f w) const {
            return {cos * w.x + sin * w.y, cos * w.y - sin * w.x, w.z};
        }
        Vec3f from_plane(Vec3f w) const {
            return {cos * w.x - sin * w.y, sin * w.x + cos * w.y, w.z};
        }
    };
};

}  // namespace tessera
