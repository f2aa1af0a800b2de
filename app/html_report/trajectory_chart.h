// The drive from above.
#pragma once

#include <string>
#include <vector>

#include "app/html_report/color_classes.h"
#include "fovea/evaluation/report.h"
#include "fovea/map/frame_record.h"

namespace fovea::app {

/// What is drawn of a drive; places in m, x to the right, y upwards.
struct GroundTrack {
  std::vector<Eigen::Vector2d> line, dashed;
  struct Spot {
    int frame = 0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();
    double value = 0;  ///< gives its class
    std::string hint;
  };
  std::vector<Spot> spots;
  bool north_up = false;  ///< said in the picture
};

/// To scale; empty for a line of fewer than two places.
std::string ground_track_chart(const GroundTrack& track, const ErrorScale& scale);

/// The refined poses as a line, the navigation's dashed, the scored frames as marks in the class of
/// their mean TE (over cameras). Empty for fewer than two frames.
/// @param north_up  whether the local frame is east-north-up, to be said in the picture
std::string trajectory_chart(const std::vector<FrameRecord>& frames, const EvaluationReport& report,
                             bool north_up);

}  // namespace fovea::app
