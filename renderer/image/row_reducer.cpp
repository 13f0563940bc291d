#include "renderer/image/row_reducer.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace tessera {

RowReducer::Cover RowReducer::cover(int i, int n, int m) {
    const std::int64_t from = std::int64_t(i) * n, to = std::int64_t(i + 1) * n;  // in 1/m
    Cover c;
    c.first = static_cast<int>(from / m);
    for (std::int64_t t = c.first; t * m < to && c.count < 3; ++t) {
        const std::int64_t overlap = std::min(to, (t + 1) * m) - std::max(from, t * m);
        c.share[c.count++] = static_cast<float>(overlap) / static_cast<float>(n);
    }
    return c;
}

RowReducer::RowReducer(const std::vector<Pyramid::Level>& levels, std::size_t channels, Sink sink)
    : channels_(channels), sink_(std::move(sink)) {
    for (std::size_t k = 0; k + 1 < levels.size(); ++k) {
        const Pyramid::Level &a = levels[k], &b = levels[k + 1];
        Stage& stage = stages_.emplace_back();
        stage.height = a.height;
        stage.next_height = b.height;
        for (int i = 0; i < b.width; ++i) stage.columns.push_back(cover(i, a.width, b.width));
        stage.blend.assign(static_cast<std::size_t>(a.width) * channels, 0.0f);
    }
}

void RowReducer::reduce_columns(Stage& stage) const {
    stage.out.assign(stage.columns.size() * channels_, 0.0f);
    float* out = stage.out.data();
    for (const Cover& column : stage.columns) {
        for (int t = 0; t < column.count; ++t) {
            const float* from =
                stage.blend.data() + static_cast<std::size_t>(column.first + t) * channels_;
            for (std::size_t c = 0; c < channels_; ++c) out[c] += column.share[t] * from[c];
        }
        out += channels_;
    }
}

void RowReducer::push(std::size_t level, std::span<const float> row) {
    if (level == stages_.size()) return;
    Stage& stage = stages_[level];
    const int y = stage.read++;
    // Where a height is odd, a row has a share in two of the next level.
    while (stage.written < stage.next_height) {
        const Cover rows = cover(stage.written, stage.height, stage.next_height);
        if (y < rows.first) return;
        const float share = rows.share[y - rows.first];
        for (std::size_t x = 0; x < row.size(); ++x) stage.blend[x] += share * row[x];
        if (y + 1 < rows.first + rows.count) return;
        reduce_columns(stage);
        std::fill(stage.blend.begin(), stage.blend.end(), 0.0f);
        sink_(level + 1, stage.written++, stage.out);
        push(level + 1, stage.out);
    }
}

}  // namespace tessera
