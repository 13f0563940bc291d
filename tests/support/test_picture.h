#pragma once
// Small pictures for tests of what is measured of them.

#include <cstdint>
#include <vector>

#include "renderer/compare/picture_view.h"

namespace tessera {

struct TestPicture {
    int width = 0, height = 0, channels = 0;
    std::vector<float> values;

    TestPicture(int w, int h, int c, float value)
        : width(w),
          height(h),
          channels(c),
          values(static_cast<std::size_t>(w) * static_cast<std::size_t>(h) *
                     static_cast<std::size_t>(c),
                 value) {}
    float& at(int x, int y, int c) {
        return values[static_cast<std::size_t>((y * width + x) * channels + c)];
    }
    PictureView view() const { return {width, height, channels, values}; }
};

/// Values between 0 and 1.
inline TestPicture noise(int width, int height, int channels, std::uint32_t seed) {
    TestPicture p(width, height, channels, 0);
    std::uint32_t state = seed * 2654435761u + 1;
    for (float& v : p.values) {
        state = state * 1664525u + 1013904223u;
        v = static_cast<float>(state >> 8) * 0x1p-24f;
    }
    return p;
}

inline TestPicture scaled(TestPicture p, float factor) {
    for (float& v : p.values) v *= factor;
    return p;
}

}  // namespace tessera
