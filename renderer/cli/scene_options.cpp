#include "renderer/cli/scene_options.h"

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

#include "renderer/film/film.h"

namespace tessera {
namespace {

[[noreturn]] void usage(const std::string& message) { throw Error(ExitCode::usage, message); }

void apply_resolution(const std::string& text, FilmDesc& film) {
    int w = 0, h = 0;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%dx%d%c", &w, &h, &rest) != 2 || w < 1 || h < 1 || w > 65536 || h > 65536) {
        usage("--res " + text + ": must be WIDTHxHEIGHT in pixels, each 1 to 65536, for example 960x540");
    }
    film.width = w;
    film.height = h;
    film.crop.reset();
}

void apply_crop(const std::string& text, FilmDesc& film) {
    PixelWindow c;
    char rest = 0;
    if (std::sscanf(text.c_str(), "%d,%d,%d,%d%c", &c.x0, &c.y0, &c.x1, &c.y1, &rest) != 4) {
        usage("--crop " + text + ": must be X0,Y0,X1,Y1 in pixels");
    }
    if (c.x0 < 0 || c.y0 < 0 || c.x1 > film.width || c.y1 > film.height || c.x0 >= c.x1 || c.y0 >= c.y1) {
        usage("--crop " + text + ": must lie within the frame of " + std::to_string(film.width) + "x" +
              std::to_string(film.height) + " pixels, with X0 < X1 and Y0 < Y1");
    }
    film.crop = c;
}

}  // namespace

void SceneOptions::add_to(CLI::App& app) {
    app.add_option("scene", scene, "Scene: an .obj or a Tessera scene file (.toml)")->required();
    app.add_option("-s,--spp", spp, "Samples per pixel")->check(CLI::Range(1, 1 << 24));
    app.add_option("-r,--res", res, "Resolution, WIDTHxHEIGHT");
    app.add_option("--crop", crop, "Crop window X0,Y0,X1,Y1 in pixels of the full frame");
    app.add_option("--seed", seed, "Seed of the sampling");
    app.add_option("--aov", aovs, "A pass beyond beauty: Z, N, P, albedo (repeatable; default all; 'beauty' alone: none)");
    app.add_option("--set", set, "Any key of the scene file, for example --set camera.fov_deg=35 (repeatable)");
    app.add_option("-t,--threads", threads, "Threads; 0: what affinity, cgroup and Slurm allow; -N: all but N");
    app.add_option("--tile", tile, "Tile size in pixels, a multiple of 4")->check(CLI::Range(4, 4096));
    app.add_option("--kernel", kernel, "Path kernel: basic, surface or full (default: the smallest that serves)");
    app.add_option("--isa", isa, "Embree's instruction set: sse2, sse4.2, avx, avx2, avx512 (default: the best)");
    app.add_flag("--strict", strict, "Warnings are errors");
    app.add_flag("--allow-external-assets", external, "Assets may lie outside the scene's folders");
    for (CLI::Option* o : app.get_options()) o->multi_option_policy(o->get_expected_max() > 1 ? CLI::MultiOptionPolicy::TakeAll : CLI::MultiOptionPolicy::TakeLast);
}

SceneDesc SceneOptions::load(double& load_s) const {
    const auto start = std::chrono::steady_clock::now();
    if (tile % 4 != 0) usage("--tile " + std::to_string(tile) + ": must be a multiple of 4");
    FilmLayers known;
    for (const std::string& name : aovs) {
        if (!enable_layer(name, known)) usage("--aov " + name + ": unknown, there are beauty, Z, N, P and albedo");
    }
    LoadOptions options;
    options.strict = strict;
    options.allow_external_assets = external;
    options.set = set;
    SceneDesc desc = load_scene(scene, options);
    if (!res.empty()) apply_resolution(res, desc.film);
    if (!crop.empty()) apply_crop(crop, desc.film);
    if (spp) desc.render.spp = *spp;
    if (seed) desc.render.seed = *seed;
    if (!aovs.empty()) desc.film.aovs = aovs;
    load_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    return desc;
}

BuildOptions SceneOptions::build_options() const { return {threads, kernel, isa, strict}; }

}  // namespace tessera
