#pragma once
// All runs of one scene of `tessera converge`.

#include <atomic>
#include <string>
#include <vector>

#include "renderer/cli/converge_plan.h"
#include "renderer/converge/record.h"

namespace tessera {

/// A scene that was read: what its references and pictures must fit.
struct CheckedScene {
    int width = 0, height = 0;
    std::vector<std::uint64_t> seeds;  // by file
};

/// Reads all files of a scene by all settings. Throws Error for what is wrong with the scene
/// itself, Error(usage) for a --vary or --set that it cannot have, Error(scene) for a picture that
/// does not fit it.
CheckedScene check_scene(const PlannedScene& scene, const ConvergePlan& plan,
                         const ConvergeOptions& options);

/// Renders and measures; what fails is in the record, and in failures.
class SceneRuns {
public:
    SceneRuns(const PlannedScene& scene, const CheckedScene& checked, const ConvergePlan& plan,
              const ConvergeOptions& options, const std::vector<bool>& passes,
              const std::atomic<bool>& stop)
        : scene_(scene),
          checked_(checked),
          plan_(plan),
          options_(options),
          passes_(passes),
          stop_(stop) {}

    /// work: an empty folder to leave things in.
    ConvergeScene run(const std::string& work, std::vector<std::string>& failures);

private:
    struct Kept;  // the pictures of a series' first run, until it is known which is shown

    void run_series(const Combination& c, std::vector<Kept>& kept,
                    std::vector<std::string>& failures);
    void measure_run(ConvergeRun& run, const std::vector<std::string>& files);
    void keep_picture(ConvergeRun& run, const std::string& file, int seed_number);
    void show(const std::vector<Kept>& kept);
    void add_pictures(std::vector<std::string>& failures);
    ShownPicture shown(const std::string& file) const;

    const PlannedScene& scene_;
    const CheckedScene& checked_;
    const ConvergePlan& plan_;
    const ConvergeOptions& options_;
    const std::vector<bool>& passes_;  // by build
    const std::atomic<bool>& stop_;
    std::string work_;
    ConvergeScene out_;
};

}  // namespace tessera
