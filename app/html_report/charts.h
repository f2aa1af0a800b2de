// Charts as SVG that stands inside a page and takes its colours from it: classes s0, s1, ... are
// series, .axis, .grid and .label the rest.
#pragma once

#include <string>
#include <vector>

namespace fovea::app {

struct Series {
  std::string name;
  std::vector<double> values;  ///< one an x; NaN: none there
};

struct Chart {
  std::string title;  ///< read aloud instead of the picture
  std::string x_label, y_label;
  std::vector<double> x;  ///< increasing
  std::vector<Series> series;
  double line_at = 0;     ///< a dashed level with `line_name`; 0: none
  std::string line_name;  ///< stands on it
  std::string x_name;     ///< what an x is, for hints: "frame"
  std::string unit;       ///< of values in hints
};

/// Lines with a mark at every value; gaps where there is none. std::invalid_argument if a series
/// has not one value an x. A chart without any value is an empty string.
std::string line_chart(const Chart& chart);

/// The series on top of each other as areas, the first one lowest; missing values count 0.
std::string stacked_chart(const Chart& chart);

/// Shares of `counts` as bars, bin after bin of `width`. The bins beyond 99% are drawn as one.
struct Histogram {
  std::string title, x_label;
  std::vector<std::size_t> counts;
  double width = 1;
  double mean = 0, median = 0;  ///< marked
};
std::string histogram_chart(const Histogram& histogram);

/// The smallest round step (1, 2 or 5 times a power of ten) that `range` holds at most `most`
/// times; 1 for a range of nothing.
double round_step(double range, int most);

}  // namespace fovea::app
