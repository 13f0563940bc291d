#pragma once
// Describe -> build -> render -> write. See docs/architecture.md.

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "renderer/api/deep.h"
#include "renderer/api/image.h"
#include "renderer/api/picture_error.h"
#include "renderer/api/scene_desc.h"

namespace tessera {

/// Why a sample, ray or contribution was dropped.
enum class InvalidCause : int {
    camera_ray,  // the camera made a ray with a non-finite component
    bounce_ray,  // a continued path did
    shadow_ray,
    hit,       // a hit with non-finite position or normal
    radiance,  // a non-finite or negative sample value
    count,
};
inline constexpr int kInvalidCauses = static_cast<int>(InvalidCause::count);

/// Names as in the statistics file.
const char* to_string(InvalidCause cause);

struct RayCounts {
    std::uint64_t camera = 0;
    std::uint64_t bounce = 0;
    std::uint64_t shadow = 0;
    std::uint64_t total() const noexcept { return camera + bounce + shadow; }
};

/// One thing that the scene did not need.
struct LeftOut {
    std::string what;  // "texture system"
    std::string why;   // "no image is read"
};

/// What a subdivided mesh became. Bounds in its own coordinates.
struct SubdivisionStatistics {
    std::string mesh;
    std::uint64_t cage_faces = 0, triangles = 0, vertices = 0;
    std::uint64_t bytes_surface = 0, bytes_dicing = 0;  // used while it was made
    std::uint64_t non_finite = 0;                       // vertices left where they were
    double seconds = 0;
    std::array<Double3, 2> before{}, after{};  // displacement
};

/// What a run did and cost. Times are wall seconds.
struct Statistics {
    std::string version, scene, kernel, isa, integrator;
    int threads = 0, tile = 0, spp = 0, width = 0, height = 0;
    int first_sample = 0;  // index of the first of each pixel
    int resumed_spp = 0;   // of spp, those of earlier runs
    double resumed_s = 0;  // that these took
    int checkpoints = 0, checkpoints_failed = 0;
    bool checkpoint_saved = false;  // the last one, with all samples
    double checkpoint_s = 0;        // for which the workers rested
    double checkpoint_every_s = 0;  // from one to the next
    std::uint64_t seed = 0;
    double load_s = 0, build_s = 0, render_s = 0, write_s = 0;
    RayCounts rays;
    std::uint64_t samples = 0;  // camera samples taken
    std::uint64_t triangles_stored = 0, triangles_instanced = 0, instances = 0, lights = 0;
    std::uint64_t memory_peak = 0;  // bytes, resident
    std::uint64_t memory_geometry = 0, memory_bvh = 0, memory_textures = 0, memory_film = 0,
                  memory_lights = 0, memory_creases = 0;
    std::uint64_t texture_limit = 0;  // bytes
    std::uint64_t textures_in_core = 0, textures_cached = 0, texture_bytes_read = 0,
                  texture_failures = 0;  // files; by the tile cache; its look-ups that gave magenta
    std::array<std::uint64_t, kInvalidCauses> invalid{};
    std::string first_invalid;  // "radiance at pixel 312,80 sample 17"
    std::uint64_t half_clamped = 0, half_non_finite = 0;
    std::vector<SubdivisionStatistics> subdivision;
    std::vector<LeftOut> left_out;
    std::vector<std::string> warnings, notes;
    bool complete = true;
    ErrorEstimate error;                  // of beauty
    std::vector<ErrorPoint> error_curve;  // of beauty
    std::optional<ErrorTarget> error_target;
    bool error_reached = false;
};

/// The statistics file (docs/stats.schema.json), as JSON text.
std::string to_json(const Statistics& stats);

/// Ready to trace; immutable, safe to share between threads.
class Scene;
using ScenePtr = std::shared_ptr<const Scene>;

struct BuildOptions {
    int threads = 0;     // as RenderSettings
    std::string kernel;  // "" = the smallest that covers the scene; "basic", "surface", "full"
    std::string isa;     // Embree's instruction set, "" = the best of this machine
    Strictness strictness = Strictness::normal;
    std::int64_t texture_memory = kTextureMemory;  // bytes: images and the tile cache together
    bool auto_tx = false;  // images that memory has no room for are made into .tx files
    std::string tx_cache;  // their folder; "": $XDG_CACHE_HOME/tessera/tx
};

/// Throws Error(scene) for what cannot be rendered, Error(memory) when memory runs out.
/// The description's large arrays are moved from.
ScenePtr build_scene(SceneDesc&& desc, const BuildOptions& options = {});

struct Progress {
    double fraction = 0;  // 0..1
    double elapsed_s = 0;
    double eta_s = 0;
    int spp = 0;                      // of the pass under way
    std::optional<ErrorPoint> error;  // the latest
};

struct RenderResult {
    LayeredImage image;
    std::optional<DeepImage> deep;  // where the settings ask for it
    Statistics stats;
    bool complete = true;  // false: not finished; the picture holds what there was
};

struct RenderSettings {
    int threads = 0;    // 0: what affinity, cgroup and Slurm allow; negative: all but that many
    int tile = 32;      // pixels, a multiple of 4
    double time_s = 0;  // > 0: passes until so many seconds are used; spp is then the upper bound
    bool deep = false;  // also beauty apart by depth
    std::optional<ErrorTarget>
        target;                  // end when it is reached, if spp and time_s are not used up before
    bool error_estimate = true;  // say how wrong the picture is; the samples do not depend on it
    bool error_causes = false;   // and what makes it so, also where the estimate is reliable
    std::function<void(const ErrorPoint&)> on_error;  // called between passes
    /// The picture after each pass; passes then end at powers of two. What this takes is in none of
    /// the times, and no part of time_s.
    std::function<void(RenderResult&&)> on_pass;
    const std::atomic<bool>* cancel = nullptr;
    std::function<void(const Progress&)> progress;  // called from one thread at a time
    /// A tile of a pass is finished: its pixels so far, to be copied. Called by several at a time.
    std::function<void(const PixelWindow&, const std::vector<Layer>&)> on_tile;
    /// Set to have the picture so far handed to on_snapshot once the tiles under way are finished;
    /// cleared then. The others wait while on_snapshot runs.
    std::atomic<bool>* snapshot = nullptr;
    std::function<void(RenderResult&&)> on_snapshot;
    int first_sample = 0;     // the scene's spp count from here; the sum below 2^24
    std::string resume;       // film file of an earlier run to go on from; "": none
    std::string checkpoint;   // film file to save to now and then, and at the end; "": none
    double checkpoint_s = 0;  // seconds between two; 0: 60, more where that costs over 1 %
    std::string film_file;    // film file to write at the end; "": none
    /// What goes wrong without ending the render: checkpoints. From any thread.
    std::function<void(const std::string&)> warn;
};

/// Never throws from the loop; Error(memory) if the film does not fit, Error(scene) if resume is no
/// film of this picture, Error(usage) if it has other samples than asked for, Error(output) if
/// film_file cannot be written.
RenderResult render(const Scene& scene, const RenderSettings& settings = {});

/// What `tessera info` shows: the statistics of a scene without a render.
Statistics describe(const Scene& scene);

}  // namespace tessera
