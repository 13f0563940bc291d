#pragma once
// How the picture is written: the options, laid over the scene's [output] and overscan.

#include <optional>
#include <string>

#include "renderer/api/image.h"
#include "renderer/cli/command_line.h"

namespace tessera {

struct OutputOptions {
    std::string exr, compression, overscan;
    std::optional<double> dwa_level;
    bool all_float = false, crop_pad = false, deterministic = false;

    void add_to(Command app);
    /// Those that say nothing of what is rendered.
    void add_format_to(Command app);
    /// Throws Error(usage) for what excludes each other. SOURCE_DATE_EPOCH in the environment
    /// asks for deterministic metadata.
    void apply(SceneDesc& scene) const;
};

WriteOptions write_options(const OutputDesc& output, int threads);

/// Throws Error(usage) if the passes asked for cannot go into one part of a lossy codec: found
/// before the render, not after.
void check_codec(const SceneDesc& scene);

}  // namespace tessera
