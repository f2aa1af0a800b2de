// Arguments that several subcommands share.
#pragma once

#include <CLI/App.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/drive/hold_out.h"

namespace fovea::app {

/// Value of --cameras for the scans alone.
inline constexpr const char* kNoCameras = "none";

/// The drive and what of it is wanted, as typed.
struct DriveArguments {
  std::string drive, frames, cameras;
  std::vector<std::string> masks;  ///< "K=FILE"
  bool no_navigation = false, no_imu = false;

  /// Opens the drive. CLI::ValidationError (wrong usage) for a malformed range or camera list.
  std::unique_ptr<FrameSource> open(bool use_navigation = true) const;
  DriveOptions options() const;
};

/// --mask of a command that takes colors from the images of a drive.
void add_mask_option(CLI::App& command, DriveArguments& arguments);

/// "2,3" -> {2, 3}; CLI::ValidationError otherwise.
std::vector<int> parse_cameras(const std::string& text);

/// HoldOut::parse, whose error on a command line is wrong usage of `option`: CLI::ValidationError.
HoldOut parse_frame_set(const std::string& spec, const std::string& option);
HoldOut parse_hold_out(const std::string& spec);

}  // namespace fovea::app
