#include "renderer/cli/frame_window.h"

#include <cmath>

namespace tessera {
namespace {

constexpr std::int64_t kMaxPixels = std::int64_t(1) << 30;

int tiles_up(int pixels, int tile) { return (pixels + tile - 1) / tile * tile; }

}  // namespace

FrameWindow frame_window(const SceneDesc& scene, int tile) {
    const FilmDesc& film = scene.film;
    const PixelWindow frame{0, 0, film.width, film.height};
    if (film.crop || (film.overscan <= 0 && film.overscan_px <= 0))
        return {film.crop, film.crop ? *film.crop : frame};
    if (shows_all_directions(scene.camera.projection)) {
        throw Error(ExitCode::usage, film.loc,
                    "film: overscan: a picture of all directions has nothing beyond its edges");
    }
    const auto beyond = [&](int side) {
        return film.overscan_px + static_cast<int>(std::ceil(film.overscan * side));
    };
    const int dx = beyond(film.width), dy = beyond(film.height);
    FrameWindow window;
    window.write = {-dx, -dy, film.width + dx, film.height + dy};
    window.render = {-tiles_up(dx, tile), -tiles_up(dy, tile), film.width + dx, film.height + dy};
    if (std::int64_t{window.render->width()} * window.render->height() > kMaxPixels) {
        throw Error(ExitCode::usage, film.loc,
                    "film: overscan makes the picture larger than 2^30 pixels");
    }
    return window;
}

}  // namespace tessera
