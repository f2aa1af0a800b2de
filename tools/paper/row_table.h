// Rows' figures as a Markdown table.
#pragma once

#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace fovea::paper {

inline constexpr double kNoFigure = std::numeric_limits<double>::quiet_NaN();

/// A figure of a row by its path ("/held_out/held_out/te_mean"); kNoFigure where there is none.
double figure(const nlohmann::ordered_json& row, const std::string& path);

/// A number, or "-" for kNoFigure.
std::string cell(double value, int digits);

struct Column {
  const char* title;
  const char* path;  ///< of the row's JSON
  int digits;
  double factor = 1;
};

/// What is asked of every map together (no single figure is a win).
std::vector<Column> held_out_columns();

std::string row_table(const std::vector<const nlohmann::ordered_json*>& rows,
                      const std::vector<Column>& columns);

}  // namespace fovea::paper
