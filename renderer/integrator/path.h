#pragma once
// Unidirectional path tracing over a block: next-event estimation, multiple importance sampling by
// the power heuristic, Russian roulette. Kajiya, "The Rendering Equation", SIGGRAPH 1986; Veach,
// "Robust Monte Carlo Methods for Light Transport Simulation", 1997, chapter 9. Reads as one path
// moving forward; each stage handles all lanes.

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "renderer/core/robust.h"
#include "renderer/core/sampler.h"
#include "renderer/integrator/apart.h"
#include "renderer/integrator/block.h"
#include "renderer/integrator/inside.h"
#include "renderer/integrator/pass_shares.h"
#include "renderer/integrator/path_depth.h"
#include "renderer/integrator/ray_log.h"
#include "renderer/integrator/shading.h"
#include "renderer/integrator/walk.h"

namespace tessera {

template <Features F>
class PathBlock {
public:
    PathBlock(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept
        : job_(job),
          scene_(*job.scene),
          settings_(scene_.settings()),
          out_(out),
          counters_(counters),
          passes_(job.passes) {}

    void trace() noexcept {
        start_paths();
        for (std::uint32_t depth = 0; alive_ != 0; ++depth) {
            intersect(depth);
            escape(depth);
            draw_samples(depth);
            surface_points(scene_.geometry(), alive_, target_.array(), hit_.array(), ray_.array(),
                           F.vertex_colors, surface_.array());
            each(alive_, [&](int i) { arrive(i, depth); });
            face_viewer();
            find_lobes(depth);
            sample_lights(depth);
            scatter(depth);
            occlude(depth);
            alive_ |= passing_;
        }
        finish();
    }

private:
    // Calls f(lane) for every lane of the mask as it is now; f may take lanes out of `alive_`.
    template <class Function>
    static void each(LaneMask lanes, Function f) {
        for (; lanes != 0; lanes &= lanes - 1) f(std::countr_zero(lanes));
    }
    void stop(int i) noexcept { alive_ &= ~(1u << i); }

    // ---- camera
    void start_paths() noexcept {
        SamplePairs film, lens;
        film_points(job_, film);
        if constexpr (F.lens) sample_pairs(job_.seeds, job_.index, dim::kLens, lens);
        const Camera& camera = scene_.camera();
        camera.rays(film, lens, job_.x, packet_.ray);
        if (passes_) passes_->start(job_.lanes);
        each(job_.lanes, [&](int i) {
            out_[i] = PathSample{};
            ray_[i] = packet_.ray.get(i);
            throughput_.set(i, Color(1.0f));
            bsdf_pdf_[i] = 0.0f;
            eta_scale_[i] = 1.0f;
            cone_width_[i] = camera.cone_width();
            cone_spread_[i] = camera.cone_spread();
            depth_[i] = {};
            depth_[i].layers_done = !passes_;
            if constexpr (kMedia<F>) inside_[i].reset();
            if (!traceable(ray_[i].o, ray_[i].d)) return invalid(InvalidCause::camera_ray, i);
            alive_ |= 1u << i;
        });
        counters_.samples += static_cast<std::uint64_t>(std::popcount(job_.lanes));
    }

    // ---- intersect
    // Packets where lanes run together (the camera's rays), single rays after that: by depth, never
    // by how many lanes live, so that a lane's bits do not depend on its neighbours.
    void intersect(std::uint32_t depth) noexcept {
        const auto count = static_cast<std::uint64_t>(std::popcount(alive_));
        (depth == 0 ? counters_.rays.camera : counters_.rays.bounce) += count;
        ray_seeds(job_, 2 * depth, seeds_);
        if (depth == 0) {
            if (job_.log) job_.log->packet(packet_.ray, alive_, seeds_, false);
            scene_.accel().intersect(packet_, alive_, seeds_);
            each(alive_, [&](int i) {
                hit_[i] = packet_.hit(i);
                ask_for_index(i);
            });
        } else {
            each(alive_, [&](int i) {
                if constexpr (kMedia<F>) {
                    if (const Medium* medium = inside_[i].to_walk()) return walk_inside(i, *medium);
                }
                trace_single(ray_[i], seeds_[i], hit_[i]);
                ask_for_index(i);
            });
        }
        escaped_ = passing_ = 0;
        each(alive_, [&](int i) {
            if (hit_[i].valid()) {
                prefetch_vertices(scene_.geometry(), target_[i], hit_[i]);
            } else {
                escaped_ |= 1u << i;
            }
        });
        alive_ &= ~escaped_;
    }

    void trace_single(const Ray& ray, std::uint32_t seed, Hit& hit) const noexcept {
        if (job_.log) job_.log->single(ray, seed, false);
        scene_.accel().intersect(ray, seed, hit);
    }

    // Where the way leads through what scatters, the walk takes the place of the ray.
    void walk_inside(int i, const Medium& medium) noexcept {
        Color throughput = throughput_[i];
        const WalkEnd end = walk(
            medium, seeds_[i], ray_[i], throughput,
            [&](const Ray& ray, std::uint32_t seed, Hit& hit) { trace_single(ray, seed, hit); });
        counters_.rays.bounce += static_cast<std::uint64_t>(end.rays - 1);
        throughput_.set(i, throughput);
        // Light sampling could not have made a way that was scattered.
        if (end.scattered) bsdf_pdf_[i] = 0.0f;
        if (passes_ && end.scattered && !inside_[i].in_body())
            passes_->scatter(i, LobeEvent::volume);
        if (!end.arrived) return stop(i);
        hit_[i] = end.hit;
        ask_for_index(i);
    }

    void ask_for_index(int i) noexcept {
        if (!hit_[i].valid()) return;
        target_[i] = scene_.accel().target(hit_[i]);
        prefetch_index(scene_.geometry(), target_[i], hit_[i]);
    }

    // ---- escape: what the rays that hit nothing see
    void escape(std::uint32_t depth) noexcept {
        if (escaped_ == 0) return;
        Vec3Lanes d;
        Color seen[kLanes];
        each(escaped_, [&](int i) { d.set(i, ray_[i].d); });
        scene_.lights().escaped(escaped_, apart_.sent(), d, bsdf_pdf_, depth == 0, seen, passes_);
        if (passes_) passes_->escaped(throughput_);
        each(escaped_, [&](int i) {
            out_[i].radiance += throughput_[i] * seen[i];
            // What a mirror shows of the surroundings counts as white.
            if (!depth_[i].layers_done && depth > 0) passes_->first(i).albedo = throughput_[i];
        });
    }

    void draw_samples(std::uint32_t depth) noexcept {
        const auto draw = [&](std::uint32_t use, auto& out) {
            draw_lanes(alive_, job_.seeds, job_.index, dim::vertex(depth, use), out);
        };
        if (scene_.lights().sampled()) draw(dim::kLight, light_u_);
        draw(dim::kChoice, choice_u_);
        draw(dim::kBsdf, bsdf_u_);
        if (depth >= static_cast<std::uint32_t>(settings_.min_depth)) {
            draw(dim::kRoulette, roulette_u_);
        }
    }

    // ---- arrive: the surface, and the light it sends of itself
    void arrive(int i, std::uint32_t depth) noexcept {
        const Vec3f d = ray_[i].d;
        SurfacePoint& s = surface_[i];
        if (passes_) passes_->meet(i, s.material);
        if (!is_finite(s.p) || !is_finite(s.ng) || !is_finite(s.ns) || !(length2(s.ng) > 0.5f)) {
            invalid(InvalidCause::hit, i);
            return stop(i);
        }
        cone_width_[i] += cone_spread_[i] * dot(s.p - ray_[i].o, d);
        const ShaderProgram* program = s.material >= 0 ? &scene_.program(s.material) : nullptr;
        if constexpr (kMedia<F>) {
            Inside& in = inside_[i];
            const Color passed = in.arrive(s, d, length(s.p - ray_[i].o));
            throughput_.set(i, throughput_[i] * passed);
            if (in.leaves_body()) return depth_[i].last ? stop(i) : void();
        }
        make_shade_input<F>(scene_, program, hit_[i], cone_width_[i], d, s, shade_in_[i]);
        if constexpr (F.textures) shade_in_[i].seed = seeds_[i];
        if (depth == 0) note_first_hit(i, s);
        if constexpr (kMedia<F>) {
            if (program && program->facts().glass && meet_glass(i, *program)) return;
        }

        // Emission, weighed against light sampling having found it.
        if (!program || program->facts().emissive) {
            const Color e = program
                                ? program->emission(shade_in_[i], scene_.textures(), -dot(s.ng, d))
                                : light_radiance(scene_.lights()[s.light], d, s.ng);
            float weight = 1.0f;
            if (bsdf_pdf_[i] > 0.0f && s.light >= 0) {
                weight = mis_power(bsdf_pdf_[i], scene_.lights().pdf(s.light, {from_[i].p}, d, s.p,
                                                                     s.ng, s.material));
            }
            const Color light = throughput_[i] * e * weight;
            out_[i].radiance += light;
            if (passes_) passes_->end(i, label_of(scene_, s.material, s.light), light);
        }
        if (!program || depth_[i].last) stop(i);
    }

    // A boundary of glass: between which indices, and whether there is one at all where bodies
    // overlap. True: the path goes straight on.
    bool meet_glass(int i, const ShaderProgram& program) noexcept {
        const SurfacePoint& s = surface_[i];
        const Vec3f d = ray_[i].d;
        const bool real =
            program.with_surface(shade_in_[i], scene_.textures(), [&](const Surface& surface) {
                return inside_[i].meet_glass(program, surface, s.material, dot(s.ng, d) <= 0.0f,
                                             shade_in_[i], scene_.textures(), seeds_[i]);
            });
        if (real) return false;
        stop(i);
        ray_[i] = Ray{offset_origin(s.p, s.p_error, s.ng, d), d};
        if (!traceable(ray_[i].o, ray_[i].d)) {
            invalid(InvalidCause::bounce_ray, i);
        } else if (inside_[i].may_pass()) {
            passing_ |= 1u << i;
        }
        return true;
    }

    // ---- the frames that face the viewers, and what the surfaces do there
    void face_viewer() noexcept {
        Vec3Lanes wo, ns;
        each(alive_, [&](int i) {
            const SurfacePoint& s = surface_[i];
            Vec3f viewer = -ray_[i].d;
            // Light that comes out of a body is looked at from outside.
            if (leaves_body(i)) viewer = ray_[i].d;
            const bool front = dot(s.ng, viewer) >= 0.0f;
            frame_.front.is[i] = front;
            frame_.within.is[i] = !front && scene_.program(s.material).facts().glass;
            frame_.ng.set(i, front ? s.ng : -s.ng);
            frame_.even.set(i, front ? s.ns : -s.ns);
            frame_.lift.set(i, front ? s.lift : Vec3f{});
            wo.set(i, viewer);
            ns.set(i, facing_normal<F>(s, scene_.program(s.material), shade_in_[i],
                                       scene_.textures(), front));
            p_.set(i, s.p);
            p_error_.set(i, s.p_error);
        });
        for (int i = 0; i < kLanes; ++i) {
            const Vec3f even = frame_.even[i];
            const Vec3f guard = pick(is_lifted(frame_.lift[i]), even, frame_.ng[i]);
            const Frame f(frame_.bent_normal(i, ns[i], guard, wo[i]));
            frame_.guard.set(i, guard);
            frame_.set_shading(i, f);
            lobes_.wo.set(i, f.to_local(wo[i]));
            lobes_.even.set(i, f.to_local(even));
        }
        if constexpr (F.textures || F.specular) {
            each(alive_, [&](int i) {
                const SurfacePoint& s = surface_[i];
                if (!frame_follows_texture<F>(scene_.program(s.material))) return;
                const Frame f = frame_in_texture<F>(frame_.n[i], s, scene_.program(s.material),
                                                    shade_in_[i], scene_.textures());
                frame_.set_shading(i, f);
                lobes_.wo.set(i, f.to_local(wo[i]));
                lobes_.even.set(i, f.to_local(frame_.even[i]));
            });
        }
    }

    void find_lobes(std::uint32_t depth) noexcept {
        lobes_.clear();
        if constexpr (F.apart) apart_.clear();
        each(alive_, [&](int i) {
            from_[i] = {surface_[i].p + frame_.lift[i]};
            const ShaderProgram& program = scene_.program(surface_[i].material);
            View view;
            view.front = frame_.front.is[i] != 0;
            if constexpr (kMedia<F>) {
                if (inside_[i].leaves_body()) return lobes_.push(i, DiffuseLobe{}, Color(1.0f));
                view.eta = inside_[i].eta();
                view.finest = kSafety * max_component(p_error_[i]);
                view.coat = coat_frame<F>(
                    surface_[i], program, shade_in_[i], scene_.textures(), view.front,
                    frame_.shading(i), frame_.shading(i).to_local(frame_.guard[i]), lobes_.wo[i]);
            }
            if constexpr (F.apart) apart_.find(i, surface_[i].material, view.front);
            push_lobes<F>(program, shade_in_[i], scene_.textures(), view, i, lobes_);
        });
        lobes_.prepare();
        each(alive_, [&](int i) {
            if (!depth_[i].layers_done) note_layers(i, depth);
        });
    }

    // ---- next-event estimation
    void sample_lights(std::uint32_t depth) noexcept {
        shadow_lanes_ = 0;
        if (!scene_.lights().sampled()) return;
        LaneMask lanes = alive_ & lobes_.extended();
        if (lanes == 0) return;
        lanes = scene_.lights().sample(lanes, from_.array(), choice_u_.x, light_u_, light_);
        lanes &= aim_at_lights();
        if (lanes == 0) return;
        each(lanes, [&](int i) { look_at_emitter(i); });
        lobes_.eval(lanes, wi_);
        lanes &= weigh_lights(lanes);
        if constexpr (kMedia<F>) {
            each(lanes, [&](int i) {
                const Medium* medium = inside_[i].medium();
                if (!medium || medium->empty()) return;
                const float way = light_.infinite[i] ? kInfinity : length(shadow_d_[i]);
                pending_.set(i, pending_[i] * transmittance(*medium, way));
            });
        }
        if (passes_ && passes_->follows_light()) each(lanes, [&](int i) { aim_passes(i, depth); });
        each(lanes, [&](int i) {
            if (!traceable(shadow_o_[i], shadow_d_[i])) return invalid(InvalidCause::shadow_ray, i);
            shadow_lanes_ |= 1u << i;
        });
    }

    // Shadow rays; the lights as the frames see them. Returns the lanes on whose side the light is.
    LaneMask aim_at_lights() noexcept {
        LaneFlags faced;
        for (int i = 0; i < kLanes; ++i) {
            const Vec3f wi = light_.wi[i], local = frame_.shading(i).to_local(wi);
            const Vec3f o = ray_origin(p_[i], p_error_[i], frame_.ng[i], frame_.lift[i], wi, local);
            const Vec3f end = offset_origin(light_.p[i], light_.p_error[i], light_.n[i], -wi) - o;
            const bool infinite = light_.infinite[i] != 0;
            shadow_o_.set(i, o);
            shadow_d_.set(
                i, {infinite ? wi.x : end.x, infinite ? wi.y : end.y, infinite ? wi.z : end.z});
            shadow_t_max_[i] = infinite ? kInfinity : 0x1.fffffcp-1f;  // the end is not in the way
            wi_.set(i, local);
            faced.is[i] =
                same_side(wi, local, frame_.guard[i]) && (F.transmission || local.z > 0.0f);
        }
        return faced.mask();
    }

    // An emissive mesh says by its material what it sends.
    void look_at_emitter(int i) noexcept {
        if (light_.material[i] < 0) return;
        light_.radiance.set(
            i, emitter_radiance(scene_, light_.material[i], light_.placement[i], light_.uv[i],
                                light_.p[i], light_.n[i], light_.wi[i]));
    }

    // What the lights give if nothing is in the way. Returns the lanes that are worth a ray.
    LaneMask weigh_lights(LaneMask lanes) noexcept {
        LaneFlags lit;
        for (int i = 0; i < kLanes; ++i) {
            const float pdf = light_.pdf[i], ratio = lobes_.pdf(i) / pdf;
            const float mis = 1.0f / (1.0f + ratio * ratio);
            const float weight = pick(light_.delta[i] != 0, 1.0f, mis);
            const Color c = throughput_[i] * lobes_.f(i) * light_.radiance[i] * (weight / pdf);
            pending_.set(i, c);
            lit.is[i] = max_component(c) > 0.0f;
        }
        if constexpr (F.apart) {
            each(lanes & apart_.lanes(), [&](int i) {
                const Color c = apart_.weigh_light(i, lobes_, wi_[i], light_);
                pending_.set(i, throughput_[i] * c);
                lit.is[i] = max_component(pending_[i]) > 0.0f;
            });
        }
        return lit.mask();
    }

    // ---- occlude: the blocked contributions are dropped, the others added
    void occlude(std::uint32_t depth) noexcept {
        if (shadow_lanes_ == 0) return;
        counters_.rays.shadow += static_cast<std::uint64_t>(std::popcount(shadow_lanes_));
        ray_seeds(job_, 2 * depth + 1, seeds_);
        const auto shadow = [&](int i) {
            return Ray{shadow_o_[i], shadow_d_[i], shadow_t_max_[i]};
        };
        LaneMask blocked = 0;
        if (depth == 0) {
            RayPacket& rays = packet_.ray;
            each(shadow_lanes_, [&](int i) { rays.set(i, shadow(i)); });
            if (job_.log) job_.log->packet(rays, shadow_lanes_, seeds_, true);
            blocked = scene_.accel().occluded(rays, shadow_lanes_, seeds_);
        } else {
            each(shadow_lanes_, [&](int i) {
                const Ray ray = shadow(i);
                if (job_.log) job_.log->single(ray, seeds_[i], true);
                blocked |= static_cast<LaneMask>(scene_.accel().occluded(ray, seeds_[i])) << i;
            });
        }
        each(shadow_lanes_ & ~blocked, [&](int i) { out_[i].radiance += pending_[i]; });
        if (!passes_ || !passes_->follows_light()) return;
        each(shadow_lanes_ & ~blocked, [&](int i) { passes_->lit(i, pending_[i]); });
        if (depth == 0 && passes_->wants_shadow())
            each(shadow_lanes_,
                 [&](int i) { passes_->shadow_found(i, ((blocked >> i) & 1u) != 0); });
    }

    // ---- scatter: the paths go on, or stop
    void scatter(std::uint32_t depth) noexcept {
        alive_ = lobes_.sample(alive_, bsdf_u_, choice_u_.y, scattered_);
        if constexpr (F.apart) alive_ = apart_.weigh_samples(alive_, lobes_, scattered_);
        weigh_paths();
        alive_ &= leave_surfaces();
        if (passes_ && passes_->wants_light()) {
            each(alive_, [&](int i) {
                if (!leaves_body(i))
                    scatter_passes<F>(*passes_, i, lobes_, apart_, scattered_.wi[i],
                                      scattered_.pdf[i] == 0.0f);
            });
        }
        if constexpr (F.apart) read_reflection_maps();
        if (depth >= static_cast<std::uint32_t>(settings_.min_depth)) alive_ &= play_roulette();
        each(alive_, [&](int i) {
            if (!carry_on(i, depth)) stop(i);
        });
    }

    void weigh_paths() noexcept {
        const LobeSamples& b = scattered_;
        for (int i = 0; i < kLanes; ++i) {
            throughput_.set(i, throughput_[i] * b.weight[i]);
            bsdf_pdf_[i] = b.pdf[i];
            eta_scale_[i] *= b.eta[i] * b.eta[i];
            cone_spread_[i] = std::max(cone_spread_[i], b.spread[i]);
        }
    }

    // The next rays. Returns the lanes that carry something to where it was meant to go.
    LaneMask leave_surfaces() noexcept {
        LaneFlags carries;
        leaving_.find(frame_, scattered_);
        for (int i = 0; i < kLanes; ++i) {
            const Vec3f wi = leaving_.wi[i], local = scattered_.wi[i];
            bsdf_pdf_[i] = pick(leaving_.turned.is[i] != 0, 0.0f, bsdf_pdf_[i]);
            next_o_.set(i, ray_origin(p_[i], p_error_[i], frame_.ng[i], frame_.lift[i], wi, local));
            next_d_.set(i, wi);
            carries.is[i] = max_component(throughput_[i]) > 0.0f;
        }
        return carries.mask() & leaving_.left.mask();
    }

    LaneMask play_roulette() noexcept {
        LaneFlags survives;
        for (int i = 0; i < kLanes; ++i) {
            const float chance = std::min(max_component(throughput_[i]) * eta_scale_[i], 1.0f);
            survives.is[i] = roulette_u_[i] < chance;
            throughput_.set(i, throughput_[i] * (1.0f / chance));
        }
        return survives.mask();
    }

    bool carry_on(int i, std::uint32_t depth) noexcept {
        PathDepth& at = depth_[i];
        // Behind a mirror or clear glass the albedo is that of what is seen there.
        const auto cls = static_cast<LobeClass>(scattered_.cls[i]);
        if (bsdf_pdf_[i] > 0.0f || cls == LobeClass::subsurface) at.layers_done = true;
        if (!at.layers_done) passes_->first(i).albedo = Color(0.0f);
        at.scatter(cls, depth, settings_);
        if (at.last && !scene_.emission_can_be_hit()) return false;
        if constexpr (kMedia<F>) {
            const ShaderProgram& program = scene_.program(surface_[i].material);
            const Color tint =
                inside_[i].scatter(cls, program, surface_[i].material, frame_.front.is[i] != 0,
                                   shade_in_[i], scene_.textures());
            throughput_.set(i, throughput_[i] * tint);
            if (!(max_component(throughput_[i]) > 0.0f)) return false;
        }
        ray_[i] = Ray{next_o_[i], next_d_[i]};
        if (!traceable(ray_[i].o, ray_[i].d)) {
            invalid(InvalidCause::bounce_ray, i);
            return false;
        }
        return true;
    }

    // Paths that go on by reflection may end in a map.
    void read_reflection_maps() noexcept {
        each(alive_ & apart_.lanes(), [&](int i) {
            const ReflectionMap* map = apart_.end(i, scattered_.wi[i]);
            if (!map) return;
            const Color light = throughput_[i] * map->seen(surface_[i].p, next_d_[i]);
            out_[i].radiance += light;
            if (passes_) passes_->end(i, LightType::surroundings, 0, light);
            if (!depth_[i].layers_done && bsdf_pdf_[i] == 0.0f)
                passes_->first(i).albedo = throughput_[i];
            stop(i);
        });
    }

    // ---- passes
    void note_first_hit(int i, SurfacePoint& s) noexcept {
        out_[i].alpha = 1.0f;
        if (passes_)
            note_geometry(scene_, hit_[i], ray_[i].d, passes_->wants_uv(), s, passes_->first(i));
    }

    // Albedo of the first surface that is not a mirror or clear glass, as denoisers want it.
    void note_layers(int i, std::uint32_t depth) noexcept {
        passes_->first(i).albedo = throughput_[i] * lobes_.albedo(i);
        if (depth != 0) return;
        if (passes_->wants_albedos()) passes_->albedos(i, lobes_.albedos(i));
        if (passes_->wants_ao() &&
            !is_open(job_, frame_, i, p_[i], p_error_[i], seeds_[i], counters_))
            passes_->first(i).ao = 0.0f;
    }

    // What the light that was chosen will be to the passes, if nothing is in its way.
    void aim_passes(int i, std::uint32_t depth) noexcept {
        const LightLabel light = label_of(scene_, light_.material[i], light_.light[i]);
        if (depth == 0 && passes_->wants_shadow()) {
            // All of it, not the part that this way of sampling stands for.
            const float ratio = lobes_.pdf(i) / light_.pdf[i];
            passes_->shadow(i, pending_[i] * (light_.delta[i] ? 1.0f : 1.0f + ratio * ratio));
        }
        if (!passes_->wants_light()) return;
        if (leaves_body(i)) return passes_->aim_unscattered(i, light);
        passes_->aim(i, light_shares<F>(i, lobes_, apart_, wi_[i], light_), light);
    }

    // The way into a body and out of it is one event.
    bool leaves_body(int i) const noexcept {
        if constexpr (kMedia<F>) return inside_[i].leaves_body();
        return false;
    }

    void invalid(InvalidCause cause, int i) noexcept {
        counters_.add_invalid(cause, job_.x[i], job_.y[i], job_.sample);
    }

    void finish() noexcept {
        each(job_.lanes, [&](int i) {
            PathSample& o = out_[i];
            if (is_finite(o.radiance) && !(min_component(o.radiance) < 0.0f)) return;
            invalid(InvalidCause::radiance, i);
            o.radiance = Color(0.0f);
        });
    }

    const BlockJob& job_;
    const Scene& scene_;
    const RenderDesc& settings_;
    BlockSamples& out_;
    Counters& counters_;
    PathPasses* const passes_;  // null: beauty alone
    LaneMask alive_ = 0, escaped_ = 0, shadow_lanes_ = 0;
    LaneMask passing_ = 0;  // lanes that go straight on, past a boundary that is none
    std::uint32_t seeds_[kLanes];
    SamplePairs light_u_, choice_u_, bsdf_u_;
    float roulette_u_[kLanes];

    // The paths.
    Lanes<Ray> ray_;
    Vec3Lanes throughput_;
    Lanes<LightReference> from_;  // the vertex that sent the ray: where its pdf was taken
    float bsdf_pdf_[kLanes];      // of its direction; 0: light sampling could not have made it
    float cone_width_[kLanes], cone_spread_[kLanes];
    float eta_scale_[kLanes];  // undoes radiance scaling for the roulette
    Lanes<PathDepth> depth_;
    struct Nothing {};
    std::conditional_t<kMedia<F>, Lanes<Inside>, Nothing> inside_;
    std::conditional_t<F.apart, Apart, NoneApart> apart_{scene_};

    // Their present vertices.
    Lanes<Hit> hit_;
    Lanes<HitTarget> target_;
    Lanes<SurfacePoint> surface_;
    Lanes<ShadeInput> shade_in_;
    Vec3Lanes p_, p_error_;
    FacingFrames frame_;
    Lobes<F> lobes_;
    LightSamples light_;
    Vec3Lanes wi_;  // local, of the light
    Vec3Lanes shadow_o_, shadow_d_;
    float shadow_t_max_[kLanes];
    Vec3Lanes pending_;  // light that waits for its shadow ray
    LobeSamples scattered_;
    Leaving leaving_;
    Vec3Lanes next_o_, next_d_;
    HitPacket packet_;
};

template <Features F>
void trace_path(const BlockJob& job, BlockSamples& out, Counters& counters) noexcept {
    PathBlock<F>(job, out, counters).trace();
}

}  // namespace tessera
