#pragma once
// What the errors of a scene are measured against.

#include <atomic>
#include <optional>
#include <string>

#include "renderer/cli/converge_plan.h"
#include "renderer/converge/record.h"

namespace tessera {

/// The seed of references that are rendered here; no run should have it.
inline constexpr std::uint64_t kReferenceSeed = 0x7e55e7a;

/// Renders the scene's reference to FOLDER/NAME.exr unless what lies there is that very picture;
/// none if there is to be none, or if it was stopped. Throws Error(scene).
std::optional<ConvergeReference> obtain_reference(
    const PlannedScene& scene, const ConvergeOptions& options, const std::string& program,
    const std::string& folder, const std::string& file_name, const std::atomic<bool>& stop);

}  // namespace tessera
