#include "tools/paper/row_table.h"

#include <fmt/format.h>

#include <cmath>

namespace fovea::paper {

namespace {
using Json = nlohmann::ordered_json;
}  // namespace

double figure(const Json& row, const std::string& path) {
  const Json::json_pointer pointer(path);
  if (!row.contains(pointer)) return kNoFigure;
  const Json& value = row.at(pointer);
  return value.is_number() ? value.get<double>() : kNoFigure;
}

std::string cell(double value, int digits) {
  return std::isfinite(value) ? fmt::format("{:.{}f}", value, digits) : "-";
}

std::vector<Column> held_out_columns() {
  return {{"ME m", "/held_out/held_out/me_mean", 4},
          {"TE", "/held_out/held_out/te_mean", 2},
          {"median", "/held_out/held_out/te_median", 1},
          {"within 20", "/held_out/held_out/te_within_20", 3},
          {"TE, fitted gain", "/held_out/held_out/te_gain_mean", 2},
          {"MTME", "/held_out/held_out/mtme", 3},
          {"cover 5 cm", "/held_out/held_out/coverage_5cm", 3},
          {"cover 20 cm", "/held_out/held_out/coverage_20cm", 3},
          {"violations", "/held_out/held_out/free_space_violations", 4},
          {"sharpness", "/held_out/held_out/sharpness", 2},
          {"points M", "/held_out/map/points", 2, 1e-6},
          {"frame ms p50", "/held_out/map/latency_ms/frame/p50", 0},
          {"p95", "/held_out/map/latency_ms/frame/p95", 0}};
}

std::string row_table(const std::vector<const Json*>& rows, const std::vector<Column>& columns) {
  std::string text = "| row |", line = "| --- |";
  for (const Column& column : columns) {
    text += fmt::format(" {} |", column.title);
    line += " --- |";
  }
  text += fmt::format("\n{}\n", line);
  for (const Json* row : rows) {
    text += fmt::format("| {} |", row->at("row").get<std::string>());
    for (const Column& column : columns) {
      text += fmt::format(" {} |", cell(column.factor * figure(*row, column.path), column.digits));
    }
    text += "\n";
  }
  return text;
}

}  // namespace fovea::paper
