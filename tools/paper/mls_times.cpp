#include "tools/paper/mls_times.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "fovea/core/read_file.h"
#include "fovea/errors.h"
#include "tools/paper/paper_numbers.h"

namespace fovea::paper {
namespace {

using Json = nlohmann::ordered_json;

MlsRow& row_of(MlsTimes& times, const std::string& method) {
  const auto found = std::find_if(times.rows.begin(), times.rows.end(),
                                  [&](const MlsRow& row) { return row.method == method; });
  if (found != times.rows.end()) return *found;
  return times.rows.emplace_back(MlsRow{method, {}});
}

MlsTimes times_of(const Json& json) {
  MlsTimes times{json.at("drive"), json.at("search_radius"), json.at("polynomial_order"), {}};
  const Json& columns = json.at("columns");
  const auto wanted = paper_table_1();
  if (columns.size() != wanted.size()) throw std::runtime_error("it has not the table's columns");
  for (std::size_t c = 0; c < columns.size(); ++c) {
    if (columns[c].at("points") != wanted[c].points) {
      throw std::runtime_error("it has other columns than the table");
    }
    for (const Json& result : columns[c].at("results")) {
      if (result.at("threads") != 1 || result.at("method") == "fovea") continue;
      row_of(times, result.at("method"))
          .of_columns.push_back({result.at("given"), result.at("produced"), result.at("seconds"),
                                 result.at("times_fovea")});
    }
  }
  for (const MlsRow& row : times.rows) {
    if (row.of_columns.size() != wanted.size()) throw std::runtime_error("a time is missing");
  }
  if (times.rows.empty()) throw std::runtime_error("it has no time on one thread");
  return times;
}

}  // namespace

MlsTimes read_mls_times(const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  try {
    return times_of(Json::parse(bytes));
  } catch (const std::exception& error) {
    throw InputError(fmt::format("no times of the upsampling benchmark: {}", error.what()),
                     file.string(), "write it with upsampling_bench --json");
  }
}

std::string mls_rows(const MlsTimes& times) {
  std::string text;
  for (const MlsRow& row : times.rows) {
    text += fmt::format("\n| PCL's MLS, {}, {} |", row.method, times.drive);
    for (const MlsTime& t : row.of_columns) text += fmt::format(" {:.1f} |", 1000 * t.seconds);
    text += "\n| (given, produced, times Fovea in the same run) |";
    for (const MlsTime& t : row.of_columns) {
      text += fmt::format(" {}, {}, {:.1f} |", t.given, t.produced, t.times_fovea);
    }
  }
  return text;
}

}  // namespace fovea::paper
