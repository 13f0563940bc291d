#pragma once
// The ray tree of 1980: at each hit light straight from every source with its shadow ray, ambient
// light, and one ray each for mirror and refraction; both children of a glass hit are traced. No
// diffuse interreflection. Whitted, "An Improved Illumination Model for Shaded Display", CACM
// 23(6), 1980; children too faint to see are cut as in Hall & Greenberg, "A Testbed for Realistic
// Image Synthesis", IEEE CG&A 3(8), 1983.

#include <algorithm>
#include <bit>

#include "renderer/core/robust.h"
#include "renderer/core/sampler.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/path_passes.h"
#include "renderer/integrator/ray_log.h"
#include "renderer/integrator/shading.h"

namespace tessera {

template <Features F>
class WhittedBlock {
public:
    WhittedBlock(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept
        : job_(job),
          scene_(*job.scene),
          out_(out),
          counters_(counters),
          max_depth_(std::min(scene_.settings().max_depth, kMaxDepth)) {}

    void trace() noexcept {
        start();
        for (std::uint32_t step = 0; pop(); ++step) {
            intersect(step);
            shade_ = 0;
            lobes_.clear();
            for (LaneMask m = alive_; m != 0; m &= m - 1) arrive(std::countr_zero(m), step);
            for (int l = 0; l < scene_.lights().size(); ++l) light(l, step);
            for (LaneMask m = shade_; m != 0; m &= m - 1) branch(std::countr_zero(m));
        }
        for (LaneMask m = job_.lanes; m != 0; m &= m - 1) finish(std::countr_zero(m));
    }

private:
    // A surface has up to four children and one node is taken for them: three more a level.
    static constexpr int kMaxDepth = 64;
    static constexpr int kStack = 3 * kMaxDepth + 2;
    static constexpr float kFaintest = 1e-4f;

    struct Node {
        Ray ray;
        Color weight{1.0f};
        float cone_width = 0, cone_spread = 0;
        int depth = 0;
    };
    // A surface that a lane stands on between the stages of a step.
    struct Vertex {
        SurfacePoint s;
        FacingFrame frame;
    };

    void start() noexcept {
        SamplePairs film, lens;
        film_points(job_, film);
        sample_pairs(job_.seeds, job_.index, dim::kLens, lens);
        const Camera& camera = scene_.camera();
        camera.rays(film, lens, job_.x, packet_.ray);
        if (job_.passes) job_.passes->start(job_.lanes);
        for (LaneMask m = job_.lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            out_[i] = PathSample{};
            size_[i] = 0;
            push(i, {packet_.ray.get(i), Color(1.0f), camera.cone_width(), camera.cone_spread(), 0},
                 InvalidCause::camera_ray);
        }
        counters_.samples += static_cast<std::uint64_t>(std::popcount(job_.lanes));
    }

    void push(int i, const Node& node, InvalidCause cause) noexcept {
        if (!traceable(node.ray.o, node.ray.d)) return invalid(cause, i);
        stack_[i][size_[i]++] = node;
    }

    // Takes the next node of every lane that has one.
    bool pop() noexcept {
        alive_ = 0;
        for (LaneMask m = job_.lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            if (size_[i] == 0) continue;
            node_[i] = stack_[i][--size_[i]];
            alive_ |= 1u << i;
        }
        return alive_ != 0;
    }

    void intersect(std::uint32_t step) noexcept {
        ray_seeds(job_, 2 * step, seeds_);
        for (LaneMask m = alive_; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            packet_.ray.set(i, node_[i].ray);
            ++(node_[i].depth == 0 ? counters_.rays.camera : counters_.rays.bounce);
        }
        if (job_.log) job_.log->packet(packet_.ray, alive_, seeds_, false);
        scene_.accel().intersect(packet_, alive_, seeds_);
    }

    // Emission, or the background; then the surface is made ready.
    void arrive(int i, std::uint32_t) noexcept {
        Node& node = node_[i];
        const Hit hit = packet_.hit(i);
        if (!hit.valid()) {
            out_[i].radiance +=
                node.weight * scene_.lights().background(node.ray.d, node.depth == 0);
            return;
        }
        Vertex& v = vertex_[i];
        v.s = surface_point(scene_.geometry(), scene_.accel().target(hit), hit, node.ray,
                            F.vertex_colors);
        if (!is_finite(v.s.p) || !is_finite(v.s.ng) || !is_finite(v.s.ns) ||
            !(length2(v.s.ng) > 0.5f))
            return invalid(InvalidCause::hit, i);
        node.cone_width += node.cone_spread * dot(v.s.p - node.ray.o, node.ray.d);
        if (node.depth == 0) note_first_hit(i, hit);
        const ShaderProgram* program = v.s.material >= 0 ? &scene_.program(v.s.material) : nullptr;
        ShadeInput in;
        make_shade_input<F>(scene_, program, hit, node.cone_width, node.ray.d, v.s, in);
        if constexpr (F.textures) in.seed = seeds_[i];
        if (!program) {
            out_[i].radiance +=
                node.weight * light_radiance(scene_.lights()[v.s.light], node.ray.d, v.s.ng);
            return;
        }
        if (program->facts().emissive)
            out_[i].radiance +=
                node.weight * program->emission(in, scene_.textures(), -dot(v.s.ng, node.ray.d));
        v.frame = facing_frame<F>(v.s, *program, in, scene_.textures(), -node.ray.d);
        lobes_.wo.set(i, v.frame.wo);
        lobes_.even.set(i, v.frame.shading.to_local(v.frame.even));
        View view;
        view.front = v.frame.front;
        view.walks = false;
        view.coat =
            coat_frame<F>(v.s, *program, in, scene_.textures(), v.frame.front, v.frame.shading,
                          v.frame.shading.to_local(v.frame.guard), v.frame.wo);
        push_lobes<F>(*program, in, scene_.textures(), view, i, lobes_);
        if (node.depth == 0 && job_.passes) job_.passes->first(i).albedo = lobes_.albedo(i);
        out_[i].radiance +=
            node.weight * lobes_.template weight<DiffuseLobe>(i) * scene_.lights().ambient();
        shade_ |= 1u << i;
    }

    // One light for all lanes: points on it, then the shadow rays.
    void light(int index, std::uint32_t step) noexcept {
        SamplePairs u;
        sample_pairs(
            job_.seeds, job_.index,
            dim::vertex(step, dim::kLight) + 0x10000u * static_cast<std::uint32_t>(index + 1), u);
        LaneMask waiting = 0;
        if (std::holds_alternative<EnvironmentLight>(scene_.lights()[index]))
            return;  // that is the ambient light
        LaneMask aimed = 0;
        for (LaneMask m = shade_ & lobes_.extended(); m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            if (aim(i, scene_.lights()[index], u.at(i))) aimed |= 1u << i;
        }
        if (aimed == 0) return;
        lobes_.eval(aimed, wi_);
        for (LaneMask m = aimed; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            pending_[i] *= lobes_.f(i);
            if (max_component(pending_[i]) > 0.0f) waiting |= 1u << i;
        }
        if (waiting == 0) return;
        counters_.rays.shadow += static_cast<std::uint64_t>(std::popcount(waiting));
        ray_seeds(job_, 2 * step + 1, seeds_);
        if (job_.log) job_.log->packet(shadow_, waiting, seeds_, true);
        const LaneMask blocked = scene_.accel().occluded(shadow_, waiting, seeds_);
        for (LaneMask m = waiting & ~blocked; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            out_[i].radiance += pending_[i];
        }
    }

    bool aim(int i, const Light& source, Vec2f u) noexcept {
        const Vertex& v = vertex_[i];
        LightSample light;
        if (!sample_light(source, {v.s.p}, u, light)) return false;
        const Vec3f wi = v.frame.shading.to_local(light.wi);
        if (!same_side(light.wi, wi, v.frame.guard)) return false;
        if (light.material >= 0)
            light.radiance = emitter_radiance(scene_, light.material, light.placement, light.uv,
                                              light.p, light.n, light.wi);
        wi_.set(i, wi);
        pending_[i] = node_[i].weight * light.radiance * (1.0f / light.pdf);
        const Vec3f o = ray_origin(v.s.p, v.s.p_error, v.s.ng, v.frame.lift, light.wi, wi);
        Ray ray{o, light.wi, kInfinity, kOtherRays};
        if (!light.infinite) {
            ray.d = offset_origin(light.p, light.p_error, light.n, -light.wi) - o;
            ray.t_max = 0x1.fffffcp-1f;
        }
        if (!traceable(ray.o, ray.d)) {
            invalid(InvalidCause::shadow_ray, i);
            return false;
        }
        shadow_.set(i, ray);
        return true;
    }

    // Mirror and refraction rays of the smooth lobes.
    void branch(int i) noexcept {
        if (node_[i].depth >= max_depth_) return;
        lobes_.branch(i, [&](const SmoothSample& s, Color share) { child(i, s, share); });
    }

    void child(int i, const SmoothSample& s, Color share) noexcept {
        const Vertex& v = vertex_[i];
        const Node& node = node_[i];
        Vec3f wi = v.frame.shading.to_world(s.to.wi);
        const Color weight = node.weight * s.weight * share;
        if (!(max_component(weight) > kFaintest)) return;
        if (!same_side(wi, s.to.wi, v.frame.guard)) wi = reflect_at(wi, v.frame.guard);
        const bool mirrors =
            s.to.wi.z > 0.0f && (v.frame.front || !scene_.program(v.s.material).facts().glass);
        if (const ReflectionMap* map = mirrors ? scene_.reflection_map(v.s.material) : nullptr) {
            out_[i].radiance += weight * map->seen(v.s.p, wi);
            return;
        }
        push(i,
             {{ray_origin(v.s.p, v.s.p_error, v.s.ng, v.frame.lift, wi, s.to.wi), wi, kInfinity,
               kOtherRays},
              weight,
              node.cone_width,
              node.cone_spread,
              node.depth + 1},
             InvalidCause::bounce_ray);
    }

    void note_first_hit(int i, const Hit& hit) noexcept {
        out_[i].alpha = 1.0f;
        if (PathPasses* const p = job_.passes)
            note_geometry(scene_, hit, node_[i].ray.d, p->wants_uv(), vertex_[i].s, p->first(i));
    }

    void finish(int i) noexcept {
        PathSample& o = out_[i];
        if (!is_finite(o.radiance) || min_component(o.radiance) < 0.0f) {
            invalid(InvalidCause::radiance, i);
            o.radiance = Color(0.0f);
        }
    }

    void invalid(InvalidCause cause, int i) noexcept {
        counters_.add_invalid(cause, job_.x[i], job_.y[i], job_.sample);
    }

    const BlockJob& job_;
    const Scene& scene_;
    BlockSamples& out_;
    Counters& counters_;
    int max_depth_;
    LaneMask alive_ = 0, shade_ = 0;
    HitPacket packet_;
    RayPacket shadow_;
    Node node_[kLanes];
    Vertex vertex_[kLanes];
    Lobes<F> lobes_;
    Vec3Lanes wi_;  // local, of the light
    Color pending_[kLanes];
    Node stack_[kLanes][kStack];
    int size_[kLanes]{};
    std::uint32_t seeds_[kLanes];
};

}  // namespace tessera
