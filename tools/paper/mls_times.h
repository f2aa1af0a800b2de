// What bench/upsampling_bench measured: PCL's moving least squares for the paper's Table I.
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace fovea::paper {

struct MlsTime {
  std::size_t given = 0, produced = 0;
  double seconds = 0;      ///< median of the runs
  double times_fovea = 0;  ///< over that of Fovea's upsampling in the same run
};

/// One way to sample the surfaces, on one thread.
struct MlsRow {
  std::string method;               ///< "local plane", "uniform density"
  std::vector<MlsTime> of_columns;  ///< one a column of Table I
};

struct MlsTimes {
  std::string drive;
  double search_radius = 0;  ///< m
  int polynomial_order = 0;
  std::vector<MlsRow> rows;
};

/// InputError, which names the file, if it is not what the benchmark's --json writes.
MlsTimes read_mls_times(const std::filesystem::path& file);

/// Rows of Table I with their remarks, in Markdown.
std::string mls_rows(const MlsTimes& times);

}  // namespace fovea::paper
