#pragma once
// From a surface point to what light can do there: the facing frame and the lobes. Shared by the
// integrators.

#include <algorithm>
#include <cmath>
#include <new>
#include <type_traits>

#include "materials/surface/openpbr.h"
#include "renderer/core/robust.h"
#include "renderer/scene/point_input.h"

namespace tessera {

/// Whether paths can be inside of something.
template <Features F>
inline constexpr bool kMedia = F.transmission || F.layers;

template <Features F>
using Lobes = std::conditional_t<kMedia<F>, AllLobes,
                                 std::conditional_t<F.specular, OpaqueLobes, DiffuseLobes>>;

/// The frame that faces the viewer.
struct FacingFrame {
    Frame shading;
    Vec3f ng;  // geometric normal on wo's side
    Vec3f wo;  // local
    bool front = true;
    Vec3f even;   // the shading normal before bumps
    Vec3f guard;  // normal of the surface that light is tested against: ng, or even where lifted
    Vec3f lift;   // from the point to where reflected rays start
};

inline bool is_lifted(Vec3f lift) { return length2(lift) > 0.0f; }

/// A shading normal that wo cannot see is bent until it can, just; one in which the mirror image
/// would lie below the surface, until it lies above. Keller et al., "The Iray Light Transport
/// Simulation and Rendering System", 2017, section A.3. guard: of the surface.
inline Vec3f consistent_normal(Vec3f ns, Vec3f guard, Vec3f wo) {
    constexpr float kGrazing = 1e-3f;
    const float c = dot(ns, wo);
    const Vec3f n = pick(c >= kGrazing, ns, normalize(ns + wo * (kGrazing - c)));
    const Vec3f mirrored = n * (2.0f * dot(n, wo)) - wo;
    const float least = std::clamp(0.9f * dot(guard, wo), 1e-4f, 0.02f);
    const float lift = least - dot(mirrored, guard);
    return pick(lift > 0.0f, normalize(normalize(mirrored + guard * lift) + wo), n);
}

/// The same from within glass, where normals bent so would lead what is reflected along the surface
/// for good: one that will not do is replaced by the surface's own.
inline Vec3f consistent_normal_within(Vec3f ns, Vec3f guard, Vec3f wo) {
    constexpr float kGrazing = 1e-3f;
    const float c = dot(ns, wo), mirrored = 2.0f * c * dot(ns, guard) - dot(wo, guard);
    return pick((c >= kGrazing) & (mirrored > 0.0f), ns, guard);
}

/// Those of a block.
struct FacingFrames {
    Vec3Lanes s, t, n;  // the shading frames' axes
    Vec3Lanes ng, even, guard, lift;
    LaneFlags front;
    LaneFlags within;  // seen from within a body of glass

