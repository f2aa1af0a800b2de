#include "fovea/merging/pair_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "fovea/city/json_file_test_support.h"
#include "fovea/errors.h"

namespace fovea::pair_file_test {

using testing::HasSubstr;

/// A rotation about all axes, and a translation with all bits in use.
RigidMotion motion(double seed) {
  RigidMotion T(Eigen::Translation3d(seed / 3, -100 / seed, std::sqrt(2) * seed));
  T.rotate(Eigen::AngleAxisd(seed, Eigen::Vector3d(1, -2, 0.5).normalized()));
  return T;
}

/// Positive definite, with other numbers in each cell.
Eigen::Matrix<double, 6, 6> covariance(double seed) {
  Eigen::Matrix<double, 6, 6> root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = 0.01 * std::sin(seed + i);
  Eigen::Matrix<double, 6, 6> product = root * root.transpose();
  product.diagonal().array() += 1e-6 / 3;
  return product;
}

MapPair made_up_pair() {
  MapPair pair;
  pair.a = {"0123abcd", "drive \"a\"", 5};
  pair.b = {"ffee", "Straße", 4};
  pair.verdict = PairVerdict::kFits;
  pair.tried = 17;
  pair.moved = 1.0 / 3;
  pair.matches.push_back({4, 0, motion(0.7), covariance(1), 2.0 / 3, 0.9, {}});
  pair.matches.push_back(
      {0, 3, motion(3.1), covariance(2), 0.1, 1.0 / 7, LogGain(0.1F, -2, 1e-7F)});
  return pair;
}

class PairFile : public JsonFileTest {
 protected:
  PairFile()
      : JsonFileTest(
            "pair.json", "pair of maps", "fovea align",
            [](const Path& path) { write_pair(made_up_pair(), path, /*force=*/false); },
            [](const Path& path) { read_pair(path); }) {}
};

void expect_same(const MapName& read, const MapName& written) {
  EXPECT_EQ(read.identity, written.identity);
  EXPECT_EQ(read.drive, written.drive);
  EXPECT_EQ(read.submaps, written.submaps);
}

TEST_F(PairFile, ReadsBackBitByBit) {
  const MapPair written = made_up_pair(), read = read_pair(path_);
  expect_same(read.a, written.a);
  expect_same(read.b, written.b);
  EXPECT_EQ(read.verdict, written.verdict);
  EXPECT_EQ(read.tried, written.tried);
  EXPECT_EQ(read.moved, written.moved);
  ASSERT_EQ(read.matches.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    const SubmapMatch &a = read.matches[i], &b = written.matches[i];
    EXPECT_EQ(a.submap_a, b.submap_a);
    EXPECT_EQ(a.submap_b, b.submap_b);
    EXPECT_EQ(a.T_a_b.translation(), b.T_a_b.translation());
    EXPECT_EQ(a.T_a_b.linear(), b.T_a_b.linear());
    EXPECT_EQ(a.covariance.triangularView<Eigen::Lower>().toDenseMatrix(),
              b.covariance.triangularView<Eigen::Lower>().toDenseMatrix());
    EXPECT_EQ(a.covariance, a.covariance.transpose());
    EXPECT_EQ(a.overlap, b.overlap);
    EXPECT_EQ(a.on_plane, b.on_plane);
  }
  EXPECT_FALSE(read.matches[0].log2_gain);
  ASSERT_TRUE(read.matches[1].log2_gain);
  EXPECT_TRUE((*read.matches[1].log2_gain == *written.matches[1].log2_gain).all());
}

TEST_F(PairFile, PairsWithoutMatchesReadBack) {
  for (const PairVerdict verdict : {PairVerdict::kNoOverlap, PairVerdict::kNoFit}) {
    MapPair pair;
    pair.a = {"a", "drive_a", 1};
    pair.b = {"b", "drive_b", 0};
    pair.verdict = verdict;
    write_pair(pair, path_, /*force=*/true);
    EXPECT_EQ(read_pair(path_).verdict, verdict);
    EXPECT_TRUE(read_pair(path_).matches.empty());
    EXPECT_EQ(read_pair(path_).b.submaps, 0u);
  }
}

TEST_F(PairFile, TruncatedFilesAreDamaged) {
  const std::string whole = text();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, whole.size() / 3, whole.size() / 2, whole.rfind('}')}) {
    expect_damaged(whole.substr(0, size));
  }
  expect_damaged(whole + "}");
}

TEST_F(PairFile, OtherKindsAndVersionsAreRefused) {
  expect_damaged_with("/fovea_pair", 2);
  expect_damaged_with("/fovea_pair", 0);
  expect_damaged_with("/fovea_pair", "1");
  expect_damaged(R"({"fovea_poses": 1, "maps": [], "rejected": [], "points": []})");
  expect_damaged("[]");
  expect_damaged("null");
  expect_damaged("1");
}

