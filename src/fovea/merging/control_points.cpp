#include "fovea/merging/control_points.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

#include "fovea/core/input_file.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

constexpr std::array<const char*, 10> kColumns{"name",  "role", "latitude", "longitude", "height",
                                               "sigma", "map",  "x",        "y",         "z"};
enum Column { kName, kRole, kLatitude, kLongitude, kHeight, kSigma, kMap, kX, kY, kZ };
using Cells = std::vector<std::string>;

std::string trimmed(std::string_view text) {
  const auto begin = text.find_first_not_of(" \t\r");
  if (begin == std::string_view::npos) return "";
  return std::string(text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1));
}

Cells cells_of(const std::string& line) {
  Cells cells;
  for (std::size_t begin = 0; begin <= line.size();) {
    const std::size_t end = std::min(line.find(',', begin), line.size());
    cells.push_back(trimmed(std::string_view(line).substr(begin, end - begin)));
    begin = end + 1;
  }
  return cells;
}

double number_of(const std::string& cell, const char* column) {
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(value)) {
    throw std::invalid_argument(fmt::format("{} \"{}\" is no number", column, cell));
  }
  return value;
}

/// Reads a line by the columns that the first line names.
class PointLine {
 public:
  PointLine(const std::array<std::size_t, kColumns.size()>& places, const Cells& cells)
      : places_(places), cells_(cells) {}

  SurveyedPoint point() const {
    SurveyedPoint point;
    point.name = text(kName);
    const std::string role = text(kRole);
    if (role != "control" && role != "check") {
      throw std::invalid_argument(
          fmt::format("the role \"{}\" is neither control nor check", role));
    }
    point.is_check = role == "check";
    point.position = {number(kLatitude), number(kLongitude), number(kHeight)};
    if (std::abs(point.position.latitude) > 90 || std::abs(point.position.longitude) > 180) {
      throw std::invalid_argument("latitude or longitude is out of range");
    }
    point.sigma = number(kSigma);
    if (!(point.sigma > 0)) throw std::invalid_argument("sigma is not positive");
    point.map = text(kMap);
    point.p_local = {number(kX), number(kY), number(kZ)};
    return point;
  }

 private:
  const std::string& text(Column column) const {
    const std::string& cell = cells_.at(places_[column]);
    if (cell.empty()) throw std::invalid_argument(fmt::format("{} is empty", kColumns[column]));
    return cell;
  }
  double number(Column column) const { return number_of(text(column), kColumns[column]); }

  const std::array<std::size_t, kColumns.size()>& places_;
  const Cells& cells_;
};

std::array<std::size_t, kColumns.size()> places_of(const Cells& header) {
  std::array<std::size_t, kColumns.size()> places{};
  for (std::size_t k = 0; k < kColumns.size(); ++k) {
    const auto found = std::find(header.begin(), header.end(), kColumns[k]);
    if (found == header.end()) {
      throw std::invalid_argument(fmt::format("there is no column {}", kColumns[k]));
    }
    places[k] = static_cast<std::size_t>(found - header.begin());
  }
  return places;
}

}  // namespace

std::vector<SurveyedPoint> read_surveyed_points(const std::filesystem::path& path) {
  InputFile file(path, kDataFile);
  std::vector<SurveyedPoint> points;
  std::optional<std::array<std::size_t, kColumns.size()>> places;
  std::size_t columns = 0;
  int number = 0;
  for (std::string line; std::getline(file.stream(), line);) {
    ++number;
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    try {
      const Cells cells = cells_of(line);
      if (!places) {
        places = places_of(cells);
        columns = cells.size();
        continue;
      }
      if (cells.size() != columns) {
        throw std::invalid_argument(fmt::format("{} values for {} columns", cells.size(), columns));
      }
      points.push_back(PointLine(*places, cells).point());
    } catch (const std::invalid_argument& error) {
      throw InputError(error.what(), fmt::format("{}:{}", path.string(), number),
                       "correct the line (docs/city.md has an example)");
    }
  }
  return points;
}

}  // namespace fovea
