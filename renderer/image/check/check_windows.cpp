#include <fmt/format.h>

#include "renderer/image/check/check_header.h"

namespace tessera {
namespace {

std::string text(const RawBox& b) {
    return fmt::format("{}x{} from {},{}", b.width(), b.height(), b.x0, b.y0);
}

std::string where(const RawExr& file, std::size_t part) {
    return file.parts.size() > 1 ? fmt::format("part {} '{}'", part, file.parts[part].name)
                                 : "file";
}

bool touch(const RawBox& a, const RawBox& b) {
    return a.x0 < b.x1 && b.x0 < a.x1 && a.y0 < b.y1 && b.y0 < a.y1;
}

}  // namespace

void check_windows(const RawExr& file, ExrFindings& out) {
    for (std::size_t i = 0; i < file.parts.size(); ++i) {
        const RawPart& part = file.parts[i];
        if (!part.data.sane() || !part.display.sane()) {
            out.push_back({ExrRule::bad_window, where(file, i),
                           "data " + text(part.data) + ", display " + text(part.display)});
            continue;
        }
        if (part.missing > 0)
            out.push_back({ExrRule::truncated, where(file, i),
                           fmt::format("{} of {} chunks are missing", part.missing, part.chunks)});
        if (!touch(part.data, part.display)) {
            out.push_back({ExrRule::window_outside_frame, where(file, i),
                           "data " + text(part.data) + ", display " + text(part.display)});
        } else if (part.data != part.display) {
            out.push_back({ExrRule::window_offset, where(file, i),
                           "data " + text(part.data) + ", display " + text(part.display)});
        }
        const RawPart& first = file.parts[0];
        if (part.data != first.data || part.display != first.display)
            out.push_back({ExrRule::unequal_parts, where(file, i),
                           "data " + text(part.data) + ", the first part's " + text(first.data)});
    }
}

}  // namespace tessera
