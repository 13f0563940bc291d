#include <iterator>
#include <memory>

#include <fmt/format.h>

#include "renderer/cli/commands.h"
#include "renderer/cli/console.h"
#include "renderer/cli/progress.h"
#include "renderer/cli/scene_options.h"
#include "renderer/scene/scene.h"

namespace tessera {
namespace {

std::string mib(std::uint64_t bytes) {
    return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1 << 20));
}

std::string text_of(const Scene& scene) {
    std::string text;
    const auto add = std::back_inserter(text);
    const Statistics s = describe(scene);
    const Vec3d size = scene.bounds_max() - scene.bounds_min();
    fmt::format_to(add, "{}\n", s.scene);
    fmt::format_to(add, "  picture    {} x {}, {} samples per pixel, integrator {}\n", s.width,
                   s.height, s.spp, s.integrator);
    fmt::format_to(add, "  geometry   {} triangles stored, {} instanced, {} instances\n",
                   s.triangles_stored, s.triangles_instanced, s.instances);
    for (const SubdivisionStatistics& d : s.subdivision) {
        fmt::format_to(add,
                       "  subdivided mesh '{}': {} faces to {} triangles in {:.3g} s ({} while "
                       "made); y from {:.6g}..{:.6g} to {:.6g}..{:.6g}\n",
                       d.mesh, d.cage_faces, d.triangles, d.seconds,
                       mib(d.bytes_surface + d.bytes_dicing), d.before[0][1], d.before[1][1],
                       d.after[0][1], d.after[1][1]);
    }
    fmt::format_to(add, "  size       {:.6g} x {:.6g} x {:.6g}", size.x, size.y, size.z);
    const Vec3d o = scene.origin();
    if (!(o == Vec3d{}))
        fmt::format_to(add, ", traced about ({:.17g}, {:.17g}, {:.17g})", o.x, o.y, o.z);
    fmt::format_to(add, "\n  lights     {}\n", s.lights);
    fmt::format_to(add, "  memory     geometry {}, BVH {}, textures {}, lights {}\n",
                   mib(s.memory_geometry), mib(s.memory_bvh), mib(s.memory_textures),
                   mib(s.memory_lights));
    fmt::format_to(add, "  kernel     {} (Embree {}, {})\n", s.kernel, Accel::version(), s.isa);
    fmt::format_to(add, "  hash       {}\n", scene.hash());
    fmt::format_to(add, "left out\n");
    for (const LeftOut& l : s.left_out) fmt::format_to(add, "  {:<20} {}\n", l.what, l.why);
    for (const std::string& n : s.notes) fmt::format_to(add, "note: {}\n", n);
    for (const std::string& w : s.warnings) fmt::format_to(add, "warning: {}\n", w);
    return text;
}

}  // namespace

void add_info(Command app, CommandLine& line) {
    Command sub = app.add_command(
        "info", "Print what is in a scene, and what of the renderer it does not need");
    auto options = std::make_shared<SceneOptions>();
    auto json = std::make_shared<bool>(false);
    options->add_to(sub);
    sub.flag("--json", *json, "As JSON, in the form of the statistics file");
    sub.when_chosen([=, &line] {
        line.run = [=] {
            double load_s = 0;
            const ScenePtr scene = build_scene(options->load(load_s), options->build_options());
            if (*json) {
                Statistics s = describe(*scene);
                s.load_s = load_s;
                s.memory_peak = peak_memory();
                print_out(to_json(s));
            } else {
                print_out(text_of(*scene));
            }
            return 0;
        };
    });
}

}  // namespace tessera
