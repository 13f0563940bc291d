#pragma once
// Unidirectional path tracing over a block: next-event estimation, multiple importance sampling by
// the power heuristic, Russian roulette. Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach,
// "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9. Reads as one path
// moving forward; each stage handles all lanes.

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/core/robust.h"
#include "renderer/core/sampler.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/ray_log.h"
#include "renderer/integrator/shading.h"

namespace tessera {

template <Features F>
class PathBlock {
public:
    PathBlock(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept
        : job_(job),
          scene_(*job.scene),
          settings_(scene_.settings()),
          out_(out),
          counters_(counters) {}

    void trace() noexcept {
        start_paths();
        for (std::uint32_t depth = 0; alive_ != 0; ++depth) {
            intersect(depth);
            draw_samples(depth);
            LaneMask next = 0;
            shadow_lanes_ = 0;
            for (LaneMask m = alive_; m != 0; m &= m - 1) {
                const int lane = std::countr_zero(m);
                if (shade(lane, depth)) next |= 1u << lane;
            }
            occlude(depth);
            alive_ = next;
        }
        finish();
    }

private:
    struct Lane {
        Ray ray;
        Color throughput{1.0f};
        Vec3f from;          // vertex that sent the ray: where its pdf was taken
        float bsdf_pdf = 0;  // of the ray's direction; 0: light sampling could not have made it
        float cone_width = 0, cone_spread = 0;
        float eta_scale = 1;  // undoes radiance scaling for the roulette
        std::uint16_t diffuse = 0, glossy = 0, transmission = 0;
        bool last = false;  // the ray may still find light, nothing more
        bool layers_done = false;
        // Light found at this vertex, waiting for its shadow ray.
        Color pending{0.0f};
    };

    // ---- camera
    // -------------------------------------------------------------------------------------
    void start_paths() noexcept {
        SamplePairs film, lens;
        sample_pairs(job_.seeds, job_.index, dim::kFilter, film);
        if constexpr (F.lens) sample_pairs(job_.seeds, job_.index, dim::kLens, lens);
        for (LaneMask m = job_.lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            out_[i] = PathSample{};
            Lane& lane = lanes_[i];
            const Vec2f offset = job_.filter->offset(film.at(i));
            const Vec2f at{static_cast<float>(lane_x(job_, i)) + 0.5f + offset.x,
                           static_cast<float>(lane_y(job_, i)) + 0.5f + offset.y};
            const CameraRay ray = scene_.camera().ray(at, F.lens ? lens.at(i) : Vec2f{0.5f, 0.5f});
            lane.ray = ray.ray;
            lane.cone_width = ray.cone_width;
            lane.cone_spread = ray.cone_spread;
            lane.layers_done = !job_.layers;
            if (traceable(lane.ray.o, lane.ray.d)) {
                alive_ |= 1u << i;
            } else {
                invalid(InvalidCause::camera_ray, i);
            }
        }
        counters_.samples += static_cast<std::uint64_t>(std::popcount(job_.lanes));
    }

    // ---- intersect
    // ---------------------------------------------------------------------------------- Packets
    // where lanes run together (the camera's rays), single rays after that: by depth, never by how
    // many lanes live, so that a lane's bits do not depend on its neighbours.
    void intersect(std::uint32_t depth) noexcept {
        const auto count = static_cast<std::uint64_t>(std::popcount(alive_));
        (depth == 0 ? counters_.rays.camera : counters_.rays.bounce) += count;
        ray_seeds(2 * depth, seeds_);
        if (depth == 0) {
            for (LaneMask m = alive_; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                packet_.ray.set(i, lanes_[i].ray);
            }
            if (job_.log) job_.log->packet(packet_.ray, alive_, seeds_, false);
            scene_.accel().intersect(packet_, alive_, seeds_);
            for (LaneMask m = alive_; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                hits_[i] = packet_.hit(i);
                arrive(i);
            }
        } else {
            for (LaneMask m = alive_; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                if (job_.log) job_.log->single(lanes_[i].ray, seeds_[i], false);
                scene_.accel().intersect(lanes_[i].ray, seeds_[i], hits_[i]);
                arrive(i);
            }
        }
        for (LaneMask m = alive_; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            if (hits_[i].valid()) prefetch_vertices(scene_.geometry(), targets_[i], hits_[i]);
        }
    }

    void arrive(int i) noexcept {
        const Hit& hit = hits_[i];
        if (!hit.valid()) return;
        targets_[i] = scene_.accel().target(hit);
        prefetch_indices(scene_.geometry(), targets_[i], hit);
    }

    void draw_samples(std::uint32_t depth) noexcept {
        if (scene_.lights().sampled()) draw(dim::vertex(depth, dim::kLight), light_u_);
        draw(dim::vertex(depth, dim::kChoice), choice_u_);
        draw(dim::vertex(depth, dim::kBsdf), bsdf_u_);
        if (depth >= static_cast<std::uint32_t>(settings_.min_depth)) {
            draw(dim::vertex(depth, dim::kRoulette), roulette_u_);
        }
    }

    // All lanes at once are vectorised; a few alone are cheaper one by one. The points are the
    // same.
    void draw(std::uint32_t pair, SamplePairs& out) noexcept {
        constexpr int kFew = 3;
        if (std::popcount(alive_) > kFew) return sample_pairs(job_.seeds, job_.index, pair, out);
        for (LaneMask m = alive_; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            const Vec2f p = sample_pair(job_.seeds[i], job_.index, pair);
            out.x[i] = p.x;
            out.y[i] = p.y;
        }
    }

    // ---- shade: returns whether the path goes on
    // ----------------------------------------------------
    bool shade(int i, std::uint32_t depth) noexcept {
        Lane& lane = lanes_[i];
        const Vec3f d = lane.ray.d;
        if (!hits_[i].valid()) {
            out_[i].radiance +=
                lane.throughput * scene_.lights().escaped(d, lane.bsdf_pdf, depth == 0);
            // What a mirror shows of the surroundings counts as white.
            if (!lane.layers_done && depth > 0) out_[i].albedo = lane.throughput;
            return false;
        }
        SurfacePoint s =
            surface_point(scene_.geometry(), targets_[i], hits_[i], lane.ray, F.vertex_colors);
        if (!is_finite(s.p) || !is_finite(s.ng) || !is_finite(s.ns) || !(length2(s.ng) > 0.5f)) {
            invalid(InvalidCause::hit, i);
            return false;
        }
        lane.cone_width += lane.cone_spread * dot(s.p - lane.ray.o, d);
        const ShaderProgram* program = s.material >= 0 ? &scene_.program(s.material) : nullptr;
        const ShadeInput in = shade_input<F>(scene_, program, hits_[i], lane.cone_width, d, s);
        if (depth == 0) note_first_hit(i, s);

        // Emission, weighed against light sampling having found it.
        if (!program || program->facts().emissive) {
            const Color e = program ? program->emission(in, scene_.textures())
                                    : light_radiance(scene_.lights()[s.light], d, s.ng);
            float weight = 1.0f;
            if (lane.bsdf_pdf > 0.0f && s.light >= 0) {
                weight = mis_power(lane.bsdf_pdf, scene_.lights().pdf(s.light, {lane.from}, d, s.p,
                                                                      s.ng, s.material));
            }
            out_[i].radiance += lane.throughput * e * weight;
        }
        if (!program || lane.last) return false;

        const FacingFrame frame = facing_frame<F>(s, *program, in, scene_.textures(), -d);
        const Lobes<F> lobes = make_lobes<F>(*program, in, scene_.textures(), frame);
        if (!lane.layers_done) note_layers(i, lobes, frame);
        if (lobes.has_extended_part() && scene_.lights().sampled())
            sample_lights(i, s, frame, lobes);
        return bounce(i, depth, s, frame, lobes);
    }

    // ---- next-event estimation
    // ----------------------------------------------------------------------
    void sample_lights(int i, const SurfacePoint& s, const FacingFrame& frame,
                       const Lobes<F>& lobes) noexcept {
        Lane& lane = lanes_[i];
        LightSample light;
        if (!scene_.lights().sample({s.p}, choice_u_.x[i], light_u_.at(i), light)) return;
        const Vec3f wi = frame.shading.to_local(light.wi);
        if (!same_side(light.wi, wi, frame.ng)) return;
        if (!F.transmission && wi.z <= 0.0f) return;
        const LobeEval e = lobes.eval(frame.wo, wi);
        if (!(max_component(e.f) > 0.0f)) return;
        if (light.material >= 0) {
            ShadeInput in;
            in.uv = light.uv;
            light.radiance = scene_.program(light.material).visible_emission(in, scene_.textures());
        }
        const float weight = light.delta ? 1.0f : mis_power(light.pdf, e.pdf);
        const Color c = lane.throughput * e.f * light.radiance * (weight / light.pdf);
        if (!(max_component(c) > 0.0f)) return;
        Ray& ray = shadow_[i];
        ray.o = offset_origin(s.p, s.p_error, s.ng, light.wi);
        if (light.infinite) {
            ray.d = light.wi;
            ray.t_max = kInfinity;
        } else {
            ray.d = offset_origin(light.p, light.p_error, light.n, -light.wi) - ray.o;
            ray.t_max = 0x1.fffffcp-1f;  // the end itself is not in the way
        }
        if (!traceable(ray.o, ray.d)) return invalid(InvalidCause::shadow_ray, i);
        lane.pending = c;
        shadow_lanes_ |= 1u << i;
    }

    // ---- occlude: the blocked contributions are dropped, the others added
    // -----------------------------
    void occlude(std::uint32_t depth) noexcept {
        if (shadow_lanes_ == 0) return;
        counters_.rays.shadow += static_cast<std::uint64_t>(std::popcount(shadow_lanes_));
        ray_seeds(2 * depth + 1, seeds_);
        LaneMask blocked = 0;
        if (depth == 0) {
            RayPacket& rays = packet_.ray;
            for (LaneMask m = shadow_lanes_; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                rays.set(i, shadow_[i]);
            }
            if (job_.log) job_.log->packet(rays, shadow_lanes_, seeds_, true);
            blocked = scene_.accel().occluded(rays, shadow_lanes_, seeds_);
        } else {
            for (LaneMask m = shadow_lanes_; m != 0; m &= m - 1) {
                const int i = std::countr_zero(m);
                if (job_.log) job_.log->single(shadow_[i], seeds_[i], true);
                blocked |= static_cast<LaneMask>(scene_.accel().occluded(shadow_[i], seeds_[i]))
                           << i;
            }
        }
        for (LaneMask m = shadow_lanes_ & ~blocked; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            out_[i].radiance += lanes_[i].pending;
        }
    }

    // ---- bounce
    // -------------------------------------------------------------------------------------
    bool bounce(int i, std::uint32_t depth, const SurfacePoint& s, const FacingFrame& frame,
                const Lobes<F>& lobes) noexcept {
        Lane& lane = lanes_[i];
        const auto b = lobes.sample(frame.wo, bsdf_u_.at(i), choice_u_.y[i]);
        if (!b) return false;
        const Vec3f wi = frame.shading.to_world(b->wi);
        if (!same_side(wi, b->wi, frame.ng)) return false;
        // The throughput is kept for the shadow ray's sake in `pending`; from here on it is the
        // next ray's.
        lane.throughput *= b->weight;
        // Behind a mirror or clear glass the albedo is that of what is seen there.
        if (!b->delta) lane.layers_done = true;
        if (!lane.layers_done) out_[i].albedo = Color(0.0f);
        lane.bsdf_pdf = b->pdf;
        lane.eta_scale *= b->eta * b->eta;
        if (!(max_component(lane.throughput) > 0.0f)) return false;

        lane.last = depth + 1 > static_cast<std::uint32_t>(settings_.max_depth);
        switch (b->cls) {
            case LobeClass::diffuse:
                lane.last |= ++lane.diffuse > settings_.max_diffuse_depth;
                break;
            case LobeClass::glossy:
                lane.last |= ++lane.glossy > settings_.max_glossy_depth;
                break;
            case LobeClass::transmission:
                lane.last |= ++lane.transmission > settings_.max_transmission_depth;
                break;
        }
        if (lane.last && !scene_.emission_can_be_hit()) return false;
        if (depth >= static_cast<std::uint32_t>(settings_.min_depth)) {
            const float survive = std::min(max_component(lane.throughput) * lane.eta_scale, 1.0f);
            if (survive < 1.0f) {
                if (roulette_u_.x[i] >= survive) return false;
                lane.throughput *= 1.0f / survive;
            }
        }
        lane.from = s.p;
        lane.ray.o = offset_origin(s.p, s.p_error, s.ng, wi);
        lane.ray.d = wi;
        lane.ray.t_max = kInfinity;
        lane.ray.mask = kOtherRays;
        lane.cone_spread = std::max(lane.cone_spread, b->spread);
        if (!traceable(lane.ray.o, lane.ray.d)) {
            invalid(InvalidCause::bounce_ray, i);
            return false;
        }
        return true;
    }

    // ---- passes
    // -------------------------------------------------------------------------------------
    void note_first_hit(int i, const SurfacePoint& s) noexcept {
        out_[i].alpha = 1.0f;
        if (!job_.layers) return;
        PathSample& o = out_[i];
        o.hit = true;
        o.z = dot(s.p - scene_.camera().position(), scene_.camera().forward());
        o.p = Vec3f(Vec3d(s.p) + scene_.origin());
        o.n = dot(s.ns, lanes_[i].ray.d) <= 0.0f ? s.ns : -s.ns;
    }

    // Albedo of the first surface that is not a mirror or clear glass, as denoisers want it.
    void note_layers(int i, const Lobes<F>& lobes, const FacingFrame& frame) noexcept {
        Lane& lane = lanes_[i];
        out_[i].albedo = lane.throughput * lobes.albedo(frame.wo);
    }

    void invalid(InvalidCause cause, int i) noexcept {
        counters_.add_invalid(cause, lane_x(job_, i), lane_y(job_, i), job_.index);
    }

    // Numbers that decide partial opacity for the rays of one step.
    void ray_seeds(std::uint32_t step, std::uint32_t (&seeds)[kLanes]) const noexcept {
        const std::uint32_t salt = hash_combine(job_.index, step);
        for (int i = 0; i < kLanes; ++i) seeds[i] = hash_combine(job_.seeds[i], salt);
    }

    void finish() noexcept {
        for (LaneMask m = job_.lanes; m != 0; m &= m - 1) {
            const int i = std::countr_zero(m);
            PathSample& o = out_[i];
            if (!is_finite(o.radiance) || min_component(o.radiance) < 0.0f) {
                invalid(InvalidCause::radiance, i);
                o.radiance = Color(0.0f);
            }
        }
    }

    const BlockJob& job_;
    const Scene& scene_;
    const RenderDesc& settings_;
    BlockSamples& out_;
    Counters& counters_;
    LaneMask alive_ = 0, shadow_lanes_ = 0;
    HitPacket packet_;
    Lane lanes_[kLanes];
    Ray shadow_[kLanes];
    Hit hits_[kLanes];
    HitTarget targets_[kLanes];
    SamplePairs light_u_, choice_u_, bsdf_u_, roulette_u_;
    std::uint32_t seeds_[kLanes];
};

template <Features F>
void trace_path(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    PathBlock<F>(job, out, counters).trace();
}

}  // namespace tessera
