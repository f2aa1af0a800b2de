#include "fovea/core/point_formats/column_names.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace fovea {
namespace {

/// Usual names of a column, the first in a file counts; "time_ms" may follow "time".
std::vector<std::string> usual_names(std::string_view wanted) {
  if (wanted == "intensity") {
    return {"intensity", "intensities", "i", "reflectivity", "reflectance", "remission"};
  }
  if (wanted == "ring") return {"ring", "channel"};
  if (wanted != "time") return {std::string(wanted)};
  std::vector<std::string> names = {"t", "time", "timestamp", "offset_time", "stamp"};
  for (const char* other : {"time_offset", "point_time", "relative_time", "rel_time", "dt"}) {
    names.emplace_back(other);
  }
  const std::size_t plain = names.size();
  for (const char* unit : {"s", "sec", "ms", "msec", "us", "usec", "ns", "nsec"}) {
    for (std::size_t i = 0; i < plain; ++i) names.push_back(names[i] + "_" + unit);
  }
  return names;
}

std::optional<std::size_t> place_of(const std::string& name, std::span<const std::string> names) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) return std::nullopt;
  return static_cast<std::size_t>(found - names.begin());
}

}  // namespace

std::string plain_column_name(std::string_view name) {
  std::string plain;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0) plain += static_cast<char>(std::tolower(byte));
  }
  constexpr std::string_view kPrefix = "scalar";
  if (plain.size() > kPrefix.size() && plain.starts_with(kPrefix)) plain.erase(0, kPrefix.size());
  return plain;
}

std::optional<std::size_t> find_column(std::span<const std::string> names,
                                       std::string_view wanted) {
  std::vector<std::string> plain_names;
  for (const std::string& name : names) plain_names.push_back(plain_column_name(name));
  for (const std::string& usual : usual_names(wanted)) {
    if (const auto same = place_of(usual, names)) return same;
    if (const auto similar = place_of(plain_column_name(usual), plain_names)) return similar;
  }
  return std::nullopt;
}

std::string list_columns(std::span<const std::string> names) {
  constexpr std::size_t kShown = 12;
  return fmt::format("{}{}", fmt::join(names.first(std::min(names.size(), kShown)), ", "),
                     names.size() > kShown ? ", ..." : "");
}

}  // namespace fovea
