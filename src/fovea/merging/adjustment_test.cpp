// Maps of three drives along streets whose true places are known.
#include "fovea/merging/adjustment.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/map/meta_keys.h"
#include "fovea/merging/twist_adjoint.h"

namespace fovea::adjustment_test {

using Vector3 = Eigen::Vector3d;

constexpr GeodeticPoint kOrigin{49.0, 8.4, 110};
constexpr std::size_t kSubmaps = 12;
constexpr double kStep = 15;  // m from submap to submap

/// T_town_submap of a drive that begins at a place and heads along `heading`.
std::vector<RigidMotion> true_poses(const Vector3& begin, double heading) {
  std::vector<RigidMotion> poses;
  for (std::size_t id = 0; id < kSubmaps; ++id) {
    RigidMotion T(Eigen::Translation3d{begin});
    T.rotate(Eigen::AngleAxisd(heading, Vector3::UnitZ()));
    T.translate(Vector3(kStep * double(id), 0, 0));
    poses.push_back(T);
  }
  return poses;
}

/// A map whose navigation is off by a constant, and whose odometry has small errors.
AdjustedMap map_of(const std::string& name, const std::vector<RigidMotion>& T_town_submap,
                   const Vector3& navigation_error, std::uint64_t seed) {
  Random random(seed);
  AdjustedMap map;
  map.name = {name + "_digest", name, kSubmaps};
  map.content.drives.resize(1);
  map.content.drives.front().name = name;
  map.content.records.resize(1);
  map.content.meta[meta_key::kOriginLatitude] = fmt::format("{}", kOrigin.latitude);
  map.content.meta[meta_key::kOriginLongitude] = fmt::format("{}", kOrigin.longitude);
  map.content.meta[meta_key::kOriginHeight] = fmt::format("{}", kOrigin.altitude);
  RigidMotion T_odom = RigidMotion::Identity();
  const RigidMotion by_navigation(Eigen::Translation3d{navigation_error});
  for (std::size_t id = 0; id < kSubmaps; ++id) {
    if (id > 0) {
      Twist error;
      for (int k = 0; k < 6; ++k) error[k] = random.normal() * (k < 3 ? 5e-4 : 0.01);
      T_odom = T_odom * T_town_submap[id - 1].inverse() * T_town_submap[id] * exp_se3(error);
    }
    FrameRecord frame;
    frame.index = int(id);
    frame.stamp = TimeNs(id) * 2 * kNsPerSecond;
    frame.submap = int(id);
    frame.T_odom_lidar = T_odom;
    frame.T_local_lidar = by_navigation * T_town_submap.front() * T_odom;
    frame.T_local_lidar_navigation = by_navigation * T_town_submap[id];
    map.content.T_local_submap.push_back(frame.T_local_lidar);
    map.content.frames.push_back(frame);
  }
  return map;
}

SubmapMatch match_of(std::size_t a, const RigidMotion& T_town_a, std::size_t b,
                     const RigidMotion& T_town_b) {
  SubmapMatch match{.submap_a = a, .submap_b = b};
  match.T_a_b = T_town_a.inverse() * T_town_b;
  match.covariance.diagonal() << 1e-6, 1e-6, 1e-7, 2.5e-5, 2.5e-5, 1e-4;
  return match;
}

/// Two parallel drives and one that crosses both, with exact matches where they are near.
class Adjustment : public testing::Test {
 protected:
  Adjustment() {
    truth_ = {true_poses({0, 0, 0}, 0), true_poses({4, 2, 0}, 0.001),
              true_poses({80, -90, 0}, 1.57)};
    const Vector3 errors[] = {{0.5, -0.3, 0.8}, {-0.4, 0.6, -0.7}, {0.2, 0.4, 0.1}};
    for (std::size_t k = 0; k < 3; ++k) {
      job_.maps.push_back(map_of(std::string(1, char('a' + k)), truth_[k], errors[k], k + 1));
    }
    for (const auto& [a, b] : {std::pair<std::size_t, std::size_t>{0, 1}, {0, 2}, {1, 2}}) {
      add_pair(a, b);
    }
  }

