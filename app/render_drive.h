// fovea render --poses: a drive that nobody has driven.
#pragma once

#include <string>

#include "app/warnings.h"
#include "fovea/map/color_display.h"

namespace fovea::app {

struct RenderDriveArguments {
  std::string map, output;
  std::string poses;    ///< file of T_local_lidar
  std::string drive;    ///< whose cameras "calib" are, or empty
  std::string camera;   ///< empty: none, or the drive's; "calib", six numbers, or a calibration
  std::string cameras;  ///< of that calibration: numbers, or empty: all
  std::string lidar;    ///< empty: none; its name
  ExposureChoice exposure;
  double rate = 10;   ///< frames a second
  double reach = 80;  ///< m
  int threads = 0;
  bool force = false, quiet = false, foreign = false;
};

void render_drive_command(const RenderDriveArguments& arguments, Warnings& warnings);

}  // namespace fovea::app
