#pragma once
// Which channels go to which part of which file, with which codec; decided before a byte is
// written.

#include <string>
#include <utility>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/image/exr_strip.h"

namespace tessera {

/// One part: channels with one codec.
struct ExrPart {
    std::string name;  // of a multi-part file's part
    ExrCompression compression = ExrCompression::zip;
    std::vector<ExrChannel> channels;
};

struct ExrFile {
    std::string path;
    std::vector<ExrPart> parts;
    std::vector<std::pair<std::string, MetadataValue>> metadata;  // beside the image's
};

inline bool is_lossy(ExrCompression c) {
    return c == ExrCompression::dwaa || c == ExrCompression::dwab;
}

/// What a layer is called as a part or a file: "beauty" and the channel ("Z") for those of the
/// root.
std::string pass_name(const Layer& layer);

/// Channels point into the image. Names are not checked. Throws Error(usage) for options that
/// exclude each other.
std::vector<ExrFile> plan_exr(const LayeredImage& image, const std::string& path,
                              const WriteOptions& options);

}  // namespace tessera
