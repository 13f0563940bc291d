#include <nlohmann/json.hpp>

#include "renderer/api/render.h"

namespace tessera {

const char* to_string(InvalidCause cause) {
    switch (cause) {
        case InvalidCause::camera_ray:
            return "camera_ray";
        case InvalidCause::bounce_ray:
            return "bounce_ray";
        case InvalidCause::shadow_ray:
            return "shadow_ray";
        case InvalidCause::hit:
            return "hit";
        case InvalidCause::radiance:
            return "radiance";
        case InvalidCause::count:
            break;
    }
    return "unknown";
}

namespace {

using nlohmann::ordered_json;

ordered_json interval_json(const Interval& i) {
    return {{"value", i.value}, {"low", i.low}, {"high", i.high}, {"reliable", i.reliable}};
}

ordered_json causes_json(const std::vector<ErrorCause>& causes) {
    ordered_json out = ordered_json::array();
    for (const ErrorCause& c : causes)
        out.push_back({{"paths", c.paths},
                       {"light", c.light},
                       {"seen", c.seen},
                       {"through", c.through},
                       {"share", c.share},
                       {"remedy", c.remedy}});
    return out;
}

// null where a picture says nothing of its error.
ordered_json error_json(const ErrorEstimate& e, const std::vector<ErrorPoint>& curve) {
    if (!e.known) return nullptr;
    ordered_json worst = interval_json(e.worst_tile);
    worst["window"] = {e.tile.x0, e.tile.y0, e.tile.x1, e.tile.y1};
    ordered_json points = ordered_json::array();
    for (const ErrorPoint& p : curve)
        points.push_back({{"spp", p.spp},
                          {"wall", p.wall_s},
                          {"cpu", p.cpu_s},
                          {"rmse", interval_json(p.rmse)},
                          {"relmse", interval_json(p.relmse)},
                          {"forecast",
                           {{"spp", interval_json(p.forecast.spp)},
                            {"wall", interval_json(p.forecast.wall_s)}}}});
    return {{"rmse", interval_json(e.rmse)},
            {"relmse", interval_json(e.relmse)},
            {"epsilon", e.epsilon},
            {"worst_tile", worst},
            {"largest_share", e.largest_share},
            {"cautions", e.cautions},
            {"causes", causes_json(e.causes)},
            {"curve", points}};
}

ordered_json target_json(const Statistics& s) {
    if (!s.error_target) return nullptr;
    return {{"metric", s.error_target->relative ? "relmse" : "rmse"},
            {"value", s.error_target->value},
            {"reached", s.error_reached}};
}

}  // namespace

std::string to_json(const Statistics& s) {
    const auto rate = [](std::uint64_t n, double seconds) {
        return seconds > 0 ? static_cast<double>(n) / seconds : 0.0;
    };
    ordered_json invalid = ordered_json::object();
    std::uint64_t invalid_total = 0;
    for (int i = 0; i < kInvalidCauses; ++i) {
        invalid[to_string(static_cast<InvalidCause>(i))] = s.invalid[i];
        invalid_total += s.invalid[i];
    }
    invalid["total"] = invalid_total;
    invalid["first"] = s.first_invalid;
    ordered_json left_out = ordered_json::array();
    for (const LeftOut& l : s.left_out) left_out.push_back({{"what", l.what}, {"why", l.why}});
    ordered_json subdivision = ordered_json::array();
    for (const SubdivisionStatistics& d : s.subdivision) {
        subdivision.push_back({{"mesh", d.mesh},
                               {"cage_faces", d.cage_faces},
                               {"triangles", d.triangles},
                               {"vertices", d.vertices},
                               {"bytes_surface", d.bytes_surface},
                               {"bytes_dicing", d.bytes_dicing},
                               {"seconds", d.seconds},
                               {"non_finite", d.non_finite},
                               {"bounds_before", d.before},
                               {"bounds_after", d.after}});
    }
    const ordered_json j = {
        {"format", 1},
        {"version", s.version},
        {"scene", s.scene},
        {"complete", s.complete},
        {"integrator", s.integrator},
        {"kernel", s.kernel},
        {"embree_isa", s.isa},
        {"resolution", {s.width, s.height}},
        {"spp", s.spp},
        {"first_sample", s.first_sample},
        {"resumed", {{"spp", s.resumed_spp}, {"seconds", s.resumed_s}}},
        {"checkpoints",
         {{"written", s.checkpoints},
          {"failed", s.checkpoints_failed},
          {"seconds", s.checkpoint_s},
          {"every", s.checkpoint_every_s}}},
        {"seed", s.seed},
        {"threads", s.threads},
        {"tile", s.tile},
        {"seconds",
         {{"load", s.load_s}, {"build", s.build_s}, {"render", s.render_s}, {"write", s.write_s}}},
        {"samples", s.samples},
        {"samples_per_second", rate(s.samples, s.render_s)},
        {"rays",
         {{"camera", s.rays.camera},
          {"bounce", s.rays.bounce},
          {"shadow", s.rays.shadow},
          {"total", s.rays.total()}}},
        {"rays_per_second", rate(s.rays.total(), s.render_s)},
        {"geometry",
         {{"triangles_stored", s.triangles_stored},
          {"triangles_instanced", s.triangles_instanced},
          {"instances", s.instances},
          {"lights", s.lights}}},
        {"subdivision", subdivision},
        {"memory_bytes",
         {{"peak", s.memory_peak},
          {"geometry", s.memory_geometry},
          {"bvh", s.memory_bvh},
          {"textures", s.memory_textures},
          {"lights", s.memory_lights},
          {"creases", s.memory_creases},
          {"film", s.memory_film}}},
        {"textures",
         {{"limit_bytes", s.texture_limit},
          {"in_memory", s.textures_in_core},
          {"in_cache", s.textures_cached},
          {"cache_read_bytes", s.texture_bytes_read},
          {"failed_lookups", s.texture_failures}}},
        {"error", {{"beauty", error_json(s.error, s.error_curve)}, {"target", target_json(s)}}},
        {"invalid", invalid},
        {"half", {{"clamped", s.half_clamped}, {"non_finite", s.half_non_finite}}},
        {"left_out", left_out},
        {"warnings", s.warnings},
        {"notes", s.notes},
    };
    return j.dump(2, ' ', false, ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace tessera
