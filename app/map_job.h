// What `fovea map` does alike for a drive and for a running robot.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "app/drive_arguments.h"
#include "app/session.h"
#include "fovea/drive/command_files.h"
#include "fovea/errors.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::app {

/// Values of --poses that are no file.
inline constexpr const char* kRefinedPoses = "refine";
inline constexpr const char* kNavigationPoses = "navigation";

/// The command line of `fovea map`, as typed.
struct MapArguments {
  DriveArguments drive;
  std::string output, preset = "default", config, hold_out, poses = kRefinedPoses, variant, report,
                      scratch;
  std::vector<std::string> settings;
  int threads = 0;
  double rate = 0;
  std::size_t memory = std::size_t{1} << 30;
  bool calibrate = false, resume = false, force = false, quiet = false, allow_dropped = false;
  bool if_missing = false;
  std::string live;  ///< see live_view.h
};

/// The files of the run, without the drive and files of poses.
CommandFiles files_of(const MapArguments& arguments);

/// The job, without poses and stop.
/// @throws ConfigError  for settings that are none
MapJob job_of(const MapArguments& arguments);

/// Prints notes and figures of a run.
/// @param calibration  see calibration_messages()
void print_run(const MapSummary& summary, const Messages& calibration,
               const MapArguments& arguments, Session& session);

/// Prints what an interrupted run keeps. It is an error line of a quiet run.
void print_interruption(const MapSummary& summary, const MapArguments& arguments);

/// Throws the error that is handled, with what to do with the log that the run leaves next to its
/// map, if there is one.
[[noreturn]] void rethrow_with_log_remedy(const OutputError& error, const std::string& map);

/// The result of run(), a function that maps. Its OutputError gets the remedy of
/// rethrow_with_log_remedy().
template <class Run>
MapSummary naming_log(const std::string& map, Run&& run) {
  try {
    return run();
  } catch (const OutputError& error) {
    rethrow_with_log_remedy(error, map);
  }
}

}  // namespace fovea::app