TEST_F(PairFile, DeepNestingIsRefused) {
  expect_damaged(std::string(100'000, '['));
  expect_damaged(std::string(100, '[') + std::string(100, ']'));
  std::string nested;
  for (int i = 0; i < 40; ++i) nested += R"({"a":)";
  expect_damaged(nested + "1" + std::string(40, '}'));
}

TEST_F(PairFile, EachValueIsNeeded) {
  for (const std::string place : {"", "/a", "/b", "/matches/0", "/matches/0/T_a_b", "/matches/1"}) {
    const Json object = json_[Json::json_pointer(place)];
    for (const auto& item : object.items()) {
      if (item.key() == "log2_gain") continue;
      SCOPED_TRACE(place + "/" + item.key());
      Json json = json_;
      json[Json::json_pointer(place)].erase(item.key());
      expect_damaged(json.dump());
    }
  }
}

TEST_F(PairFile, MatchesAreOfSubmapsThatTheMapsHave) {
  expect_damaged_with("/matches/0/submap_a", 5);  // the map has the submaps 0 to 4
  expect_damaged_with("/matches/1/submap_b", 4);
  expect_damaged_with("/matches/1/submap_b", -1);
  expect_damaged_with("/a/submaps", 4);
  expect_damaged_with("/b/submaps", 0);
}

TEST_F(PairFile, RotationsAreChecked) {
  expect_damaged_with("/matches/0/T_a_b/rotation", {1.001, 0, 0, 0, 1, 0, 0, 0, 1});
  expect_damaged_with("/matches/0/T_a_b/rotation", {1, 0, 0, 0, 1, 0, 0, 0, -1});
  expect_damaged_with("/matches/0/T_a_b/rotation", {1, 0, 0, 0, 1, 1, 0, 0, 1});
  expect_damaged_with("/matches/0/T_a_b/rotation", {nullptr, 0, 0, 0, 1, 0, 0, 0, 1});
  expect_damaged_with("/matches/0/T_a_b/rotation", {0, 0, 0, 1});
}

TEST_F(PairFile, VariancesArePositive) {
  for (const int place : {0, 2, 5, 9, 14, 20}) {  // the diagonal
    const std::string variance = "/matches/1/covariance/" + std::to_string(place);
    expect_damaged_with(variance, 0);
    expect_damaged_with(variance, -1e-6);
    expect_damaged_with(variance, nullptr);
  }
  expect_damaged_with("/matches/1/covariance/1", nullptr);
}

// JSON has no such number: the writer stores null.
TEST_F(PairFile, ValuesThatAreNoNumbersDoNotReadBack) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  MapPair pair = made_up_pair();
  pair.matches[0].covariance(3, 3) = kNaN;
  write_pair(pair, path_, /*force=*/true);
  EXPECT_THROW(read_pair(path_), InputError);
  pair = made_up_pair();
  pair.matches[0].T_a_b.translation().y() = std::numeric_limits<double>::infinity();
  write_pair(pair, path_, /*force=*/true);
  EXPECT_THROW(read_pair(path_), InputError);
}

TEST_F(PairFile, TheVerdictExists) {
  expect_damaged_with("/verdict", "perhaps");
  expect_damaged_with("/verdict", "");
  expect_damaged_with("/verdict", 0);
}

TEST_F(PairFile, ValuesHaveTheirType) {
  for (const std::string place :
       {"/a/submaps", "/tried", "/moved_m", "/matches/0/submap_a", "/matches/0/overlap",
        "/matches/0/on_plane", "/matches/0/T_a_b/translation/0", "/matches/0/covariance/3",
        "/matches/1/log2_gain/2"}) {
    expect_damaged_with(place, "1");
    expect_damaged_with(place, nullptr);
    expect_damaged_with(place, Json::array());
  }
  for (const std::string place : {"/a/identity", "/b/drive"}) expect_damaged_with(place, 1);
  for (const std::string place : {"/a", "/b", "/matches/0", "/matches/0/T_a_b"}) {
    expect_damaged_with(place, Json::array({1, 2}));
    expect_damaged_with(place, "text");
  }
}

TEST_F(PairFile, AnObjectIsNoArray) {
  for (const Json& value : {Json::object(), Json(nullptr), Json("text"), Json(1)}) {
    expect_damaged_with("/matches", value);
  }
}

TEST_F(PairFile, VectorsHaveTheirLength) {
  for (const std::string place : {"/matches/0/T_a_b/translation", "/matches/0/T_a_b/rotation",
                                  "/matches/0/covariance", "/matches/1/log2_gain"}) {
    expect_damaged_with(place, {1, 0});
    expect_damaged_with(place, std::vector<double>(22, 0));
  }
}

TEST_F(PairFile, VectorsAreNotEmpty) {
  for (const std::string place : {"/matches/0/T_a_b/translation", "/matches/0/T_a_b/rotation",
                                  "/matches/0/covariance", "/matches/1/log2_gain"}) {
    expect_damaged_with(place, Json::array());
  }
}

TEST_F(PairFile, AnExistingOutputIsReplacedOnlyByForce) {
  const std::string before = text();
  EXPECT_THROW(write_pair({}, path_, /*force=*/false), OutputError);
  EXPECT_EQ(text(), before);
  write_pair({}, path_, /*force=*/true);
  EXPECT_TRUE(read_pair(path_).matches.empty());
  EXPECT_THROW(write_pair({}, folder_ / "missing" / "pair.json", true), OutputError);
}

TEST_F(PairFile, AMissingFileIsAnError) {
  EXPECT_THROW(read_pair(folder_ / "missing.json"), InputError);
}

}  // namespace fovea::pair_file_test
