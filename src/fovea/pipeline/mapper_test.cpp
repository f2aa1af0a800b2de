#include "fovea/pipeline/mapper.h"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "../../../tests/sample_map.h"
#include "fovea/base/parallel.h"
#include "fovea/pipeline/drive_log.h"
#include "fovea/pipeline/mapper_test_support.h"

namespace fovea::mapper_test {

/// Bit for bit, colours and what tells of them included.
void expect_same_maps(const TileMap& a, const TileMap& b) {
  ASSERT_EQ(a.submaps().size(), b.submaps().size());
  for (std::size_t id = 0; id < a.submaps().size(); ++id) {
    const Submap &left = a.submaps()[id], &right = b.submaps()[id];
    EXPECT_EQ(left.T_local_submap.matrix(), right.T_local_submap.matrix());
    ASSERT_EQ(left.tiles.size(), right.tiles.size());
    for (const auto& [key, stored] : left.tiles) {
      const PointCloud tile = stored.points->cloud();
      ASSERT_TRUE(right.tiles.contains(key));
      expect_same_columns(tile, right.tiles.at(key).points->cloud());
    }
  }
}

/// The street, its walls not on borders of the map's cells: there rounding decides between two.
BoxScene street_off_borders() {
  BoxScene scene = street_scene();
  const Eigen::Vector3d shift(0.007, 0.006, 0.003);
  for (Box& box : scene.boxes) box.min += shift, box.max += shift;
  return scene;
}

/// Points that are in the cell of another one.
std::size_t crowded_points(const TileMap& map, double cell) {
  std::size_t crowded = 0;
  for (const Submap& submap : map.submaps()) {
    std::set<std::array<std::int64_t, 3>> cells;
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (const Eigen::Vector3f& position : tile.position) {
        const Eigen::Array3d at = ((tile.origin + position.cast<double>()) / cell).array().floor();
        crowded += !cells.insert({std::int64_t(at.x()), std::int64_t(at.y()), std::int64_t(at.z())})
                        .second;
      }
    }
  }
  return crowded;
}

// Noise-free scans at true poses, nothing interpolated: what remains is frames and half pixels.
TEST(Mapper, TruePosesGiveTheTrueSurfaceAndColours) {
  MapperOptions options;
  options.surface.spacing = 0;
  options.upsample.rate = 0;
  Mapper mapper(street().info(), options, PoseSource::kNavigation);
  map_frames(mapper, street(), 0, 4);
  const auto points = points_of(mapper.map());
  ASSERT_GT(points.size(), 5000u);
  double worst = 0, color_error = 0;
  for (const MapPoint& point : points) {
    worst = std::max(worst, street().scene.distance(point.p_local));
    color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
  }
  EXPECT_LT(worst, 1e-3);
  // A point near a box's edge may be hidden from the camera by parallax; few are.
  EXPECT_LT(color_error / double(points.size()), 2.0);
}

TEST(Mapper, UpsampledPointsStayOnTheSurface) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  const auto records = map_frames(mapper, street(), 0, 4);
  const auto points = points_of(mapper.map());
  std::size_t interpolated = 0, off = 0;
  for (const MapPoint& point : points) {
    interpolated += point.interpolated;
    off += street().scene.distance(point.p_local) > 0.02;
  }
  EXPECT_GT(interpolated, points.size() / 4);
  EXPECT_LT(double(off) / double(points.size()), 0.02);  // chords across corners, shorter than tau
  EXPECT_GT(records[0].figures.at("points_upsampled"), 2 * records[0].figures.at("points_foveal"));
}

TEST(Mapper, ManyViewsGiveTrueColoursAtOnePointACell) {
  const SyntheticDrive drive(street_off_borders(), 8, 0.8);
  Mapper mapper(drive.info(), {}, PoseSource::kNavigation);
  const auto records = map_frames(mapper, drive, 0, 8);
  double color_error = 0, views = 0;
  std::size_t wrong = 0, count = 0;
  for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      const Eigen::Vector3d p_local = mapper.map().submaps()[0].T_local_submap *
                                      (tile.origin + tile.position[i].cast<double>());
      const float error = (to_float(tile.color[i]) - synthetic_color(p_local)).norm();
      color_error += error;
      wrong += error > 15;  // a quarter of a metre off
      views += tile.views[i];
      ++count;
      ASSERT_GE(tile.views[i], 1);
      ASSERT_LE(tile.views[i], 8);
      ASSERT_GE(tile.weight[i], tile.views[i]);
    }
  }
  ASSERT_EQ(count, mapper.map().size());
  EXPECT_LT(color_error / double(count), 2.0);
  EXPECT_LT(double(wrong), 0.02 * double(count));
  EXPECT_GT(views / double(count), 2.0);
  EXPECT_GT(records[7].figures.at("points_recolored"), 10'000);
  EXPECT_GT(records[7].figures.at("texture_compared"), 1000);
  EXPECT_GT(records[7].figures.at("texture_error"), 0);
  EXPECT_LT(records[7].figures.at("texture_error"), 30);
  EXPECT_LT(double(crowded_points(mapper.map(), 4.0 / 200)), 1e-3 * double(count));
}

