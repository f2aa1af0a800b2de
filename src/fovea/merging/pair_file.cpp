#include "fovea/merging/pair_file.h"

#include "fovea/city/json_values.h"

namespace fovea {
namespace {

constexpr std::size_t kVersion = 1;
constexpr const char* kRemedy = "make it again with 'fovea align'";
using Covariance = Eigen::Matrix<double, 6, 6>;

Json json_of_name(const MapName& name) {
  return {{"identity", name.identity}, {"drive", name.drive}, {"submaps", name.submaps}};
}

MapName name_from(const Json& json) {
  return {json.at("identity").get<std::string>(), json.at("drive").get<std::string>(),
          count_of(json.at("submaps"))};
}

/// The lower half, row by row.
Json json_of_covariance(const Covariance& covariance) {
  Json numbers = Json::array();
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column) numbers.push_back(covariance(row, column));
  }
  return numbers;
}

Covariance covariance_from(const Json& json) {
  const auto numbers = vector_of<21>(json);
  Covariance covariance;
  int next = 0;
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column <= row; ++column) {
      covariance(row, column) = covariance(column, row) = numbers[next++];
    }
  }
  if (!(covariance.diagonal().array() > 0).all()) {
    throw std::invalid_argument("a variance is not positive");
  }
  return covariance;
}

Json json_of_match(const SubmapMatch& match) {
  Json json{{"submap_a", match.submap_a},    {"submap_b", match.submap_b},
            {"T_a_b", json_of(match.T_a_b)}, {"covariance", json_of_covariance(match.covariance)},
            {"overlap", match.overlap},      {"on_plane", match.on_plane}};
  if (match.log2_gain) {
    json["log2_gain"] = json_of<3>(match.log2_gain->cast<double>().matrix());
  }
  return json;
}

SubmapMatch match_from(const Json& json, const MapPair& pair) {
  SubmapMatch match{.submap_a = count_of(json.at("submap_a")),
                    .submap_b = count_of(json.at("submap_b"))};
  if (match.submap_a >= pair.a.submaps || match.submap_b >= pair.b.submaps) {
    throw std::invalid_argument("a map has no such submap");
  }
  match.T_a_b = motion_of(json.at("T_a_b"));
  match.covariance = covariance_from(json.at("covariance"));
  match.overlap = json.at("overlap").get<double>();
  match.on_plane = json.at("on_plane").get<double>();
  if (json.contains("log2_gain")) {
    match.log2_gain = vector_of<3>(json.at("log2_gain")).cast<float>().array();
  }
  return match;
}

PairVerdict verdict_from(const std::string& text) {
  for (const auto verdict : {PairVerdict::kFits, PairVerdict::kNoOverlap, PairVerdict::kNoFit}) {
    if (text == to_string(verdict)) return verdict;
  }
  throw std::invalid_argument("no verdict is called \"" + text + "\"");
}

}  // namespace

void write_pair(const MapPair& pair, const std::filesystem::path& path, bool force) {
  Json json{{"fovea_pair", kVersion},    {"a", json_of_name(pair.a)},
            {"b", json_of_name(pair.b)}, {"verdict", to_string(pair.verdict)},
            {"tried", pair.tried},       {"moved_m", pair.moved},
            {"matches", Json::array()}};
  for (const SubmapMatch& match : pair.matches) json["matches"].push_back(json_of_match(match));
  write_json(json, path, force);
}

MapPair read_pair(const std::filesystem::path& path) {
  MapPair pair;
  read_json(path, "pair of maps", kRemedy, [&](const Json& json) {
    if (count_of(json.at("fovea_pair")) != kVersion) {
      throw std::invalid_argument("it is of another version of Fovea");
    }
    pair.a = name_from(json.at("a"));
    pair.b = name_from(json.at("b"));
    pair.verdict = verdict_from(json.at("verdict").get<std::string>());
    pair.tried = count_of(json.at("tried"));
    pair.moved = json.at("moved_m").get<double>();
    for (const Json& match : list_at(json, "matches"))
      pair.matches.push_back(match_from(match, pair));
  });
  return pair;
}

}  // namespace fovea
