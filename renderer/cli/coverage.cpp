#include "renderer/cli/coverage.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "renderer/cli/console.h"

namespace tessera {
namespace {

constexpr std::uint64_t kReferenceSeed = 0x7e55e7a;
constexpr int kTile = 32;
constexpr double kWrong = 1.5;  // above the target, and a claim to have reached it was false

struct Picture {
    std::vector<float> rgba;
    PixelWindow window;
    double at(std::size_t pixel, std::size_t channel) const {
        return static_cast<double>(rgba[4 * pixel + channel]);
    }
};

// As renderer/api/picture_error.h has them.
struct TrueError {
    double rmse = 0, relmse = 0, worst_tile = 0;
};

TrueError true_error(const Picture& picture, const Picture& truth) {
    const PixelWindow& w = truth.window;
    const auto pixels = truth.rgba.size() / 4;
    double mean = 0;
    for (std::size_t p = 0; p < pixels; ++p)
        for (std::size_t c = 0; c < 3; ++c)
            mean += truth.at(p, c) / (3.0 * static_cast<double>(pixels));
    const double epsilon = 0.01 * mean * mean;
    TrueError out;
    for (int ty = 0; ty < w.height(); ty += kTile) {
        for (int tx = 0; tx < w.width(); tx += kTile) {
            const int right = std::min(tx + kTile, w.width()),
                      bottom = std::min(ty + kTile, w.height());
            double tile = 0;
            for (int y = ty; y < bottom; ++y) {
                for (int x = tx; x < right; ++x) {
                    const auto p =
                        static_cast<std::size_t>(y) * static_cast<std::size_t>(w.width()) +
                        static_cast<std::size_t>(x);
                    for (std::size_t c = 0; c < 3; ++c) {
                        const double t = truth.at(p, c), d = picture.at(p, c) - t;
                        tile += d * d;
                        out.relmse += d * d / (t * t + epsilon);
                    }
                }
            }
            out.rmse += tile;
            out.worst_tile =
                std::max(out.worst_tile, std::sqrt(tile / (3.0 * (right - tx) * (bottom - ty))));
        }
    }
    out.rmse = std::sqrt(out.rmse / (3.0 * static_cast<double>(pixels)));
    out.relmse /= 3.0 * static_cast<double>(pixels);
    return out;
}

struct Rendered {
    Picture picture;
    Statistics stats;
};

Rendered render_seed(const SceneOptions& o, std::uint64_t seed, std::optional<int> spp,
                     std::optional<ErrorTarget> target) {
    double load_s = 0;
    SceneDesc desc = o.load(load_s);
    desc.render.seed = seed;
    desc.film.aovs = {"beauty"};
    if (spp) desc.render.spp = *spp;
    const ScenePtr scene = build_scene(std::move(desc), o.build_options());
    RenderSettings settings;
    settings.threads = o.threads;
    settings.tile = 16;  // small pictures for all threads
    settings.target = target;
    RenderResult r = render(*scene, settings);
    return {{std::move(r.image.layers.at(0).pixels), r.image.window}, std::move(r.stats)};
}

double median(std::vector<double> v) {
    std::sort(v.begin(), v.end());
    return v[v.size() / 2];
}

struct Held {
    int reliable = 0, held = 0;
    std::vector<double> ratios;  // estimated over true
    void add(const Interval& i, double truth) {
        if (!i.reliable) return;
        ++reliable;
        held += truth >= i.low && truth <= i.high;
        ratios.push_back(i.value / truth);
    }
    std::string text() const {
        return reliable > 0 ? fmt::format("{:4} {:6.1f} % {:10.3f}", reliable,
                                          100.0 * held / reliable, median(ratios))
                            : "   0      -           -";
    }
};

}  // namespace

int run_coverage(const SceneOptions& o, const CoverageOptions& c) {
    const Rendered reference = render_seed(o, kReferenceSeed, c.reference_spp, std::nullopt);
    Held rmse, relmse, worst;
    std::vector<double> errors;
    int spp = 0;
    for (int k = 0; k < c.seeds; ++k) {
        const Rendered r =
            render_seed(o, static_cast<std::uint64_t>(k) + 1, std::nullopt, std::nullopt);
        const TrueError truth = true_error(r.picture, reference.picture);
        const ErrorEstimate& e = r.stats.error;
        rmse.add(e.rmse, truth.rmse);
        relmse.add(e.relmse, truth.relmse);
        worst.add(e.worst_tile, truth.worst_tile);
        errors.push_back(truth.relmse);
        spp = r.stats.spp;
    }
    const ErrorTarget target{true, median(errors)};
    print_out(fmt::format("scene       {}, {} spp, {} seeds, reference {} spp\n", o.scene, spp,
                          c.seeds, c.reference_spp));
    print_out(fmt::format("true relMSE {:.3g} (median)\n", target.value));
    print_out(
        fmt::format("            reliable, held, estimated over true (median)\nrelMSE      "
                    "{}\nRMSE        {}\nworst tile  {}\n",
                    relmse.text(), rmse.text(), worst.text()));
    int claimed = 0, wrong = 0;
    for (int k = 0; k < c.seeds; ++k) {
        const Rendered r =
            render_seed(o, static_cast<std::uint64_t>(c.seeds) + k + 1, 64 * spp, target);
        if (!r.stats.error_reached) continue;
        ++claimed;
        wrong += true_error(r.picture, reference.picture).relmse > kWrong * target.value;
    }
    print_out(fmt::format("target      {} of {} claim relMSE {:.3g}, {} wrong by more than half\n",
                          claimed, c.seeds, target.value, wrong));
    return 0;
}

}  // namespace tessera
