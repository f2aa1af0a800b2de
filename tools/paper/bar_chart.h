// Bar charts as SVG, for reports.
#pragma once

#include <string>
#include <vector>

namespace fovea::paper {

struct BarSeries {
  std::string name;
  std::vector<double> values;  ///< one a group; NaN: no bar
};

struct BarChart {
  std::string title, y_label;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
  /// Bars higher than this many times the median bar are cut off and their value is written on
  /// them.
  double cut = 6;
};

/// A picture of the chart, with its own colours, for pages light or dark. std::invalid_argument if
/// a series has not one value a group.
std::string to_svg(const BarChart& chart);

}  // namespace fovea::paper
