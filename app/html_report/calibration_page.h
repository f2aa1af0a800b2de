// The page of `fovea calibrate`, DIR/calibration.html: one file that needs no network.
#pragma once

#include <string>
#include <vector>

#include "fovea/drive/frame_source.h"
#include "fovea/pipeline/drive_calibration.h"

namespace fovea::app {

struct CalibrationPage {
  std::string drive_name;
  const DriveInfo& drive;  ///< with the given calibration
  const DriveCalibration& found;
  std::vector<std::string> warnings;
  std::string output_name;  ///< the folder with the corrected drive.toml
};

/// The whole page, well-formed as XML; the same bytes for the same input.
std::string calibration_page(const CalibrationPage& page);

}  // namespace fovea::app
