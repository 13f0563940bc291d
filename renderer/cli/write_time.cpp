#include "renderer/cli/write_time.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <system_error>

#include "renderer/api/error.h"
#include "renderer/cli/output_options.h"
#include "renderer/film/cryptomatte.h"
#include "renderer/film/film_file.h"

namespace tessera {
namespace {

namespace fs = std::filesystem;

// Values as hard to compress as those of a noisy picture.
std::vector<float> noise(std::size_t count) {
    std::vector<float> out(count);
    std::uint32_t state = 1;
    for (float& v : out) {
        state = state * 1664525u + 1013904223u;
        v = static_cast<float>(state >> 8) * 0x1p-24f;
    }
    return out;
}

bool counts_names(const Pass& p) {
    return p.source == PassSource::crypto_object || p.source == PassSource::crypto_material ||
           p.source == PassSource::crypto_asset;
}

LayeredImage strip_of(const Scene& scene, const PixelWindow& window) {
    LayeredImage image;
    image.width = scene.film().width, image.height = scene.film().height;
    image.window = window;
    image.working_space = scene.film().working_space;
    const std::size_t pixels =
        static_cast<std::size_t>(window.width()) * static_cast<std::size_t>(window.height());
    const std::vector<std::string> rgba{"R", "G", "B", "A"};
    image.layers.push_back({"", rgba, LayerKind::color, noise(pixels * 4)});
    for (const Pass& p : scene.passes()) {
        if (!counts_names(p)) {
            image.layers.push_back({p.name, p.channels, p.kind, noise(pixels * p.channels.size())});
            continue;
        }
        for (int i = 0; i < kCryptomatteLevels / 2; ++i)
            image.layers.push_back(
                {p.name + "0" + std::to_string(i), rgba, LayerKind::data, noise(pixels * 4)});
    }
    return image;
}

double write_strip(const Scene& scene, const PixelWindow& window, const PictureFiles& files) {
    const LayeredImage strip = strip_of(scene, window);
    const std::string path = (fs::path(files.output).parent_path() /
                              (".tessera.trial." + std::to_string(::getpid()) + ".exr"))
                                 .string();
    const auto start = std::chrono::steady_clock::now();
    const WriteReport report = write_exr(strip, path, write_options(files.format, files.threads));
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    std::error_code ignored;
    for (const std::string& file : report.files) fs::remove(file, ignored);
    return took.count();
}

}  // namespace

double foreseen_write_time(const Scene& scene, const PictureFiles& files) {
    if (names_film_file(files.output)) return 0;
    const FilmDesc& film = scene.film();
    PixelWindow window{0, 0, film.width, film.height};
    if (film.crop) window = *film.crop;
    const int height = window.height(), rows = std::min(height, std::max(64, height / 8));
    try {
        // What a file takes however small it is, and what its rows take.
        window.y1 = window.y0 + 1;
        const double one = write_strip(scene, window, files);
        window.y1 = window.y0 + rows;
        const double some = rows > 1 ? write_strip(scene, window, files) : one;
        return one + std::max(some - one, 0.0) * height / rows;
    } catch (const Error&) {
        return 0;  // the render will say so when it matters
    }
}

}  // namespace tessera
