#pragma once
// Options that every command on a scene takes.

#include <optional>
#include <string>
#include <vector>

#include "renderer/api/render.h"
#include "renderer/cli/command_line.h"

namespace tessera {

struct SceneOptions {
    std::string scene;
    std::vector<std::string> set;
    std::vector<std::string> aovs;
    std::string camera, camera_position;
    std::string res, crop, kernel, isa;
    std::optional<int> spp, frame;
    std::optional<std::uint64_t> seed;
    int threads = 0;
    int tile = 32;
    int texture_memory = static_cast<int>(kTextureMemory >> 20);
    std::string tx_cache;
    bool auto_tx = false;
    bool strict = false, lenient = false, external = false;

    void add_to(Command app);
    /// Reads the scene and lays the options over it. Returns seconds in load_s.
    SceneDesc load(double& load_s) const;
    BuildOptions build_options() const;

private:
    Strictness strictness() const noexcept;
};

}  // namespace tessera
