#pragma once
// Every part's pixels, some lines at a time, as floats.

#include <functional>
#include <string>
#include <vector>

#include "renderer/image/check/exr_raw.h"

namespace tessera {

/// Lines y0 <= y < y1 of the parts that have the first part's data window.
struct ExrStripView {
    std::int64_t x0 = 0, y0 = 0, width = 0, height = 0;
    std::vector<std::vector<std::vector<float>>> planes;  // [part][channel][pixel]

    std::size_t pixels() const { return static_cast<std::size_t>(width * height); }
};

/// "" or why the pixels cannot be read; what was read before has been looked at. Parts that are
/// deep or of another window have no planes.
std::string for_each_strip(const std::string& path, const RawExr& file,
                           const std::function<void(const ExrStripView&)>& look);

/// Whether that takes an amount of memory and time that one may ask for.
bool fits_to_read(const RawExr& file);

}  // namespace tessera
