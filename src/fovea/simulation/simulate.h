// Simulates a drive: a scene, a vehicle that drives through it, and all that its sensors record.
#pragma once

#include <filesystem>
#include <functional>

#include "fovea/simulation/simulation_options.h"

namespace fovea {

/// Called after each frame with the number done and that of all; returns false to stop.
using SimulationProgress = std::function<bool(int done, int total)>;

/// Writes a drive with its truth (docs/simulator.md) below `root`. The same options give the same
/// bytes at any number of threads. OutputError as SimulationWriter; ConfigError for options out of
/// range.
/// @return the drive's folder; empty if it was stopped, and then nothing is left
std::filesystem::path simulate(const SimulationOptions& options, const std::filesystem::path& root,
                               const SimulationProgress& progress = {});

}  // namespace fovea
