// The result of a comparison with the truth, and its two forms: JSON for programs, a table for
// people. docs/simulator.md says what each figure means.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fovea/evaluation/distribution.h"
#include "fovea/evaluation/truth_surfaces.h"

namespace fovea {

/// Errors of positions (m) and rotations (degrees).
struct PoseFigures {
  Distribution position_m, rotation_deg;
};

/// Errors of a set of points' colours.
struct ColorFigures {
  Distribution raw, gain;
  double within_20 = Distribution::kNone, gain_within_20 = Distribution::kNone;  ///< shares
};

/// Whether the map has one exposure.
struct ExposureFigures {
  Distribution one_gain;  ///< errors after one gain a channel for the whole map
  /// Slope of the exposure of the map along the drive, %/km. NaN for a drive under 200 m.
  double trend_percent_per_km = Distribution::kNone;
  /// Standard deviation of the exposure from view to view, %.
  double deviation_percent = Distribution::kNone;
  double seam_p95_percent = Distribution::kNone;  ///< seams.h
};

struct UpsamplingFigures {
  Distribution error;                      ///< of interpolated points, m
  std::size_t hidden = 0;                  ///< true hits that were hidden
  double recovered = Distribution::kNone;  ///< share of these with a point within 5 cm
  std::size_t frames = 0;
};

/// One frame: pose errors under the alignment that the report uses, and what of its points moved.
struct TruthFrame {
  int frame = 0;
  double position_m = 0, rotation_deg = 0;
  /// Coloured map points that came from it, and the ghosts among them; unknown where points do not
  /// name their frame.
  std::optional<std::size_t> points, ghosts;
};

struct TruthReport {
  std::string scene;
  std::vector<int> cameras;
  bool colored = true;         ///< false: the map has no colors, and all points are scored
  bool aligned = true;         ///< trajectories laid over each other before all but `pose_absolute`
  bool georeferenced = false;  ///< the map's place on earth is known
  std::size_t map_points = 0, map_points_coloured = 0;

  PoseFigures pose_absolute;  ///< the map where its georeference says it lies
  PoseFigures pose_aligned, pose_relative;
  Distribution pose_drift_percent;  ///< over 10 m

  Distribution accuracy, accuracy_measured, accuracy_interpolated;  ///< m
  SurfaceShares shares;
  ColorFigures color_albedo, color_albedo_matte, color_view, color_view_matte;
  ExposureFigures exposure;
  std::optional<std::size_t> ghosts;  ///< unknown where points do not name their frame
  UpsamplingFigures upsampling;
  std::vector<TruthFrame> frames;
  std::vector<std::string> warnings;  ///< the caller's, of the drive
};

/// Share of the scored map points that are ghosts; NaN where that is not known.
double ghost_share(const TruthReport& report);
/// The frame whose position is farthest off, the first of equal ones; null if there is no frame.
const TruthFrame* worst_frame(const TruthReport& report);

/// JSON text, the same bytes for the same report; figures that do not exist are null.
std::string to_json(const TruthReport& report);

/// A table for the terminal, lines ending with LF.
std::string to_text(const TruthReport& report);

}  // namespace fovea
