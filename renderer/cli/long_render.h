#pragma once
// Options of renders in more than one run: checkpoints, resume, ranges of samples.

#include <optional>
#include <string>
#include <vector>

#include "renderer/cli/command_line.h"
#include "renderer/cli/output_check.h"

namespace tessera {

struct LongRenderOptions {
    std::string checkpoint, resume, samples;
    double checkpoint_s = 0;  // 0: not asked for
    int first_sample = 0;     // from --samples, once apply() is through

    void add_to(Command app);
    /// Reads --samples into first_sample and spp (which --spp must not have set), checks what
    /// --resume and --checkpoint name. Throws Error(usage), Error(scene) for a file to resume from
    /// that is no good. output: where -o goes.
    void apply(std::optional<int>& spp, const std::string& output);
    /// The files that it adds to a render's outputs.
    std::vector<OutputFile> outputs(const std::string& output) const;
};

}  // namespace tessera
