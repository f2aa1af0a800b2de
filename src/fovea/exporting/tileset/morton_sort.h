// Sorting more points than memory holds.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "fovea/base/scratch_file.h"
#include "fovea/exporting/tileset/cube_grid.h"

namespace fovea {

/// Sorts points into Morton order by runs on disk that are merged. The file has no name, so that
/// nothing of it is left whatever happens.
class MortonSort {
 public:
  /// @param folder      where the file may lie; OutputError if it cannot be written
  /// @param run_points  sorted in memory at a time (16 bytes each)
  MortonSort(const std::filesystem::path& folder, std::size_t run_points);

  /// OutputError if the disk is full.
  void add(const CubePoint& point);
  /// Ends adding.
  void finish();
  /// The next point in order; false at the end.
  bool next(CubePoint& point);

 private:
  /// A sorted stretch of the file, and what was read of it ahead.
  struct Run {
    std::size_t begin, end;  // points of the file not yet read
    std::vector<CubePoint> buffer = {};
    std::size_t at = 0;
  };

  void write_run();
  bool refill(Run& run) const;
  auto later() const;  // the order of the heap

  std::size_t run_points_;
  ScratchFile file_;
  std::size_t written_ = 0;  // points
  std::vector<CubePoint> pending_;
  std::vector<Run> runs_;
  std::vector<std::size_t> heap_;  // of runs, the one with the first point on top
};

}  // namespace fovea