    Frame shading(int i) const { return {s[i], t[i], n[i]}; }
    Vec3f bent_normal(int i, Vec3f ns, Vec3f guarding, Vec3f wo) const {
        return pick(within.is[i] != 0, consistent_normal_within(ns, guarding, wo),
                    consistent_normal(ns, guarding, wo));
    }
    void set_shading(int i, const Frame& f) { s.set(i, f.s), t.set(i, f.t), n.set(i, f.n); }
};

/// The shading normal on the viewer's side, maps and bumps applied.
template <Features F>
Vec3f facing_normal(const SurfacePoint& s, const ShaderProgram& program, const ShadeInput& in,
                    const TextureStore* textures, bool front) {
    if constexpr (F.textures) {
        if (program.bends_normal()) {
            const Vec3f n = program.normal(in, textures);
            return in.front == front ? n : -n;
        }
    }
    return front ? s.ns : -s.ns;
}

/// The coat's frame within the shading frame: over a bumpy base the coat is even, or has a normal
/// map of its own.
template <Features F>
Frame coat_frame(const SurfacePoint& s, const ShaderProgram& program, const ShadeInput& in,
                 const TextureStore* textures, bool front, const Frame& shading, Vec3f guard,
                 Vec3f wo) {
    if (!program.facts().coat) return {};
    const bool bends = program.bends_coat_normal(), turns = program.turns_coat_tangent();
    if (!program.bends_normal() && !bends && !turns) return {};
    Vec3f n = front ? s.ns : -s.ns;
    if (bends) n = program.coat_normal(in, textures) * (in.front == front ? 1.0f : -1.0f);
    const Vec3f along =
        turns ? shading.to_local(program.coat_tangent(in, textures)) : Vec3f{1, 0, 0};
    return frame_along(consistent_normal(shading.to_local(n), guard, wo), along);
}

/// Whether the material's look turns with the texture's frame.
template <Features F>
bool frame_follows_texture(const ShaderProgram& program) {
    if constexpr (F.textures || F.specular) return program.facts().tangent;
    return false;
}

/// The frame with its first axis the way that highlights stretch.
template <Features F>
Frame frame_in_texture(Vec3f n, const SurfacePoint& s, const ShaderProgram& program,
                       const ShadeInput& in, const TextureStore* textures) {
    if constexpr (F.textures) {
        if (program.turns_tangent()) return frame_along(n, program.tangent(in, textures));
    }
    return frame_along(n, s.dpdu);
}

template <Features F>
FacingFrame facing_frame(const SurfacePoint& s, const ShaderProgram& program, const ShadeInput& in,
                         const TextureStore* textures, Vec3f wo) {
    FacingFrame f;
    f.front = dot(s.ng, wo) >= 0.0f;
    f.ng = f.front ? s.ng : -s.ng;
    f.even = f.front ? s.ns : -s.ns;
    f.lift = f.front ? s.lift : Vec3f{};
    f.guard = is_lifted(f.lift) ? f.even : f.ng;
    const Vec3f facing = facing_normal<F>(s, program, in, textures, f.front);
    const bool within = !f.front && program.facts().glass;
    const Vec3f n = within ? consistent_normal_within(facing, f.guard, wo)
                           : consistent_normal(facing, f.guard, wo);
    f.shading = frame_follows_texture<F>(program) ? frame_in_texture<F>(n, s, program, in, textures)
                                                  : Frame(n);
    f.wo = f.shading.to_local(wo);
    return f;
}

/// The lobes of a lane, seen from lobes.wo.
template <Features F>
void push_lobes(const ShaderProgram& program, const ShadeInput& in, const TextureStore* textures,
                const View& view, int lane, Lobes<F>& lobes) {
    if constexpr (F.specular || kMedia<F>) {
        if (program.facts().specular) {
            return program.with_surface(in, textures, [&](const Surface& surface) {
                openpbr_lobes(surface, view, lane, lobes);
            });
        }
    }
    lobes.push(lane, DiffuseLobe{}, program.base_color(in, textures));
}

/// What the program reads at s; fills in s's texture frame if it reads one. Made in place: a copy
/// would wait for its own parts.
template <Features F>
void make_shade_input(const Scene& scene, const ShaderProgram* program, const Hit& hit,
                      float cone_width, Vec3f d, SurfacePoint& s, ShadeInput& in) {
    new (&in) ShadeInput;
    if constexpr (F.textures || F.specular) {
        if (program && (program->facts().uv || program->facts().tangent)) {
            add_texture_frame(scene.geometry(), hit, s);
            in.uv = s.uv;
            // The cone's footprint, stretched along the surface where it meets it at an angle, but
            // not without end.
            in.uv_width =
                cone_width * s.uv_per_length / std::max(std::sqrt(std::fabs(dot(s.ng, d))), 0.2f);
        }
    }
    if constexpr (F.vertex_colors) in.vertex_color = s.vertex_color;
    if constexpr (F.textures) {
        const bool placed = program && program->facts().geometry;
        if (placed) place_input(scene, s, in);
        if (placed || (program && program->facts().tangent)) {
            if (!placed) orient_input(s, in);
            in.front = dot(s.ng, d) <= 0.0f;
            if (!in.front) in.n = -s.ns;
            in.view = d;
            in.facing = std::fabs(dot(s.ns, d));
            in.p_width = cone_width / std::max(std::sqrt(std::fabs(dot(s.ng, d))), 0.2f);
        }
    }
}

/// True if the shading frame and the surface agree on which side wi leaves.
inline bool same_side(Vec3f wi_world, Vec3f wi_local, Vec3f guard) {
    return (dot(wi_world, guard) > 0.0f) == (wi_local.z > 0.0f);
}

/// wi's mirror image on the surface's other side.
inline Vec3f reflect_at(Vec3f wi, Vec3f guard) { return wi - guard * (2.0f * dot(wi, guard)); }

/// A lobe's direction as it leaves the surface. What bumpy mirrors and boundaries, and all lobes
/// within glass, send to the wrong side is turned to the right one, so that it is not lost: as no
/// light sampling could have found it.
struct Leaving {
    Vec3Lanes wi;
    LaneFlags turned, left;  // left: on the side that was meant

    /// Which lanes' directions are to be turned; in loops that the compiler vectorises.
    [[gnu::flatten]] void find(const FacingFrames& frames, const LobeSamples& sent) {
        LaneFlags wrong;
        for (int i = 0; i < kLanes; ++i) {
            const Vec3f meant = frames.shading(i).to_world(sent.wi[i]);
            wi.set(i, meant);
            wrong.is[i] = !same_side(meant, sent.wi[i], frames.guard[i]);
        }
        constexpr auto kThrough = static_cast<std::uint32_t>(LobeClass::transmission);
        for (int i = 0; i < kLanes; ++i) {
            const std::uint32_t smooth = sent.pdf[i] == 0.0f, through = sent.cls[i] == kThrough;
            turned.is[i] = wrong.is[i] & (smooth | through | frames.within.is[i]);
            left.is[i] = turned.is[i] | (wrong.is[i] ^ 1u);
        }
        for (int i = 0; i < kLanes; ++i)
            wi.set(i, pick(turned.is[i] != 0, reflect_at(wi[i], frames.guard[i]), wi[i]));
    }
};

/// Where a ray along wi starts: reflected light at the surface that smooth normals pretend.
inline Vec3f ray_origin(Vec3f p, Vec3f p_error, Vec3f ng, Vec3f lift, Vec3f wi, Vec3f wi_local) {
    return offset_origin(p + pick(wi_local.z > 0.0f, lift, Vec3f{}), p_error, ng, wi);
}

}  // namespace tessera
