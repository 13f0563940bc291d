#pragma once
// The levels of a pyramid out of the rows of its finest one, as they come: of every level only a
// row or two is held.

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "renderer/image/pyramid.h"

namespace tessera {

class RowReducer {
public:
    /// Called with each row of every level but the finest, from top to bottom.
    using Sink = std::function<void(std::size_t level, int y, std::span<const float> row)>;

    RowReducer(const std::vector<Pyramid::Level>& levels, std::size_t channels, Sink sink);

    /// The next row of the finest level: width times channels values.
    void push(std::span<const float> row) { push(0, row); }

private:
    /// Up to three texels of n that cover texel i of m, with the share each has in it.
    struct Cover {
        int first = 0;
        int count = 0;
        float share[3] = {0, 0, 0};
    };
    static Cover cover(int i, int n, int m);

    /// From one level to the next.
    struct Stage {
        int height = 1, next_height = 1;
        int read = 0, written = 0;  // rows
        std::vector<Cover> columns;
        std::vector<float> blend;  // of the rows that the next one covers
        std::vector<float> out;
    };
    void push(std::size_t level, std::span<const float> row);
    void reduce_columns(Stage& stage) const;

    std::size_t channels_;
    Sink sink_;
    std::vector<Stage> stages_;
};

}  // namespace tessera
