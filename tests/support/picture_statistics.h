#pragma once
// Pictures as random numbers: means of 4x4-pixel blocks over independent seeds, and whether two
// sets of them agree.

#include <cmath>
#include <cstdint>
#include <vector>

#include "tests/support/statistics.h"
#include "tests/support/test_scenes.h"

namespace tessera {

/// Per block and channel (R, G, B).
struct BlockStatistics {
    std::vector<Mean> values;
};

inline BlockStatistics block_statistics(const SceneDesc& scene, std::uint64_t first_seed,
                                        int seeds) {
    constexpr int kBlock = 4;
    const int columns = scene.film.width / kBlock, rows = scene.film.height / kBlock;
    BlockStatistics s;
    s.values.resize(std::size_t(columns) * std::size_t(rows) * 3);
    for (int k = 0; k < seeds; ++k) {
        SceneDesc one = scene;
        one.render.seed = first_seed + static_cast<std::uint64_t>(k);
        one.film.aovs = {"beauty"};
        const std::vector<float> pixels = beauty_of(std::move(one));
        std::vector<double> sums(s.values.size());
        for (int y = 0; y < rows * kBlock; ++y) {
            for (int x = 0; x < columns * kBlock; ++x) {
                const std::size_t block =
                    std::size_t(y / kBlock) * std::size_t(columns) + std::size_t(x / kBlock);
                const float* p =
                    &pixels[4 * (std::size_t(y) * std::size_t(scene.film.width) + std::size_t(x))];
                for (std::size_t c = 0; c < 3; ++c)
                    sums[block * 3 + c] += static_cast<double>(p[c]);
            }
        }
        for (std::size_t i = 0; i < sums.size(); ++i) s.values[i].add(sums[i] / (kBlock * kBlock));
    }
    return s;
}

/// p-value of the hypothesis that two means agree, each with its standard error; floor: relative
/// rounding.
inline double same_mean_p(double a, double error_a, double b, double error_b, double degrees,
                          double floor = 1e-4) {
    const double rounding = floor * std::max(std::fabs(a), std::fabs(b)) + 1e-7;
    return student_p(
        (a - b) / std::sqrt(error_a * error_a + error_b * error_b + rounding * rounding), degrees);
}

/// The least p-value over all blocks, to be held against sidak_level(alpha, count).
inline double least_p(const BlockStatistics& a, const BlockStatistics& b) {
    double least = 1;
    for (std::size_t i = 0; i < a.values.size(); ++i) {
        const Mean &x = a.values[i], &y = b.values[i];
        const double degrees = static_cast<double>(x.count() + y.count()) - 2;
        least = std::min(least, same_mean_p(x.mean(), x.error(), y.mean(), y.error(), degrees));
    }
    return least;
}

}  // namespace tessera
