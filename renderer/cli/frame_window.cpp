#include "renderer/cli/frame_window.h"

#include <cmath>

namespace tessera {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 30;

}  // namespace

std::optional<PixelWindow> frame_window(const SceneDesc& scene) {
    const FilmDesc& film = scene.film;
    if (film.crop || (film.overscan <= 0 && film.overscan_px <= 0)) return film.crop;
    if (shows_all_directions(scene.camera.projection)) {
        throw Error(ExitCode::usage, film.loc,
                    "film: overscan: a picture of all directions has nothing beyond its edges");
    }
    const auto beyond = [&](int side) {
        return film.overscan_px + static_cast<int>(std::ceil(film.overscan * side));
    };
    const int dx = beyond(film.width), dy = beyond(film.height);
    const PixelWindow window{-dx, -dy, film.width + dx, film.height + dy};
    if (std::int64_t{window.width()} * window.height() > kMaxPixels) {
        throw Error(ExitCode::usage, film.loc,
                    "film: overscan makes the picture larger than 2^30 pixels");
    }
    return window;
}

}  // namespace tessera
