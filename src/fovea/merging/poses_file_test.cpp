#include "fovea/merging/poses_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "fovea/city/json_file_test_support.h"
#include "fovea/errors.h"
#include "fovea/geometry/geodesy.h"

namespace fovea::poses_file_test {

using testing::HasSubstr;

CityPoses made_up_city() {
  CityPoses city;
  city.origin = {49.1 / 3, -8.4 / 7, 123.4};
  city.maps.resize(3);
  city.maps[0].name = {"0123abcd", "drive \"a\"", 2};
  city.maps[0].is_fixed = true;
  city.maps[0].matches = 12;
  city.maps[0].moved = 1.0 / 3;
  for (const double latitude : {49.012345678, -33.4}) {
    const RigidMotion T = T_ecef_enu({latitude, 8.4 / 3, 123.456}) *
                          RigidMotion(Eigen::AngleAxisd(2.1, Eigen::Vector3d::UnitX()));
    city.maps[0].submaps.push_back({T, Eigen::Vector3d(latitude / 700, -0.25, 1e-9)});
  }
  city.maps[1].name = {"ffee", "Straße", 1};
  city.maps[1].submaps.push_back({T_ecef_enu({0, 180, 0}), Eigen::Vector3d::Zero()});
  city.maps[2].name = {"00", "without submaps", 0};
  city.rejected.push_back({"0123abcd", "ffee", 1, 0, std::sqrt(2)});
  city.points.push_back({"P1", false, Eigen::Vector3d(0.01, -0.02 / 3, 0.1)});
  city.points.push_back({"P2", true, Eigen::Vector3d(-1, 2, 1e-12)});
  return city;
}

class PosesFile : public JsonFileTest {
 protected:
  PosesFile()
      : JsonFileTest(
            "poses.json", "poses of a city", "fovea adjust",
            [](const Path& path) { write_city_poses(made_up_city(), path, /*force=*/false); },
            [](const Path& path) { read_city_poses(path); }) {}
};

TEST_F(PosesFile, OriginAndMapsReadBack) {
  const CityPoses written = made_up_city(), read = read_city_poses(path_);
  EXPECT_EQ(read.origin.latitude, written.origin.latitude);
  EXPECT_EQ(read.origin.longitude, written.origin.longitude);
  EXPECT_EQ(read.origin.altitude, written.origin.altitude);
  ASSERT_EQ(read.maps.size(), 3u);
  for (std::size_t k = 0; k < 3; ++k) {
    const PlacedMap &a = read.maps[k], &b = written.maps[k];
    EXPECT_EQ(a.name.identity, b.name.identity);
    EXPECT_EQ(a.name.drive, b.name.drive);
    EXPECT_EQ(a.name.submaps, b.name.submaps);
    EXPECT_EQ(a.is_fixed, b.is_fixed);
    EXPECT_EQ(a.matches, b.matches);
    EXPECT_EQ(a.moved, b.moved);
    ASSERT_EQ(a.submaps.size(), b.submaps.size());
    for (std::size_t id = 0; id < a.submaps.size(); ++id) {
      const RigidMotion &T = a.submaps[id].T_ecef_submap, &truth = b.submaps[id].T_ecef_submap;
      EXPECT_GT(truth.translation().norm(), 6.3e6);
      EXPECT_EQ(T.matrix(), truth.matrix());
      EXPECT_EQ(a.submaps[id].log2_gain, b.submaps[id].log2_gain);
    }
  }
}

TEST_F(PosesFile, RejectedMatchesAndPointsReadBack) {
  const CityPoses read = read_city_poses(path_);
  ASSERT_EQ(read.rejected.size(), 1u);
  EXPECT_EQ(read.rejected[0].identity_a, "0123abcd");
  EXPECT_EQ(read.rejected[0].identity_b, "ffee");
  EXPECT_EQ(read.rejected[0].submap_a, 1u);
  EXPECT_EQ(read.rejected[0].submap_b, 0u);
  EXPECT_EQ(read.rejected[0].distance, std::sqrt(2));
  ASSERT_EQ(read.points.size(), 2u);
  EXPECT_EQ(read.points[0].name, "P1");
  EXPECT_FALSE(read.points[0].is_check);
  EXPECT_EQ(read.points[0].east_north_up, Eigen::Vector3d(0.01, -0.02 / 3, 0.1));
  EXPECT_EQ(read.points[1].name, "P2");
  EXPECT_TRUE(read.points[1].is_check);
  EXPECT_EQ(read.points[1].east_north_up, Eigen::Vector3d(-1, 2, 1e-12));
}

TEST_F(PosesFile, ACityWithoutMapsReadsBack) {
  write_city_poses({}, path_, /*force=*/true);
  const CityPoses read = read_city_poses(path_);
  EXPECT_TRUE(read.maps.empty());
  EXPECT_TRUE(read.rejected.empty());
  EXPECT_TRUE(read.points.empty());
}

TEST_F(PosesFile, TruncatedFilesAreDamaged) {
  const std::string whole = text();
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{1}, whole.size() / 3, whole.size() / 2, whole.rfind('}')}) {
    expect_damaged(whole.substr(0, size));
  }
  expect_damaged(whole + "]");
}

