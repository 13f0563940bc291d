#pragma once
// The picture after each pass, for whoever wants to see how it came about: `--passes DIR`.

#include <functional>
#include <string>

#include "renderer/api/render.h"

namespace tessera {

class PassFiles {
public:
    using Describe = std::function<void(RenderResult&)>;  // completes the header

    /// Makes the folder. Throws Error(output).
    PassFiles(std::string folder, Describe describe);

    /// Writes FOLDER/000016.exr (floats) and 000016.json (statistics) after 16 samples of each
    /// pixel, unless that is less than a quarter more than what was written last. Throws
    /// Error(output).
    void write(RenderResult&& result);

private:
    std::string folder_;
    Describe describe_;
    int last_spp_ = 0;
};

/// Whole or not at all. Throws Error(output).
void write_text_file(const std::string& text, const std::string& path);

}  // namespace tessera
