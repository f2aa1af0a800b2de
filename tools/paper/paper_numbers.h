// What the paper published, to stand beside what we measure.
#pragma once

#include <array>
#include <span>
#include <string_view>

namespace fovea::paper {

/// A row of the paper's Table II on one KITTI sequence.
struct PaperScore {
  double me_mean, me_std;  ///< m
  double te_mean, te_std;  ///< 0-441
  double mtme;
  double scan_matching;  ///< m, from its bar chart
  double time;           ///< s, from its bar chart: registration of the whole sequence
};

struct PaperRow {
  std::string_view name;  ///< as variant_names()
  PaperScore seq_0095, seq_0001;
};
std::span<const PaperRow> paper_table_2();

/// The paper's Table I: time to upsample to so many points (s), theirs and that of moving least
/// squares.
struct PaperUpsampling {
  int points;
  double proposed, mls;
};
std::span<const PaperUpsampling> paper_table_1();

}  // namespace fovea::paper