TEST_F(PosesFile, OtherKindsAndVersionsAreRefused) {
  expect_damaged_with("/fovea_poses", 2);
  expect_damaged_with("/fovea_poses", 0);
  expect_damaged_with("/fovea_poses", "1");
  expect_damaged(R"({"fovea_pair": 1, "matches": []})");
  expect_damaged("[]");
  expect_damaged("null");
}

TEST_F(PosesFile, DeepNestingIsRefused) {
  expect_damaged(std::string(100'000, '['));
  expect_damaged(std::string(100, '[') + std::string(100, ']'));
}

TEST_F(PosesFile, EachValueIsNeeded) {
  for (const std::string place : {"", "/origin", "/maps/0", "/maps/0/submaps/1",
                                  "/maps/0/submaps/0/T_ecef_submap", "/rejected/0", "/points/1"}) {
    const Json object = json_[Json::json_pointer(place)];
    for (const auto& item : object.items()) {
      SCOPED_TRACE(place + "/" + item.key());
      Json json = json_;
      json[Json::json_pointer(place)].erase(item.key());
      expect_damaged(json.dump());
    }
  }
}

TEST_F(PosesFile, RotationsAreChecked) {
  const std::string rotation = "/maps/0/submaps/1/T_ecef_submap/rotation";
  expect_damaged_with(rotation, {1.001, 0, 0, 0, 1, 0, 0, 0, 1});
  expect_damaged_with(rotation, {1, 0, 0, 0, 1, 0, 0, 0, -1});
  expect_damaged_with(rotation, {nullptr, 0, 0, 0, 1, 0, 0, 0, 1});
  expect_damaged_with(rotation, {0, 0, 0, 1});
}

// JSON has no such number: the writer stores null.
TEST_F(PosesFile, ValuesThatAreNoNumbersDoNotReadBack) {
  CityPoses city = made_up_city();
  city.maps[1].submaps[0].T_ecef_submap.translation().x() =
      std::numeric_limits<double>::quiet_NaN();
  write_city_poses(city, path_, /*force=*/true);
  EXPECT_THROW(read_city_poses(path_), InputError);
  city = made_up_city();
  city.maps[1].submaps[0].log2_gain.x() = std::numeric_limits<double>::infinity();
  write_city_poses(city, path_, /*force=*/true);
  EXPECT_THROW(read_city_poses(path_), InputError);
}

TEST_F(PosesFile, ValuesHaveTheirType) {
  for (const std::string place :
       {"/origin/height_m", "/maps/0/matches", "/maps/0/moved_m", "/maps/0/submaps/0/log2_gain/1",
        "/maps/0/submaps/0/T_ecef_submap/translation/2", "/rejected/0/submap_a",
        "/rejected/0/distance_m", "/points/0/east_north_up_m/0"}) {
    expect_damaged_with(place, "1");
    expect_damaged_with(place, nullptr);
  }
  expect_damaged_with("/maps/0/fixed", 1);
  expect_damaged_with("/maps/0/fixed", "true");
  for (const std::string place : {"/maps/0/identity", "/maps/0/drive", "/rejected/0/identity_b",
                                  "/points/0/name", "/points/0/role"}) {
    expect_damaged_with(place, 1);
  }
  for (const std::string place : {"/maps/0", "/maps/0/submaps/0", "/maps/0/submaps/0/T_ecef_submap",
                                  "/rejected/0", "/points/0"}) {
    expect_damaged_with(place, Json::array({1, 2}));
    expect_damaged_with(place, "text");
  }
}

TEST_F(PosesFile, RolesAreControlOrCheck) {
  expect_damaged_with("/points/0/role", "checked");
  expect_damaged_with("/points/0/role", "");
}

TEST_F(PosesFile, AnObjectIsNoArray) {
  for (const std::string place : {"/maps", "/maps/0/submaps", "/rejected", "/points"}) {
    for (const Json& value : {Json::object(), Json(nullptr), Json("text"), Json(1)}) {
      expect_damaged_with(place, value);
    }
  }
}

TEST_F(PosesFile, VectorsHaveTheirLength) {
  for (const std::string place :
       {"/maps/0/submaps/0/T_ecef_submap/translation", "/maps/0/submaps/0/T_ecef_submap/rotation",
        "/maps/0/submaps/0/log2_gain", "/points/0/east_north_up_m"}) {
    expect_damaged_with(place, {1, 0});
    expect_damaged_with(place, std::vector<double>(22, 0));
  }
}

TEST_F(PosesFile, VectorsAreNotEmpty) {
  for (const std::string place :
       {"/maps/0/submaps/0/T_ecef_submap/translation", "/maps/0/submaps/0/T_ecef_submap/rotation",
        "/maps/0/submaps/0/log2_gain", "/points/0/east_north_up_m"}) {
    expect_damaged_with(place, Json::array());
  }
}

TEST_F(PosesFile, AnExistingOutputIsReplacedOnlyByForce) {
  const std::string before = text();
  EXPECT_THROW(write_city_poses({}, path_, /*force=*/false), OutputError);
  EXPECT_EQ(text(), before);
  write_city_poses({}, path_, /*force=*/true);
  EXPECT_TRUE(read_city_poses(path_).maps.empty());
}

TEST_F(PosesFile, AMissingFileIsAnError) {
  EXPECT_THROW(read_city_poses(folder_ / "missing.json"), InputError);
}

}  // namespace fovea::poses_file_test