// However long a vehicle stands: also where cells end just where positions are rounded to (2 cm).
TEST(Mapper, AStandingVehicleAddsNothing) {
  for (const double spacing : {0.0185, 0.02, 0.03}) {
    SyntheticDrive drive(street_off_borders(), 4, 0);
    for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
    MapperOptions options;
    options.surface.spacing = spacing;
    Mapper mapper(drive.info(), options, PoseSource::kGiven);
    std::vector<std::size_t> size;
    for (int i = 0; i < 4; ++i) {
      mapper.process(std::get<Frame>(drive.load(i)), false, RigidMotion::Identity());
      size.push_back(mapper.map().size());
    }
    EXPECT_LE(size[3] - size[0], size[0] / 5000) << spacing;
  }
}

// The same scan and image again: nothing is new, and every point is seen again.
TEST(Mapper, AScanOfWhatIsMappedAddsViewsAndNoPoints) {
  SyntheticDrive drive(street_off_borders(), 10, 0);
  for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
  Mapper mapper(drive.info(), {}, PoseSource::kGiven);
  std::size_t after_first = 0;
  for (int i = 0; i < 10; ++i) {
    mapper.process(std::get<Frame>(drive.load(i)), false, RigidMotion::Identity());
    if (i == 0) after_first = mapper.map().size();
  }
  ASSERT_GT(after_first, 50'000u);
  // In ten frames, however long it stands: floats at a cell's border.
  EXPECT_LE(mapper.map().size(), after_first + after_first / 2000);
  std::size_t seen_again = 0;
  for (const auto& [key, stored] : mapper.map().submaps()[0].tiles) {
    const PointCloud tile = stored.points->cloud();
    for (std::size_t i = 0; i < tile.size(); ++i) {
      ASSERT_LE(tile.views[i], 10);
      seen_again += tile.views[i] == 10;
      if (tile.views[i] == 10) {
        ASSERT_LE(tile.spread[i], 1);
      }
    }
  }
  EXPECT_GT(double(seen_again), 0.6 * double(after_first));
}

TEST(Mapper, SamplesPassAnyRayFilter) {
  std::map<RayFilterMode, std::size_t> sizes;
  for (const RayFilterMode mode :
       {RayFilterMode::kPaper, RayFilterMode::kScan, RayFilterMode::kOff}) {
    MapperOptions options;
    options.ray_filter.mode = mode;
    Mapper mapper(street().info(), options, PoseSource::kNavigation);
    const auto records = map_frames(mapper, street(), 0, 3);
    std::size_t off = 0;
    double color_error = 0;
    const auto points = points_of(mapper.map());
    for (const MapPoint& point : points) {
      off += street().scene.distance(point.p_local) > 0.02;
      color_error += (to_float(point.color) - synthetic_color(point.p_local)).norm();
    }
    EXPECT_LT(double(off), 0.02 * double(points.size())) << int(mode);
    EXPECT_LT(color_error / double(points.size()), 3.0) << int(mode);
    EXPECT_EQ(records[2].figures.contains("filter_hidden"), mode == RayFilterMode::kScan);
    EXPECT_EQ(records[2].figures.contains("filter_visible"), mode == RayFilterMode::kPaper);
    sizes[mode] = points.size();
  }
  EXPECT_GT(sizes[RayFilterMode::kPaper], 20'000u);
  EXPECT_LT(sizes[RayFilterMode::kPaper], sizes[RayFilterMode::kOff]);
  EXPECT_LE(sizes[RayFilterMode::kScan], sizes[RayFilterMode::kOff]);
}

TEST(Mapper, OnlyTheWhiteZoneIsTextured) {
  Mapper mapper(street().info(), {}, PoseSource::kNavigation);
  map_frames(mapper, street(), 0, 1);
  for (const MapPoint& point : points_of(mapper.map())) {
    const double range = (street().T_local_lidar[0].inverse() * point.p_local).norm();
    ASSERT_GT(range, 2.7);  // an interpolated point may lie a little inside its triangle's chord
    ASSERT_LT(range, 18.0);
  }
}

// The registration is given a wrong speed (navigation scaled by 0.9) and must find the true steps.
TEST(Mapper, RefinementCorrectsTheNavigation) {
  SyntheticDrive drive(street_scene(), 8, 0.8);
  std::vector<StampedPose> wrong;
  for (int i = 0; i < 8; ++i) {
    RigidMotion T = drive.T_local_lidar[std::size_t(i)];
    T.translation() *= 0.9;
    wrong.push_back({SyntheticDrive::stamp_of(i), T});
  }
  drive.editable_info().navigation = Trajectory(wrong);
  for (const auto target : {RegistrationTarget::kLocalMap, RegistrationTarget::kPreviousScan}) {
    MapperOptions options;
    options.refinement.target = target;
    Mapper mapper(drive.info(), options, PoseSource::kRefine);
    const auto records = map_frames(mapper, drive, 0, 8);
    const double error =
        (records[7].T_local_lidar.translation() - drive.T_local_lidar[7].translation()).norm();
    EXPECT_LT(error, 0.1) << static_cast<int>(target);  // navigation is 0.56 m off
    EXPECT_EQ(records[7].note, "");
  }
}

// A camera that sees next to nothing gives next to no map, and the very same poses.
TEST(Mapper, RegistrationUsesWhatNoCameraSees) {
  const auto run = [](int width) {
    SyntheticDrive drive(street_scene(), 4, 0.8);
    drive.editable_info().calibration.cameras[0].width = width;
    Mapper mapper(drive.info(), {}, PoseSource::kRefine);
    const auto records = map_frames(mapper, drive, 0, 4);
    return std::pair(records, mapper.map().size());
  };
  const auto [whole, many] = run(621);
  const auto [slit, few] = run(12);
  EXPECT_LT(few, many / 10);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_EQ(whole[i].T_odom_lidar.matrix(), slit[i].T_odom_lidar.matrix());
    EXPECT_EQ(whole[i].figures.at("registration_points"),
              slit[i].figures.at("registration_points"));
    EXPECT_GT(slit[i].figures.at("registration_points"), 1000);
  }
}

// Tau holds wherever upsampling runs: also for the points that are registered.
TEST(Mapper, TauLimitsTheUpsamplingBeforeRegistration) {
  const auto registered_points = [](double max_edge) {
    MapperOptions options;
    apply_variant("E1", options);
    options.upsample.max_edge = max_edge;
    Mapper mapper(street().info(), options, PoseSource::kRefine);
    return map_frames(mapper, street(), 0, 1).front().figures.at("registration_points");
  };
  EXPECT_LT(registered_points(0.05), registered_points(0.3));
}

TEST(Mapper, WithoutNavigationItStartsFromRest) {
  SyntheticDrive drive(street_scene(), 8, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  const auto records = map_frames(mapper, drive, 0, 8);
  const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[7];
  EXPECT_LT((records[7].T_local_lidar.translation() - truth.translation()).norm(), 0.05);
}

/// A drive whose navigation is as `spoil` leaves it; the worst error of a frame's pose.
template <class Spoil>
double worst_error(Spoil&& spoil, std::vector<FrameRecord>* told = nullptr) {
  SyntheticDrive drive(street_scene(), 14, 0.8);
  std::vector<StampedPose> poses = drive.info().navigation->poses();
  spoil(poses);
  drive.editable_info().navigation = Trajectory(poses);
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  DriveLog log;
  for (FrameRecord& record : map_frames(mapper, drive, 0, 14)) log.add(std::move(record));
  std::vector<FrameRecord> records = log.rows(mapper.map(), /*exact=*/true).frames;
  double worst = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    const RigidMotion truth = drive.T_local_lidar[0].inverse() * drive.T_local_lidar[i];
    const RigidMotion found = records[0].T_local_lidar.inverse() * records[i].T_local_lidar;
    worst = std::max(worst, (found.translation() - truth.translation()).norm());
  }
  if (told != nullptr) *told = std::move(records);
  return worst;
}

TEST(Mapper, SurvivesNavigationThatJumps) {
  std::vector<FrameRecord> records;
  EXPECT_LT(worst_error(
                [](auto& poses) {
                  for (std::size_t i = 6; i < poses.size(); ++i) {
                    poses[i].T_local_body.translation().y() += 5;
                  }
                },
                &records),
            0.05);
  EXPECT_EQ(records[6].figures.count("navigation_jumped"), 1u);
  EXPECT_NE(records[6].note.find("navigation moves otherwise"), std::string::npos);
  EXPECT_EQ(records[7].figures.count("navigation_jumped"), 0u);
}

TEST(Mapper, SurvivesNavigationThatFreezes) {
  EXPECT_LT(worst_error([](auto& poses) {
              for (std::size_t i = 6; i < poses.size(); ++i) {
                poses[i].T_local_body = poses[5].T_local_body;
              }
            }),
            0.05);
}

TEST(Mapper, SurvivesNavigationThatEnds) {
  EXPECT_LT(worst_error([](auto& poses) { poses.resize(5); }), 0.05);
}

TEST(Mapper, SurvivesScansWithHalfTheirBeams) {
  SyntheticDrive drive(street_scene(), 12, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  double worst = 0;
  for (int i = 0; i < 12; ++i) {
    drive.beams = i % 3 == 2 ? 24 : 48;
    const FrameRecord record = mapper.process(std::get<Frame>(drive.load(i)), false);
    const RigidMotion truth =
        drive.T_local_lidar[0].inverse() * drive.T_local_lidar[std::size_t(i)];
    worst = std::max(worst, (record.T_local_lidar.translation() - truth.translation()).norm());
    EXPECT_EQ(record.note, "") << i;
  }
  EXPECT_LT(worst, 0.08);
}

TEST(Mapper, AVehicleThatStandsStaysWhereItIs) {
  SyntheticDrive drive(street_scene(), 30, 0);
  for (RigidMotion& T : drive.T_local_lidar) T = RigidMotion::Identity();
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kRefine);
  const auto records = map_frames(mapper, drive, 0, 30);
  EXPECT_LT(records.back().T_local_lidar.translation().norm(), 0.005);
  EXPECT_EQ(mapper.map().submaps().size(), 1u);
}

TEST(Mapper, WhereGivenPosesEndScansAreRegistered) {
  SyntheticDrive drive(street_scene(), 10, 0.8);
  drive.editable_info().navigation.reset();
  Mapper mapper(drive.info(), {}, PoseSource::kGivenFirst);
  std::vector<FrameRecord> records;
  for (int i = 0; i < 10; ++i) {
    const auto given = i < 5 ? std::optional(drive.T_local_lidar[std::size_t(i)]) : std::nullopt;
    records.push_back(mapper.process(std::get<Frame>(drive.load(i)), false, given));
  }
  EXPECT_EQ(records[4].T_local_lidar.matrix(), drive.T_local_lidar[4].matrix());
  EXPECT_LT((records[9].T_local_lidar.translation() - drive.T_local_lidar[9].translation()).norm(),
            0.05);
}

TEST(Mapper, HeldOutFramesAddNothingButGetAPose) {
  Mapper with(street().info(), {}, PoseSource::kRefine);
  const auto records = map_frames(with, street(), 0, 6, /*held_out=*/3);
  EXPECT_EQ(records[3].status, FrameStatus::kHeldOut);
  EXPECT_EQ(records[3].figures.count("points_added"), 0u);
  EXPECT_LT(
      (records[3].T_local_lidar.translation() - street().T_local_lidar[3].translation()).norm(),
      0.05);
  for (const MapPoint& point : points_of(with.map())) ASSERT_NE(point.frame, 3);

  // The frames after it are as if it had never been: its scan is no registration target either.
  SyntheticDrive without_it = street();
  Mapper without(without_it.info(), {}, PoseSource::kRefine);
  map_frames(without, without_it, 0, 3);
  const auto rest = map_frames(without, without_it, 4, 6);
  EXPECT_LT(
      (rest.back().T_local_lidar.translation() - records.back().T_local_lidar.translation()).norm(),
      1e-3);
}

TEST(Mapper, SameMapAtAnyThreadCount) {
  const auto run = [](int threads) {
    const ThreadLimit limit(threads);
    Mapper mapper(street().info(), {}, PoseSource::kRefine);
    map_frames(mapper, street(), 0, 3);
    return points_of(mapper.map());
  };
  const auto one = run(1), two = run(2);
  ASSERT_EQ(one.size(), two.size());
  for (std::size_t i = 0; i < one.size(); ++i) {
    ASSERT_EQ(one[i].p_local, two[i].p_local);
    ASSERT_EQ(one[i].color, two[i].color);
  }
}

// Mapping sees submaps as they were at its frame, however far tracking is ahead.
TEST(Mapper, TrackingAheadChangesNothing) {
  SyntheticDrive drive(street_scene(), 10, 1.3);
  std::vector<StampedPose> poses = drive.info().navigation->poses();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    poses[i].T_local_body.translation().y() += 0.02 * double(i % 2);  // submaps move
  }
  drive.editable_info().navigation = Trajectory(poses);
  MapperOptions options;
  options.fusion.submap_duration = 0.25;
  Mapper stepwise(drive.info(), options, PoseSource::kRefine);
  const auto records = map_frames(stepwise, drive, 0, 10, 3);

  Mapper ahead(drive.info(), options, PoseSource::kRefine);
  std::vector<TrackedFrame> tracked;
  for (int i = 0; i < 10; ++i) {
    tracked.push_back(ahead.track(std::get<Frame>(drive.load(i)), i == 3, std::nullopt));
  }
  for (int i = 0; i < 10; ++i) {
    const FrameRecord record =
        ahead.add(std::get<Frame>(drive.load(i)), std::move(tracked[std::size_t(i)]));
    EXPECT_EQ(record.figures, records[std::size_t(i)].figures) << i;
    if (i % 2 == 0) ahead.settle_map();  // where it is not called, the next frame does it
  }
  EXPECT_GT(ahead.map().submaps().size(), 2u);
  expect_same_maps(stepwise.map(), ahead.map());
}

