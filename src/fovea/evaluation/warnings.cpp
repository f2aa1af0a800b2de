#include "fovea/evaluation/warnings.h"

#include <fmt/format.h>

namespace fovea {
namespace {

// Bounds between honest maps of the sample and of simulated drives, and such maps with a trick
// (docs/method.md 7 gives the figures).
constexpr double kSameShare = 0.3;     // nearest points within 2 mm
constexpr double kCoverage = 0.9;      // within 20 cm
constexpr double kEdgeCoverage = 0.7;  // at edges of depth over elsewhere
constexpr double kShiftPixels = 3;
constexpr double kBleeding = 3;       // TE at edges over elsewhere
constexpr double kThickness = 0.035;  // m
constexpr double kFreeSpace = 0.1;
constexpr double kSharpness = 0.6;
constexpr double kDetail = 0.25;
constexpr double kStrayTimes = 3, kStrayMetres = 0.05;

}  // namespace

std::vector<std::string> warnings(const EvaluationReport& report) {
  std::vector<std::string> found;
  if (!scores_held_out(report.protocol)) return found;
  const auto warn = [&](bool holds, std::string text) {
    if (holds) found.push_back(std::move(text));  // comparisons with NaN never hold
  };
  warn(report.share_within_2mm > kSameShare,
       fmt::format("{:.0f}% of the scored points have a map point within 2 mm: the map seems to "
                   "hold the scored scans themselves",
                   100 * report.share_within_2mm));
  warn(
      report.figures.coverage_20cm < kCoverage,
      fmt::format("{:.0f}% of the scored points have no map point within 20 cm: the map has holes, "
                  "and colours say little there",
                  100 * (1 - report.figures.coverage_20cm)));
  const BleedingFigures& bleeding = report.bleeding;
  warn(bleeding.coverage_5cm_edges < kEdgeCoverage * bleeding.coverage_5cm_elsewhere,
       fmt::format("coverage within 5 cm is {:.2f} at edges of depth and {:.2f} elsewhere: hard "
                   "points seem to have been dropped",
                   bleeding.coverage_5cm_edges, bleeding.coverage_5cm_elsewhere));
  warn(bleeding.te_edges > kBleeding * bleeding.te_elsewhere,
       fmt::format("TE is {:.1f} at edges of depth and {:.1f} elsewhere: colours bleed over edges",
                   bleeding.te_edges, bleeding.te_elsewhere));
  const Eigen::Vector2i shift = report.shift.best();
  warn(report.colored && shift.cast<double>().norm() >= kShiftPixels,
       fmt::format("the texture lies ({}, {}) pixels beside the photographs", -shift.x(),
                   -shift.y()));
  warn(report.thickness.thickness > kThickness,
       fmt::format("flat surfaces are {:.1f} cm thick (RMS): noise on positions brings points "
                   "nearer and flatters ME and coverage",
                   100 * report.thickness.thickness));
  warn(report.free_space.share() > kFreeSpace,
       fmt::format("{:.0f}% of the map points stand in space that scans saw through",
                   100 * report.free_space.share()));
  warn(report.gradients.sharpness() < kSharpness,
       fmt::format("sharpness is {:.2f}: blur flatters TE", report.gradients.sharpness()));
  warn(report.gradients.detail() < kDetail,
       fmt::format("the map repeats {:.0f}% of the photographs' detail: its colours are blurred, "
                   "coarse or out of place, and blur flatters TE",
                   100 * report.gradients.detail()));
  const PoseStray& stray = report.stray;
  warn(stray.scored > kStrayMetres && stray.scored > kStrayTimes * stray.mapped,
       fmt::format("poses of scored frames stray {:.2f} m from the navigation's course, those of "
                   "mapped frames {:.2f} m: they seem to come from elsewhere",
                   stray.scored, stray.mapped));
  return found;
}

}  // namespace fovea
