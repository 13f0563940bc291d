#include "renderer/integrator/resume.h"

#include <algorithm>

#include "renderer/film/cryptomatte.h"
#include "renderer/film/film_file.h"
#include "renderer/integrator/block.h"

namespace tessera {
namespace {

const NameList& names_of(const Scene& scene, PassSource source) {
    if (source == PassSource::crypto_object) return scene.name_ids()->list(NameKind::object);
    return scene.name_ids()->list(source == PassSource::crypto_material ? NameKind::material
                                                                        : NameKind::asset);
}

bool counts_names(PassSource s) {
    return s == PassSource::crypto_object || s == PassSource::crypto_material ||
           s == PassSource::crypto_asset;
}

// A block is rendered as one.
bool even_blocks(const Film& film) {
    const PixelWindow& w = film.window();
    for (int y = w.y0; y < w.y1; ++y) {
        for (int x = w.x0; x < w.x1; ++x) {
            const int left = std::max(x & ~(kBlockSize - 1), w.x0);
            const int top = std::max(y & ~(kBlockSize - 1), w.y0);
            if (film.samples(x, y) != film.samples(left, top)) return false;
        }
    }
    return true;
}

}  // namespace

FilmExtras film_extras(const Scene& scene, const RenderSettings& settings) {
    const Passes& passes = scene.passes();
    const bool wanted = std::any_of(passes.begin(), passes.end(), [](const Pass& p) {
        return p.source == PassSource::standard_error;
    });
    return {settings.deep, settings.error_estimate || wanted, scene.settings().seed};
}

FilmHeader film_header(const Scene& scene, const PixelWindow& window,
                       const RenderSettings& settings) {
    const Statistics& s = scene.statistics();
    FilmHeader h;
    h.version = s.version;
    h.isa = s.isa;
    h.scene = s.scene;
    h.scene_hash = scene.hash();
    h.working_space = scene.film().working_space;
    h.width = scene.film().width;
    h.height = scene.film().height;
    h.window = window;
    h.seed = scene.settings().seed;
    h.passes = scene.passes();
    h.extras = film_extras(scene, settings);
    h.first_sample = settings.first_sample;
    for (const Pass& p : h.passes) {
        h.ids.emplace_back();
        if (!counts_names(p.source)) continue;
        const NameList& list = names_of(scene, p.source);
        h.ids.back() = list.ids;
        for (auto& attribute : cryptomatte_header(p.name, list.names))
            h.metadata.push_back(std::move(attribute));
    }
    return h;
}

Film resumed_film(const Scene& scene, const PixelWindow& window, const RenderSettings& settings,
                  double& seconds) {
    const std::string& path = settings.resume;
    const auto refuse = [&](ExitCode code, const std::string& what, const std::string& there,
                            const std::string& here) {
        throw Error(code, path + ": cannot go on from it: its " + what + " is " + there +
                              ", this render's is " + here);
    };
    const FilmHeader wanted = film_header(scene, window, settings);
    // Before the arrays, which may be large, are read.
    const FilmHeader there = read_film_header(path);
    if (const auto d = difference(there, wanted)) refuse(ExitCode::scene, d->what, d->a, d->b);
    if (there.window != window)
        refuse(ExitCode::scene, "window (--crop)", to_string(there.window), to_string(window));
    if (there.first_sample != settings.first_sample)
        refuse(ExitCode::usage, "first sample (--samples)", std::to_string(there.first_sample),
               std::to_string(settings.first_sample));
    const int spp = scene.settings().spp;
    if (there.most > static_cast<std::uint32_t>(spp))
        refuse(ExitCode::usage, "number of samples per pixel", std::to_string(there.most),
               std::to_string(spp));
    FilmFile file = read_film_file(path);
    if (!even_blocks(file.film))
        throw Error(ExitCode::scene, path + ": is damaged: blocks of pixels with unequal samples");
    seconds = file.header.seconds;
    return std::move(file.film);
}

}  // namespace tessera
