// What `fovea localize` does alike for a drive and for a running robot.
#pragma once

#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "app/drive_arguments.h"
#include "fovea/city/city.h"
#include "fovea/core/output_file.h"
#include "fovea/drive/command_files.h"
#include "fovea/localization/localize_frames.h"
#include "fovea/localization/surface_source.h"
#include "fovea/map/map_store.h"

namespace fovea::app {

/// Values of --guess that are no file.
inline constexpr const char* kNavigationGuess = "navigation";
inline constexpr const char* kFirstGuess = "first";

/// The command line of `fovea localize`, as typed.
struct LocalizeArguments {
  DriveArguments drive;
  std::string map, output, guess, only, report;
  std::vector<std::string> truths;
  int threads = 0;
  bool force = false, quiet = false;
};

/// A map or a city.
struct Place {
  std::optional<City> city;
  std::optional<MapReader> map;
  std::optional<GeodeticPoint> origin;  ///< of its local frame

  std::unique_ptr<SurfaceSource> surfaces() const;
};

Place open_place(const std::string& path);

CommandFiles files_of(const LocalizeArguments& arguments);

/// The object `localize` of the report, without warnings.
nlohmann::ordered_json to_json(const LocalizedDrive& localized, const std::string& guess);

/// Warnings of frames without a pose.
Messages missing_poses(const LocalizedDrive& localized);

/// InputError if there is no pose: a pose file without any pose is none.
void require_poses(const LocalizedDrive& localized, const LocalizeArguments& arguments);

/// Writes a line for each frame of [begin, end), or a table.
void write_poses(const LocalizedDrive& localized, int begin, int end,
                 const LocalizeArguments& arguments, OutputFile& output);

void print_summary(const LocalizeArguments& arguments, const LocalizedDrive& localized);

}  // namespace fovea::app