  void add_pair(std::size_t a, std::size_t b) {
    MapPair pair;
    pair.a = job_.maps[a].name;
    pair.b = job_.maps[b].name;
    pair.verdict = PairVerdict::kFits;
    for (std::size_t i = 0; i < kSubmaps; ++i) {
      for (std::size_t k = 0; k < kSubmaps; ++k) {
        const RigidMotion &A = truth_[a][i], &B = truth_[b][k];
        if ((A.translation() - B.translation()).norm() > 12) continue;
        pair.matches.push_back(match_of(i, A, k, B));
      }
    }
    job_.pairs.push_back(pair);
  }

  /// Largest error of a relative position of two submaps anywhere, m.
  double worst_relative_error(const CityPoses& city) const {
    const RigidMotion T_town_city = truth_[0][0] * city.maps[0].submaps[0].T_ecef_submap.inverse();
    double worst = 0;
    for (std::size_t k = 0; k < city.maps.size(); ++k) {
      for (std::size_t id = 0; id < kSubmaps; ++id) {
        const RigidMotion T = T_town_city * city.maps[k].submaps[id].T_ecef_submap;
        worst = std::max(worst, (T.translation() - truth_[k][id].translation()).norm());
      }
    }
    return worst;
  }

  std::string error() const {
    try {
      adjust_city(job_);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  std::vector<std::vector<RigidMotion>> truth_;
  AdjustmentJob job_;
};

TEST_F(Adjustment, MatchesOutweighNavigation) {
  const CityPoses city = adjust_city(job_);
  ASSERT_EQ(city.maps.size(), 3u);
  EXPECT_LT(worst_relative_error(city), 0.15);  // odometry alone: 12 submaps of 1 cm, 0.5 mrad
  EXPECT_TRUE(city.rejected.empty());
  for (const PlacedMap& map : city.maps) EXPECT_GT(map.matches, 0u);
  // Where two drives meet, they meet exactly.
  const RigidMotion T_a_b =
      city.maps[0].submaps[6].T_ecef_submap.inverse() * city.maps[1].submaps[6].T_ecef_submap;
  const RigidMotion right = truth_[0][6].inverse() * truth_[1][6];
  EXPECT_LT((T_a_b.translation() - right.translation()).norm(), 0.01);
}

TEST_F(Adjustment, AWrongMatchIsLeftOutAndNamed) {
  const CityPoses right = adjust_city(job_);
  job_.pairs[0].matches[3].T_a_b.translation().x() += 3;
  const CityPoses city = adjust_city(job_);
  ASSERT_EQ(city.rejected.size(), 1u);
  EXPECT_EQ(city.rejected[0].identity_a, "a_digest");
  EXPECT_EQ(city.rejected[0].submap_b, job_.pairs[0].matches[3].submap_b);
  EXPECT_NEAR(city.rejected[0].distance, 3, 0.1);
  EXPECT_LT(worst_relative_error(city), worst_relative_error(right) + 0.02);
}

TEST_F(Adjustment, FixedMapsStay) {
  const CityPoses before = adjust_city(job_);
  job_.fixed = {before.maps[0], before.maps[1]};
  job_.pairs[1].matches[0].T_a_b.translation().y() += 0.05;
  const CityPoses after = adjust_city(job_);
  for (const std::size_t map : {0u, 1u}) {
    for (std::size_t id = 0; id < kSubmaps; ++id) {
      const SubmapPlacement &now = after.maps[map].submaps[id],
                            &then = before.maps[map].submaps[id];
      EXPECT_EQ(now.T_ecef_submap.matrix(), then.T_ecef_submap.matrix());
      EXPECT_EQ(now.log2_gain, then.log2_gain);
    }
  }
  EXPECT_TRUE(after.maps[0].is_fixed);
  EXPECT_FALSE(after.maps[2].is_fixed);
}

/// A point 3 m beside a submap, surveyed where it truly is.
SurveyedPoint survey(const AdjustedMap& map, std::size_t submap, const RigidMotion& T_town_submap,
                     bool is_check) {
  const Vector3 p_submap(1, 3, -1.5);
  SurveyedPoint point;
  point.name = map.name.drive + std::to_string(submap);
  point.is_check = is_check;
  point.position = LocalTangentPlane(kOrigin).to_geodetic(T_town_submap * p_submap);
  point.sigma = 0.005;
  point.map = map.name.drive;
  point.p_local = map.content.T_local_submap[submap] * p_submap;
  return point;
}

TEST_F(Adjustment, ControlPointsGiveThePlace) {
  for (const auto& [map, submap] :
       {std::pair<std::size_t, std::size_t>{0, 0}, {0, 11}, {2, 0}, {2, 11}}) {
    job_.points.push_back(survey(job_.maps[map], submap, truth_[map][submap], false));
  }
  job_.points.push_back(survey(job_.maps[1], 6, truth_[1][6], true));
  const CityPoses city = adjust_city(job_);
  ASSERT_EQ(city.points.size(), 5u);
  EXPECT_TRUE(city.points.back().is_check);
  EXPECT_LT(city.points.back().east_north_up.norm(), 0.05);
  for (const PointResidual& point : city.points) EXPECT_LT(point.east_north_up.norm(), 0.05);
}

TEST_F(Adjustment, TheOrderOfTheMapsOfAPairMattersLittle) {
  const CityPoses city = adjust_city(job_);
  for (MapPair& pair : job_.pairs) {
    std::swap(pair.a, pair.b);
    for (SubmapMatch& match : pair.matches) {
      const auto to_a = adjoint(match.T_a_b);
      match.covariance = Eigen::Matrix<double, 6, 6>(to_a * match.covariance * to_a.transpose());
      std::swap(match.submap_a, match.submap_b);
      match.T_a_b = match.T_a_b.inverse();
    }
  }
  const CityPoses swapped = adjust_city(job_);
  for (std::size_t id = 0; id < kSubmaps; ++id) {
    const Eigen::Vector3d apart = swapped.maps[2].submaps[id].T_ecef_submap.translation() -
                                  city.maps[2].submaps[id].T_ecef_submap.translation();
    EXPECT_LT(apart.norm(), 2e-3) << id;
  }
}

TEST_F(Adjustment, ADriveFarOffIsBroughtBack) {
  job_.maps[1] = map_of("b", truth_[1], {15, -9, 2}, 5);
  EXPECT_LT(worst_relative_error(adjust_city(job_)), 0.15);
}

TEST_F(Adjustment, RefusesWhatDoesNotBelongTogether) {
  AdjustmentJob good = job_;
  job_.maps[1].content.meta.erase(meta_key::kOriginHeight);
  EXPECT_THAT(error(), testing::HasSubstr("without georeference"));
  job_ = good;
  job_.maps[1].content.records.front().datum = "ETRS89";
  EXPECT_THAT(error(), testing::HasSubstr("another datum"));
  job_ = good;
  job_.maps[1].content.records.front().height_type = HeightType::kOrthometric;
  EXPECT_THAT(error(), testing::HasSubstr("type of heights"));
  job_ = good;
  job_.maps[2] = job_.maps[0];
  EXPECT_THAT(error(), testing::HasSubstr("given twice"));
  job_ = good;
  job_.maps.pop_back();
  EXPECT_THAT(error(), testing::HasSubstr("a pair are of a map that is not given"));
  job_ = good;
  job_.maps[0].content.is_merged = true;
  EXPECT_THAT(error(), testing::HasSubstr("a merged map"));
  job_ = good;
  job_.pairs[0].b.submaps = 99;
  EXPECT_THAT(error(), testing::HasSubstr("other submaps than its maps"));
  job_ = good;
  job_.pairs.push_back(job_.pairs.front());
  EXPECT_THAT(error(), testing::HasSubstr("given twice"));
  job_ = good;
  job_.points.push_back(survey(job_.maps[0], 0, truth_[0][0], false));
  job_.points.back().map = "elsewhere";
  EXPECT_THAT(error(), testing::HasSubstr("elsewhere"));
}

}  // namespace fovea::adjustment_test
