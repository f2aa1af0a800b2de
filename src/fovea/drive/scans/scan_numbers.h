// The numbers in the file of a scan, before their units are known.
#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fovea/core/point_formats/cloud_rows.h"
#include "fovea/drive/scans/intensity_scale.h"
#include "fovea/time.h"

namespace fovea {

/// Times of the points of a scan, in the unit of the file: twice the span of the middle half, so
/// that a quarter of the times may be wrong.
struct RawTimes {
  double middle = 0, span = 0;
  bool whole = false;  ///< whether the file has whole numbers
  bool split = false;  ///< whether the middle half lies at its two ends: no times of one sweep
  std::size_t count = 0;
};

/// All but `columns` are of the points with a return.
struct ScanNumbers {
  TimeNs stamp = 0;
  std::vector<std::string> columns;  ///< as the file names them
  std::optional<RawTimes> times;
  std::optional<double> median_range;  ///< in the unit of the file
  bool whole_coordinates = false;
  IntensityScale scale;
  double median_intensity = 0;
};

/// Gathers the numbers of a scan.
class ScanNumberRows : public CloudRows {
 public:
  explicit ScanNumberRows(TimeNs stamp) { numbers_.stamp = stamp; }

  std::span<const char* const> columns() const override;
  bool takes_whole_coordinates() const override { return true; }
  const char* description() const override;
  void describe(std::span<const std::string> names, bool organized) override;
  void begin(std::size_t points, std::span<const std::optional<Scalar>> types) override;
  void add(std::span<const double> row, std::size_t number) override;

  ScanNumbers take();

 private:
  ScanNumbers numbers_;
  bool has_times_ = false, whole_times_ = false;
  std::vector<double> times_;
  std::vector<float> ranges_, intensities_;
};

}  // namespace fovea
