#pragma once
// Finds out before the render whether its results can be written.

#include <string>
#include <vector>

#include "renderer/api/scene_desc.h"

namespace tessera {

/// One file that a render will write.
struct OutputFile {
    std::string path;
    const char* option;                   // "--output"
    std::vector<std::string> extensions;  // lower case; empty: any
};

/// Throws Error(usage) for an ending that the option does not write and for two outputs of one
/// name, Error(output) where a file cannot be created. Empty paths are skipped.
void check_outputs(const std::vector<OutputFile>& outputs);

/// The same for the files that a split picture's passes could go to: FILE.*.exr, or <aov> in the
/// name being anything.
void check_split_spares(const OutputFile& output, const SceneDesc& scene);

/// Throws Error(usage) if an output would replace a file that the scene is read from.
void check_outputs_spare(const std::vector<OutputFile>& outputs, const SceneDesc& scene);

}  // namespace tessera
