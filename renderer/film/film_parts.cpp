#include "renderer/film/film_parts.h"

#include <algorithm>

#include "renderer/film/film_header.h"

namespace tessera {
namespace {

// What is left of a box when a part that lies within it is cut out: slabs before and after it in
// one direction, then in the next.
void cut(SampleBox box, const SampleBox& part, std::vector<SampleBox>& left) {
    const auto keep = [&](const SampleBox& b) {
        if (!is_empty(b)) left.push_back(b);
    };
    SampleBox before = box, after = box;
    before.last = part.first, after.first = part.last;
    keep(before), keep(after);
    box.first = part.first, box.last = part.last;

    before = after = box;
    before.window.y1 = part.window.y0, after.window.y0 = part.window.y1;
    keep(before), keep(after);
    box.window.y0 = part.window.y0, box.window.y1 = part.window.y1;

    before = after = box;
    before.window.x1 = part.window.x0, after.window.x0 = part.window.x1;
    keep(before), keep(after);
}

}  // namespace

std::string to_string(const SampleBox& b) {
    return "samples " + std::to_string(b.first) + ":" + std::to_string(b.last) + " of pixels " +
           to_string(b.window);
}

bool is_empty(const SampleBox& b) {
    return b.first >= b.last || b.window.x0 >= b.window.x1 || b.window.y0 >= b.window.y1;
}

SampleBox intersection(const SampleBox& a, const SampleBox& b) {
    return {{std::max(a.window.x0, b.window.x0), std::max(a.window.y0, b.window.y0),
             std::min(a.window.x1, b.window.x1), std::min(a.window.y1, b.window.y1)},
            std::max(a.first, b.first),
            std::min(a.last, b.last)};
}

SampleBox bounds(std::span<const SampleBox> boxes) {
    if (boxes.empty()) return {};
    SampleBox all = boxes.front();
    for (const SampleBox& b : boxes) {
        all.window = {std::min(all.window.x0, b.window.x0), std::min(all.window.y0, b.window.y0),
                      std::max(all.window.x1, b.window.x1), std::max(all.window.y1, b.window.y1)};
        all.first = std::min(all.first, b.first), all.last = std::max(all.last, b.last);
    }
    return all;
}

std::optional<std::pair<std::size_t, std::size_t>> overlap(std::span<const SampleBox> boxes) {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (std::size_t j = 0; j < i; ++j)
            if (!is_empty(intersection(boxes[i], boxes[j]))) return std::pair(j, i);
    }
    return std::nullopt;
}

std::vector<SampleBox> missing(const SampleBox& whole, std::span<const SampleBox> parts) {
    std::vector<SampleBox> holes{whole};
    for (const SampleBox& part : parts) {
        std::vector<SampleBox> left;
        for (const SampleBox& hole : holes) {
            const SampleBox common = intersection(hole, part);
            if (is_empty(common))
                left.push_back(hole);
            else
                cut(hole, common, left);
        }
        holes = std::move(left);
    }
    return holes;
}

}  // namespace tessera
