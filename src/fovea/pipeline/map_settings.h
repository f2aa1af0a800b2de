// All settings of a map.
#pragma once

#include <string_view>
#include <variant>

#include "fovea/pipeline/mapper_options.h"
#include "fovea/pipeline/paper_options.h"

namespace fovea {

/// Options of a run over a drive, for both mappers.
struct RunOptions {
  double max_damaged_share = 0.5;  ///< of a drive's frames, 0 to 1
  bool check_calibration = true;   ///< by edges of a few frames (pipeline/calibration_check.h)
  double range_image_spacing = 5;  ///< m (pipeline/keyframe_recorder.h); 0: no keyframes
};

struct MapSettings {
  RunOptions run;
  std::variant<MapperOptions, PaperOptions> method;

  MapSettings() = default;
  /// Default method.
  MapSettings(const MapperOptions& options) : method(options) {}  // NOLINT: converts on purpose
  /// Paper method; the calibration is not checked, and there are no keyframes.
  MapSettings(const PaperOptions& options) : method(options) {  // NOLINT: converts on purpose
    run.check_calibration = false;
    run.range_image_spacing = 0;
  }

  bool is_paper() const { return std::holds_alternative<PaperOptions>(method); }
  /// Throws std::bad_variant_access if the other method is set.
  MapperOptions& mapper() { return std::get<MapperOptions>(method); }
  const MapperOptions& mapper() const { return std::get<MapperOptions>(method); }
  PaperOptions& paper() { return std::get<PaperOptions>(method); }
  const PaperOptions& paper() const { return std::get<PaperOptions>(method); }

  double tile_size() const { return is_paper() ? paper().tile_size : mapper().tile_size; }
  const FovealOptions& foveal() const { return is_paper() ? paper().foveal : mapper().foveal; }
  /// Edge of the cells of the map's grid, m; 0: the paper's method has none.
  double spacing() const { return is_paper() ? 0 : mapper().surface.spacing; }
  /// False only for baselines, which map whole scans.
  bool has_foveal_region() const { return !is_paper() || paper().foveal_enabled; }
  /// Whether sweep motion is undone where scans are raw.
  bool compensates_motion() const { return is_paper() || mapper().compensate_motion; }
};

/// Settings of the paper's method for a row of Table II (apply_variant); other options stay.
MapSettings with_variant(std::string_view name, const MapSettings& settings);

}  // namespace fovea
