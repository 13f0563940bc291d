#pragma once
// The pictures that `tessera compare` is given.

#include <string>
#include <vector>

#include "renderer/api/image.h"
#include "renderer/compare/compare_layer.h"

namespace tessera {

/// Layers by name; see title_of().
struct ComparedPicture {
    std::string path;
    LayeredImage image;
    bool encoded = false;  // 8 or 16 bits as a display takes them, rather than floats of light
    std::string scene_hash, seed;  // of Tessera's files

    const Layer* find(const std::string& name) const;
};

/// EXR with its layers, or PNG, JPEG, TIFF, HDR as one. Throws Error(scene) naming the file.
ComparedPicture read_compared(const std::string& path);

/// The layer of `other` that a picture's layer is compared with: of its name, or the pass that is
/// root Z in one part and depth.Z among many. Null if there is none.
const Layer* counterpart(const Layer& layer, const ComparedPicture& picture,
                         const ComparedPicture& other);

/// What people call a layer: "beauty", "Z", "N".
std::string title_of(const Layer& layer);
LayerContent content_of(const Layer& layer);
/// How a picture's colours become linear Rec. 709; empty where they are.
ToLight to_light(const ComparedPicture& picture);

/// The files of one side: one name, several with commas between them, or a pattern with * ? []. A
/// file of that very name comes first. Throws Error(scene) for a pattern that nothing matches,
/// Error(usage) for a file that is there twice.
std::vector<std::string> expand_files(const std::string& text);

}  // namespace tessera
