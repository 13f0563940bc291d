#include "renderer/cli/scene_options.h"

#include <charconv>
#include <chrono>
#include <cmath>

namespace tessera {
namespace {

[[noreturn]] void usage(const std::string& message) { throw Error(ExitCode::usage, message); }

/// "960x540" with separator 'x' -> {960, 540}; empty unless the text is whole numbers and
/// separators only.
std::vector<int> whole_numbers(const std::string& text, char separator) {
    std::vector<int> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        int number = 0;
        const auto [stop, code] = std::from_chars(at, end, number);
        if (code != std::errc()) return {};
        numbers.push_back(number);
        if (stop == end) return numbers;
        if (*stop != separator) return {};
        at = stop + 1;
    }
}

std::vector<int> parse_resolution(const std::string& text) {
    const std::vector<int> size = whole_numbers(text, 'x');
    const auto fits = [](int n) { return n >= 1 && n <= 65536; };
    if (size.size() != 2 || !fits(size[0]) || !fits(size[1]) ||
        std::int64_t{size[0]} * size[1] > 1 << 30) {
        usage("--res " + text +
              ": must be WIDTHxHEIGHT in pixels, each 1 to 65536 and at most 2^30 in all, for "
              "example 960x540");
    }
    return size;
}

PixelWindow parse_crop(const std::string& text) {
    const std::vector<int> c = whole_numbers(text, ',');
    if (c.size() != 4)
        usage("--crop " + text + ": must be X0,Y0,X1,Y1 in pixels, for example 100,100,200,200");
    return {c[0], c[1], c[2], c[3]};
}

std::optional<Double3> parse_position(const std::string& text) {
    if (text.empty()) return std::nullopt;
    Double3 p{};
    const char* at = text.data();
    const char* const end = at + text.size();
    for (std::size_t i = 0; i < 3; ++i) {
        if (i > 0 && at != end && *at == ',') ++at;
        const auto [stop, code] = std::from_chars(at, end, p[i]);
        const bool good = code == std::errc() && std::fabs(p[i]) <= 1e12;
        if (!good || (i < 2 ? stop == end || *stop != ',' : stop != end))
            usage("--camera-position " + text +
                  ": must be X,Y,Z in scene units, for example 0,1.5,-2");
        at = stop;
    }
    return p;
}

void stand_at(const Double3& p, CameraDesc& camera) {
    camera.position = p;
    camera.automatic = false;
    if (!camera.matrix) return;
    for (std::size_t i = 0; i < 3; ++i) (*camera.matrix)[4 * i + 3] = p[i];
}

void apply_crop(const PixelWindow& c, const std::string& text, FilmDesc& film) {
    if (c.x0 < 0 || c.y0 < 0 || c.x1 > film.width || c.y1 > film.height || c.x0 >= c.x1 ||
        c.y0 >= c.y1) {
        usage("--crop " + text + ": must lie within the frame of " + std::to_string(film.width) +
              "x" + std::to_string(film.height) + " pixels, with X0 < X1 and Y0 < Y1");
    }
    film.crop = c;
}

}  // namespace

void SceneOptions::add_to(Command app) {
    app.option("scene", scene, "Scene: an .obj or a Tessera scene file (.toml)").required();
    app.option("-s,--spp", spp, "Samples per pixel").in(1, 1 << 24);
    app.option("-r,--res", res, "Resolution, WIDTHxHEIGHT");
    app.option("--camera", camera,
               "A picture of all directions, to be an environment's file: latlong or cube")
        .one_of({"latlong", "cube"});
    app.option("--camera-position", camera_position, "Where the camera stands, X,Y,Z");
    app.option("--crop", crop, "Crop window X0,Y0,X1,Y1 in pixels of the full frame");
    app.option("--seed", seed, "Seed of the sampling");
    app.option("--frame", frame, "Frame of image sequences").in(-1000000, 1000000);
    app.option(
        "--aov", aovs,
        "A pass beyond beauty, a preset (compositing, lookdev, ...), light_groups, PASS@groups or "
        "'NAME = LIGHT PATH EXPRESSION' (repeatable; see --list-aovs; 'beauty' alone: none)");
    app.option("--set", set,
               "Any key of the scene file, for example --set camera.fov_deg=35 (repeatable)");
    app.option("-t,--threads", threads,
               "Threads; 0: what affinity, cgroup and Slurm allow; -N: all but N")
        .in(-4096, 4096);
    app.option("--tile", tile, "Tile size in pixels, a multiple of 4").in(4, 4096);
    app.option("--kernel", kernel,
               "Path kernel: basic, surface or full (default: the smallest that serves)")
        .one_of({"basic", "surface", "full"});
    app.option("--isa", isa, "Embree's instruction set (default: the best of this machine)")
        .one_of({"sse2", "sse4.2", "avx", "avx2", "avx512"});
    app.option("--texture-memory", texture_memory,
               "MiB that textures may take, the tile cache included (default 4096)")
        .in(32, 1 << 24);
    app.flag("--auto-tx", auto_tx,
             "Images that --texture-memory has no room for are made into .tx files, once");
    app.option("--tx-cache", tx_cache,
               "Folder of the .tx files (default $XDG_CACHE_HOME/tessera/tx)");
    Option no_warnings = app.flag("--strict", strict, "Warnings are errors");
    app.flag("--lenient", lenient,
             "Broken faces, numbers and images are left out with a warning instead of refused")
        .excludes(no_warnings);
    app.flag("--allow-external-assets", external, "Assets may lie outside the scene's folders");
    app.last_of_each();
}

SceneDesc SceneOptions::load(double& load_s) const {
    const auto start = std::chrono::steady_clock::now();
    if (tile % 4 != 0) usage("--tile " + std::to_string(tile) + ": must be a multiple of 4");
    const std::vector<int> size = res.empty() ? std::vector<int>{} : parse_resolution(res);
    const PixelWindow window = crop.empty() ? PixelWindow{} : parse_crop(crop);
    const std::optional<Double3> position = parse_position(camera_position);
    LoadOptions options;
    options.strictness = strictness();
    options.allow_external_assets = external;
    options.set = set;
    if (frame) options.set.push_back("render.frame=" + std::to_string(*frame));
    SceneDesc desc = load_scene(scene, options);
    if (!camera.empty()) {
        desc.camera.projection = camera == "cube" ? Projection::cube : Projection::latlong;
        set_map_size(desc.camera.projection, desc.film);
    }
    if (position) stand_at(*position, desc.camera);
    if (!size.empty()) {
        desc.film.width = size[0];
        desc.film.height = size[1];
        desc.film.crop.reset();
    }
    if (!crop.empty()) apply_crop(window, crop, desc.film);
    if (spp) desc.render.spp = *spp;
    if (seed) desc.render.seed = *seed;
    if (!aovs.empty()) {
        desc.film.aovs = aovs;
        desc.film.aovs_loc = {std::make_shared<const std::string>("--aov")};
    }
    load_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return desc;
}

BuildOptions SceneOptions::build_options() const {
    BuildOptions options;
    options.threads = threads;
    options.kernel = kernel;
    options.isa = isa;
    options.strictness = strictness();
    options.texture_memory = std::int64_t{texture_memory} << 20;
    options.auto_tx = auto_tx;
    options.tx_cache = tx_cache;
    return options;
}

Strictness SceneOptions::strictness() const noexcept {
    if (lenient) return Strictness::lenient;
    return strict ? Strictness::strict : Strictness::normal;
}

}  // namespace tessera