TEST(Mapper, AScanOfWhatIsNotInTheTargetBecomesPartOfIt) {
  const auto last_pose = [](double distance, double overlap) {
    MapperOptions options;
    options.refinement.local_map.keyframe_distance = distance;
    options.refinement.local_map.keyframe_overlap = overlap;
    Mapper mapper(street().info(), options, PoseSource::kRefine);
    return map_frames(mapper, street(), 0, 5).back().T_odom_lidar.matrix();
  };
  const auto first_alone = last_pose(1000, 0), all = last_pose(0, 0);
  EXPECT_NE(first_alone, all);
  EXPECT_EQ(last_pose(1000, 1), all);
  EXPECT_EQ(last_pose(1000, 0.1), first_alone);
}

TEST(Mapper, ResumedRunEqualsAnUninterruptedOne) {
  // Targets are all scans, some, or the first alone; of a local map, or of the last few.
  for (const auto& [target, keyframe_distance, keyframe_overlap, max_keyframes] :
       {std::tuple(RegistrationTarget::kLocalMap, 0.0, 0.8, 20),
        {RegistrationTarget::kLocalMap, 1.5, 0.8, 20},
        {RegistrationTarget::kLocalMap, 1.5, 0.8, 1},
        {RegistrationTarget::kLocalMap, 1000.0, 0.8, 20},
        {RegistrationTarget::kLocalMap, 1000.0, 0.99, 20},
        {RegistrationTarget::kPreviousScan, 1.5, 0.8, 20}}) {
    MapperOptions options;
    options.refinement.target = target;
    options.refinement.local_map.keyframe_distance = keyframe_distance;
    options.refinement.local_map.keyframe_overlap = keyframe_overlap;
    options.refinement.local_map.max_keyframes = max_keyframes;
    options.fusion.submap_duration = 0.25;  // several submaps
    Mapper whole(street().info(), options, PoseSource::kRefine);
    const auto records = map_frames(whole, street(), 0, 7, 3);

    Mapper first(street().info(), options, PoseSource::kRefine);
    const auto before = map_frames(first, street(), 0, 4, 3);
    Mapper second(street().info(), options, PoseSource::kRefine);
    second.resume(first.map(), before, street());
    const auto after = map_frames(second, street(), 4, 7, 3);

    EXPECT_EQ(records[6].T_local_lidar.matrix(), after[2].T_local_lidar.matrix());
    expect_same_maps(whole.map(), second.map());
  }
}

// A file may come from anybody.
TEST(Mapper, ResumesFromRecordsThatLackAFigure) {
  Mapper first(street().info(), {}, PoseSource::kRefine);
  auto records = map_frames(first, street(), 0, 3);
  ASSERT_EQ(records[2].figures.erase("registration_points"), 1u);
  Mapper second(street().info(), {}, PoseSource::kRefine);
  second.resume(first.map(), records, street());
  EXPECT_EQ(map_frames(second, street(), 3, 4)[0].status, FrameStatus::kMapped);
}

}  // namespace fovea::mapper_test
