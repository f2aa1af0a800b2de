// The result of an evaluation, and its two forms: JSON for programs, a table for people.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/evaluation/color_rules_report.h"
#include "fovea/evaluation/consistency.h"
#include "fovea/evaluation/error_split.h"
#include "fovea/evaluation/far_field.h"
#include "fovea/evaluation/free_space.h"
#include "fovea/evaluation/map_geometry.h"
#include "fovea/evaluation/metrics.h"
#include "fovea/evaluation/picture_quality.h"
#include "fovea/evaluation/pose_stray.h"
#include "fovea/evaluation/protocol.h"
#include "fovea/evaluation/rule_errors.h"
#include "fovea/evaluation/set_figures.h"
#include "fovea/evaluation/sharpness.h"

namespace fovea {

/// Figures of one scored camera at one frame.
struct ViewReport {
  int frame = 0;
  int camera = 0;
  ErrorFigures figures;
  Eigen::Vector3f gains = Eigen::Vector3f::Ones();  ///< fitted, see fit_gains
  GradientSums gradients;
  RoughnessSums roughness = {};
  PictureSums pictures = {};
  ShiftSums shift = {};
  FarField far_field = {};
};

/// A selected frame that the drive could not give.
struct UnscoredFrame {
  int index = 0;
  std::string reason;
};

/// A scored camera of a scored frame that has no image which can be read.
struct UnscoredView {
  int frame = 0, camera = 0;
};

/// Figures of the points outside moved boxes, against map points outside them.
struct MovingReport {
  std::size_t labelled = 0, moved = 0;  ///< boxes
  std::size_t map_points_left_out = 0;
  SetFigures set;
};

/// Figures of one block of held-out frames.
struct BlockReport {
  int first = 0, last = 0;  ///< frame indices
  ErrorFigures figures;
};

/// Figures of the visible points within 5 pixels of an edge of depth (see ScanProjection) and of
/// the others: colours of a foreground that bleed onto what lies behind it show here.
struct BleedingFigures {
  std::size_t points_edges = 0;
  /// With the fitted gain of the view.
  double te_edges = ErrorFigures::kNone, te_elsewhere = ErrorFigures::kNone;
  double coverage_5cm_edges = ErrorFigures::kNone, coverage_5cm_elsewhere = ErrorFigures::kNone;

  /// How much larger TE is at edges, as a share.
  double excess() const { return te_edges / te_elsewhere - 1; }
};

/// Width of the bins of EvaluationReport::te_histogram.
inline constexpr float kTeBin = 4;

struct EvaluationReport {
  Protocol protocol = Protocol::kHeldOut;
  std::vector<int> cameras;  ///< scored; empty where the map has no colors
  bool colored = true;       ///< false: the map has no colors, and figures of colors are absent
  /// Whose calibration the points were projected by: "drive", or a map that corrected it.
  std::string calibration = "drive";
  ErrorFigures figures;     ///< of all evaluated points, against coloured map points only
  MeanIntervals intervals;  ///< of `figures`
  /// All evaluated points by TE: [0, kTeBin), [kTeBin, 2 kTeBin), ...; not part of the JSON.
  std::vector<std::size_t> te_histogram;
  /// Of the points that the scored camera can see, see ScanProjection::hidden; the others' colours
  /// are those of what stands before them.
  SetFigures visible;
  std::optional<MovingReport> without_moving;  ///< where the drive has tracklets
  std::vector<BlockReport> blocks;  ///< where held-out frames follow each other, else empty
  std::size_t unreached = 0;  ///< points left out with blocks: no training frame could see them
  BleedingFigures bleeding;
  ErrorSplit split;
  ErrorsByRule by_rule{};  ///< all zero where the map does not say
  RoughnessSums roughness;
  CrossViewTest::Result cross_view;
  PlaneThickness thickness;
  ScanScores scan_scores;
  PictureSums pictures;
  ShiftSums shift;
  FarField far_field;
  double share_within_2mm = ErrorFigures::kNone;  ///< of the points, of a map point
  PoseStray stray;
  std::vector<std::string> warnings;  ///< see warnings.h
  /// Share of the coloured map points that were made by upsampling; NaN where the map does not say.
  double map_share_interpolated = ErrorFigures::kNone;
  /// Nearest neighbours among ALL map points, uncoloured ones counting as black: the only way to
  /// the TE of 150 that the paper gives for its baselines.
  ErrorFigures paper_like;
  FreeSpaceTest::Result free_space;
  GradientSums gradients;
  double density_per_m2 = 0;  ///< see surface_density
  std::size_t map_points = 0, map_points_coloured = 0;
  std::size_t frames = 0;         ///< scored
  std::vector<ViewReport> views;  ///< by frame, then camera
  std::vector<UnscoredFrame> skipped;
  std::vector<UnscoredView> images_missing;  ///< of frames that other cameras score
  std::vector<ColorRuleScore> color_rules;   ///< empty unless asked for, see compare_color_rules
};

/// The view with the highest mean TE, the first of equal ones; null if none has a point.
const ViewReport* worst_view(const EvaluationReport& report);

/// JSON text, the same bytes for the same report; figures that do not exist (no point, no pixel)
/// are null.
std::string to_json(const EvaluationReport& report);

/// A table for the terminal, lines ending with LF.
std::string to_text(const EvaluationReport& report);

}  // namespace fovea
