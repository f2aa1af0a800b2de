#include "fovea/map/map_store.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <numeric>
#include <set>

#include "../../../tests/sample_map.h"
#include "../../../tests/temporary_folder.h"
#include "fovea/errors.h"
#include "fovea/map/tile_points.h"

namespace fovea::map_store_test {

using ::testing::ElementsAre;

void expect_same_frame(const FrameRecord& a, const FrameRecord& b) {
  EXPECT_EQ(a.index, b.index);
  EXPECT_EQ(a.stamp, b.stamp);
  EXPECT_EQ(a.status, b.status);
  EXPECT_EQ(a.note, b.note);
  EXPECT_EQ(a.T_local_lidar.matrix(), b.T_local_lidar.matrix());
  ASSERT_EQ(a.T_local_lidar_navigation.has_value(), b.T_local_lidar_navigation.has_value());
  if (a.T_local_lidar_navigation) {
    EXPECT_EQ(a.T_local_lidar_navigation->matrix(), b.T_local_lidar_navigation->matrix());
  }
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_EQ(a.views, b.views);
  EXPECT_EQ(a.figures, b.figures);
  EXPECT_EQ(a.milliseconds, b.milliseconds);
}

TEST(MapStore, EverythingComesBackBitForBit) {
  const TemporaryFolder folder;
  const TileMap map = sample_tile_map();
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, map);
    writer->commit();
  }
  EXPECT_THAT(folder.names(), ElementsAre("a.fovea"));

  const MapReader reader(folder / "a.fovea");
  const MapMeta meta = reader.meta();
  EXPECT_EQ(meta.at("config"), "mapper = \"default\"\n");
  EXPECT_EQ(meta.at("format_version"), "7");
  EXPECT_EQ(meta.size(), 7u);
  EXPECT_EQ(reader.format_version(), 7);
  const std::vector<FrameRecord> expected = sample_frames(), frames = reader.frames();
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t i = 0; i < frames.size(); ++i) expect_same_frame(frames[i], expected[i]);
  const std::vector<RigidMotion> submaps = reader.submaps();
  ASSERT_EQ(submaps.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(submaps[i].matrix(), map.submaps()[i].T_local_submap.matrix());
  }
  EXPECT_EQ(reader.size(), map.size());
  std::vector<std::pair<std::size_t, TileKey>> order;
  std::size_t colored = 0;
  reader.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    order.emplace_back(submap, key);
    expect_same_columns(tile, map.submaps()[submap].tiles.at(key).points->cloud());
    colored += std::count(tile.camera.begin(), tile.camera.end(), std::int8_t{2});
  });
  EXPECT_EQ(order.size(), map.submaps()[0].tiles.size() + map.submaps()[1].tiles.size());
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  EXPECT_EQ(reader.colored_size(), colored);
}

void expect_same_drive(const DriveRecord& a, const DriveRecord& b) {
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.session, b.session);
  EXPECT_EQ(a.calibration_fingerprint, b.calibration_fingerprint);
  EXPECT_EQ(a.stamps_fingerprint, b.stamps_fingerprint);
  EXPECT_EQ(a.first_frame, b.first_frame);
  EXPECT_EQ(a.end_frame, b.end_frame);
  EXPECT_EQ(a.frame_shift, b.frame_shift);
  EXPECT_EQ(a.T_local_drive.matrix(), b.T_local_drive.matrix());
  ASSERT_EQ(a.origin.has_value(), b.origin.has_value());
  if (a.origin) {
    EXPECT_EQ(a.origin->latitude, b.origin->latitude);
    EXPECT_EQ(a.origin->longitude, b.origin->longitude);
    EXPECT_EQ(a.origin->altitude, b.origin->altitude);
  }
  EXPECT_EQ(a.datum, b.datum);
  EXPECT_EQ(a.epoch_year, b.epoch_year);
  EXPECT_EQ(a.height_type, b.height_type);
  EXPECT_EQ(a.source_digest, b.source_digest);
}

TEST(MapStore, DrivesAndSensorsComeBackBitForBit) {
  const TemporaryFolder folder;
  DriveRecord merged;  // with nothing that may be absent, but a digest
  merged.source_digest = "d";
  SensorRecord livox;
  livox.drive = 1;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    writer->put_drive(1, merged);
    writer->put_sensor(1, livox);
    writer->commit();
  }
  const MapReader reader(folder / "a.fovea");
  const std::vector<DriveRecord> drives = reader.drives();
  ASSERT_EQ(drives.size(), 2u);
  expect_same_drive(drives[0], sample_drive());
  expect_same_drive(drives[1], merged);
  const std::vector<SensorRecord> sensors = reader.sensors();
  ASSERT_EQ(sensors.size(), 2u);
  EXPECT_EQ(sensors[0].profile, sample_sensor().profile);
  EXPECT_EQ(sensors[0].drive, 0);
  EXPECT_EQ(sensors[0].T_lidar_sensor.matrix(), sample_sensor().T_lidar_sensor.matrix());
  EXPECT_EQ(sensors[1].profile, SensorProfile());
  EXPECT_EQ(sensors[1].drive, 1);
}

// The file has colors and gains as they were found. A reader returns the exposure of the map.
TEST(MapStore, TheGainOfASubmapChangesItsColorsAndTheGainsOfItsFrames) {
  const TemporaryFolder folder;
  const Eigen::Vector3d gain(1, 0, -0.5);
  {
    auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    SubmapRecord submap = sample_submap(RigidMotion::Identity());
    submap.log2_gain = gain;
    for (std::size_t id = 0; id < 2; ++id) writer->put_submap(id, submap);
    FrameRecord frame = sample_frames()[0];
    frame.submap = 0;
    writer->put_frame(frame);
    writer->commit();
  }
  write_sample_map(folder / "plain.fovea");
  const MapReader changed(folder / "a.fovea"), plain(folder / "plain.fovea");
  std::size_t tiles = 0;
  plain.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    ++tiles;
    TilePoints expected = tile;
    for (FusedColor& color : expected.colors) {
      color.color = with_offset(color.color, 256 * gain.cast<float>().array());
    }
    EXPECT_EQ(changed.find_tile(id)->colors, expected.colors);
    EXPECT_EQ(changed.read_tile(id).color, expected.cloud().color);
  });
  changed.for_each_stored_tile([&](const TileId&, const TilePoints&) { --tiles; });
  EXPECT_EQ(tiles, 0u);
  const ViewRecord stored = plain.frames()[0].views[1], view = changed.frames()[0].views[1];
  EXPECT_EQ(*view.log2_gain, *stored.log2_gain - gain);
  EXPECT_EQ(*view.log2_color, *stored.log2_color + gain);
  EXPECT_EQ(view.revisit->log2_gain, stored.revisit->log2_gain - gain);
  EXPECT_EQ(changed.stored_frames()[0].views[1], stored);
  for (const SubmapRecord& submap : changed.submap_records()) EXPECT_FALSE(submap.log2_gain);
}

TEST(MapStore, SubmapsKeyframesAndCheckpointsComeBackBitForBit) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const MapReader reader(folder / "a.fovea");
  const SubmapRecord expected = sample_submap(RigidMotion::Identity());
  for (const SubmapRecord& submap : reader.submap_records()) {
    EXPECT_EQ(submap.drive, 0);
    ASSERT_TRUE(submap.covariance);
    EXPECT_EQ(*submap.covariance, *expected.covariance);
  }
  int keyframes = 0;
  reader.for_each_keyframe([&](const KeyframeRecord& keyframe) {
    const KeyframeRecord sample = sample_keyframe();
    EXPECT_EQ(keyframe.frame, sample.frame);
    EXPECT_EQ(keyframe.sensor, sample.sensor);
    EXPECT_EQ(keyframe.elevations, sample.elevations);
    EXPECT_EQ(keyframe.columns, sample.columns);
    EXPECT_EQ(keyframe.first_azimuth, sample.first_azimuth);
    EXPECT_EQ(keyframe.azimuth_step, sample.azimuth_step);
    EXPECT_EQ(keyframe.ranges, sample.ranges);
    ++keyframes;
  });
  EXPECT_EQ(keyframes, 1);
  const auto checkpoint = reader.checkpoint("tracker");
  ASSERT_TRUE(checkpoint);
  EXPECT_EQ(checkpoint->frame, sample_checkpoint().frame);
  EXPECT_EQ(checkpoint->state, sample_checkpoint().state);
  EXPECT_FALSE(reader.checkpoint("mapper"));
}

TEST(MapStore, ColumnsWithDefaultsComeBack) {
  const TemporaryFolder folder;
  TilePoints tile = TilePoints::of(one_point_each({{1, 2, 3}, {3, 2, 1}, {2, 2, 2}}));
  tile.colors[1].saturated = 7;
  tile.colors[2].saturated = 1;
  tile.sensor.append(std::vector<std::uint16_t>{0, 300, 1});
  tile.sampling_level.append(std::vector<std::uint8_t>{4, 0, 0});
  tile.session.append(std::vector<std::uint16_t>{65535, 1, 1});
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    writer->put_submap(0, RigidMotion::Identity());
    writer->put_tile({0, {0, 0, 0}}, tile);
    writer->commit();
  }
  const auto read = MapReader(folder / "a.fovea").find_tile({0, {0, 0, 0}});
  ASSERT_TRUE(read);
  EXPECT_EQ(read->colors, tile.colors);
  EXPECT_EQ(read->sensor, tile.sensor);
  EXPECT_EQ(read->sampling_level, tile.sampling_level);
  EXPECT_EQ(read->session, tile.session);
}

TEST(MapStore, TilesWithoutIntensityOrPointsComeBack) {
  const TemporaryFolder folder;
  const PointCloud tile = TilePoints::of(one_point_each({{1, 2, 3}, {3, 2, 1}})).cloud();
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    writer->put_submap(0, RigidMotion::Identity());
    writer->put_tile({0, {0, 0, 0}}, tile);
    writer->put_tile({0, {-1, 0, 0}}, PointCloud());
    writer->commit();
  }
  std::vector<std::size_t> sizes;
  MapReader(folder / "a.fovea")
      .for_each_tile([&](std::size_t, const TileKey&, const PointCloud& read) {
        sizes.push_back(read.size());
        if (!read.empty()) expect_same_columns(read, tile);
      });
  EXPECT_THAT(sizes, ElementsAre(0u, 2u));
}

TEST(MapStore, AllPointsLieInTheLocalFrame) {
  const TemporaryFolder folder;
  const TileMap map = sample_tile_map();
  write_sample_map(folder / "a.fovea");
  const PointCloud points_local = MapReader(folder / "a.fovea").all_points_local();
  points_local.check();
  ASSERT_EQ(points_local.size(), map.size());
  EXPECT_EQ(points_local.origin, Eigen::Vector3d::Zero());
  std::size_t i = 0;
  for (const Submap& submap : map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      for (std::size_t j = 0; j < tile.size(); ++j, ++i) {
        const Eigen::Vector3d expected =
            submap.T_local_submap * (tile.origin + tile.position[j].cast<double>());
        EXPECT_LT((points_local.position[i].cast<double>() - expected).norm(), 1e-5);
        EXPECT_EQ(points_local.color[i], tile.color[j]);
        EXPECT_EQ(points_local.frame[i], tile.frame[j]);
      }
    }
  }
}

TEST(MapStore, GivesThePointsThatPass) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const MapReader reader(folder / "a.fovea");
  const PointCloud all_local = reader.all_points_local();
  const PointCloud near_local = reader.all_points_local(PointFilter::parse("range < 9"));
  std::vector<std::uint32_t> expected;
  for (std::uint32_t i = 0; i < all_local.size(); ++i) {
    if (all_local.range[i] < 9) expected.push_back(i);
  }
  ASSERT_FALSE(expected.empty());
  near_local.check();
  EXPECT_EQ(near_local.position, all_local.select(expected).position);
}

TEST(MapStore, PuttingAgainReplaces) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    writer->commit();
    writer->put_meta("config", "new");
    FrameRecord frame = sample_frames()[0];
    frame.note = "new";
    frame.stamp.reset();
    frame.motion.reset();
    writer->put_frame(frame);
    writer->put_submap(1, RigidMotion::Identity());
    writer->put_tile({0, {0, 0, 0}}, one_point_each({{1, 1, 1}}));
    writer->commit();
  }
  const MapReader reader(folder / "a.fovea");
  EXPECT_EQ(reader.meta().at("config"), "new");
  EXPECT_EQ(reader.frames()[0].note, "new");
  EXPECT_EQ(reader.frames()[0].stamp, std::nullopt);
  EXPECT_EQ(reader.frames()[0].motion, std::nullopt);
  EXPECT_EQ(reader.submaps()[1].matrix(), Eigen::Matrix4d::Identity());
  std::size_t size = 0;
  reader.for_each_tile([&](std::size_t submap, const TileKey& key, const PointCloud& tile) {
    if (submap == 0 && key == TileKey{}) size = tile.size();
  });
  EXPECT_EQ(size, 1u);
}

TEST(MapStore, RefusesWhatItCannotKeep) {
  const TemporaryFolder folder;
  const auto writer = MapWriter::create(folder / "a.fovea", false);
  PointCloud tile = one_point_each({{1, 1, 1}});
  tile.range.clear();
  EXPECT_THROW(writer->put_tile({0, {}}, tile), std::logic_error);
  const auto pack = [&](std::size_t i) {
    if (i == 50) throw std::logic_error("no tile");
    return pack_tile({0, {int(i), 0, 0}}, TilePoints());
  };
  EXPECT_THROW(writer->put_tiles(100, pack), std::logic_error);
  EXPECT_THROW(writer->put_meta("format_version", "8"), std::invalid_argument);
  FrameRecord frame;
  frame.T_local_lidar.translation().x() = std::nan("");
  EXPECT_THROW(writer->put_frame(frame), std::invalid_argument);
  DriveRecord drive;
  drive.epoch_year = std::nan("");
  EXPECT_THROW(writer->put_drive(0, drive), std::invalid_argument);
  SensorRecord sensor;
  sensor.profile.ring_elevations = {std::nan("")};
  EXPECT_THROW(writer->put_sensor(0, sensor), std::invalid_argument);
  SubmapRecord submap;
  submap.log2_gain = Eigen::Vector3d(0, std::nan(""), 0);
  EXPECT_THROW(writer->put_submap(0, submap), std::invalid_argument);
  KeyframeRecord keyframe = sample_keyframe();
  keyframe.ranges.pop_back();
  EXPECT_THROW(writer->put_keyframe(keyframe), std::invalid_argument);
  writer->commit();  // none of these spoiled the map
}

// ---- digest

using Change = std::function<void(MapWriter&)>;

std::string digest_with(const Change& change) {
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "a.fovea", false);
    put_sample_map(*writer, sample_tile_map());
    change(*writer);
    writer->commit();
  }
  return MapReader(folder / "a.fovea").digest();
}

TEST(MapDigest, DoesNotDependOnTheOrderOrNumberOfPuts) {
  const TileMap map = sample_tile_map();
  const std::string expected = digest_with([](MapWriter&) {});
  EXPECT_EQ(expected.size(), 32u);
  const TemporaryFolder folder;
  {
    const auto writer = MapWriter::create(folder / "b.fovea", false);
    for (std::size_t id = map.submaps().size(); id-- > 0;) {
      const auto& tiles = map.submaps()[id].tiles;
      for (auto it = tiles.rbegin(); it != tiles.rend(); ++it) {
        writer->put_tile({id, it->first}, one_point_each({{0, 0, 0}}));  // replaced below
      }
      writer->commit();
      for (auto it = tiles.rbegin(); it != tiles.rend(); ++it) {
        writer->put_tile({id, it->first}, *it->second.points);
      }
      writer->put_submap(id, sample_submap(map.submaps()[id].T_local_submap));
    }
    const std::vector<FrameRecord> frames = sample_frames();
    for (auto it = frames.rbegin(); it != frames.rend(); ++it) writer->put_frame(*it);
    put_sample_map(*writer, TileMap());
    writer->commit();
  }
  EXPECT_EQ(MapReader(folder / "b.fovea").digest(), expected);
}

TEST(MapDigest, LeavesOutTimingsOnly) {
  const std::string expected = digest_with([](MapWriter&) {});
  const auto with_frame = [](const std::function<void(FrameRecord&)>& change) {
    return digest_with([&](MapWriter& writer) {
      FrameRecord frame = sample_frames()[0];
      change(frame);
      writer.put_frame(frame);
    });
  };
  EXPECT_EQ(with_frame([](FrameRecord& f) { f.milliseconds["decode"] = 99; }), expected);
  EXPECT_EQ(digest_with([](MapWriter& w) { w.put_meta("timing.total", "1"); }), expected);
  EXPECT_EQ(digest_with([](MapWriter& w) { w.put_meta("timing.more", "1"); }), expected);

  std::set<std::string> digests = {expected};
  const auto expect_new = [&](const std::string& digest) {
    EXPECT_TRUE(digests.insert(digest).second);
  };
  expect_new(digest_with([](MapWriter& w) { w.put_meta("config", "x"); }));
  expect_new(digest_with([](MapWriter& w) { w.put_meta("x", "config"); }));
  expect_new(digest_with([](MapWriter& w) { w.put_submap(1, RigidMotion::Identity()); }));
  expect_new(digest_with([](MapWriter& w) { w.put_submap(2, RigidMotion::Identity()); }));
  expect_new(with_frame([](FrameRecord& f) { f.index = 6; }));
  expect_new(with_frame([](FrameRecord& f) { ++*f.stamp; }));
  expect_new(with_frame([](FrameRecord& f) { f.stamp.reset(); }));
  expect_new(with_frame([](FrameRecord& f) { f.status = FrameStatus::kHeldOut; }));
  expect_new(with_frame([](FrameRecord& f) { f.note += "another"; }));
  expect_new(with_frame([](FrameRecord& f) { f.motion.reset(); }));
  expect_new(with_frame([](FrameRecord& f) { f.T_local_lidar_navigation.reset(); }));
  expect_new(with_frame([](FrameRecord& f) {
    double& x = f.T_local_lidar.translation().x();
    x = std::nextafter(x, 1e9);
  }));
  expect_new(with_frame([](FrameRecord& f) { f.figures["b"] = 0; }));
  expect_new(with_frame([](FrameRecord& f) { ++*f.views[0].stamp; }));
  expect_new(with_frame([](FrameRecord& f) { f.views[1].log2_gain.reset(); }));
  expect_new(with_frame([](FrameRecord& f) { f.views.pop_back(); }));
}

TEST(MapDigest, ChangesWithDrivesSensorsSubmapsAndKeyframes) {
  std::set<std::string> digests = {digest_with([](MapWriter&) {})};
  const auto expect_new = [&](const Change& change) {
    EXPECT_TRUE(digests.insert(digest_with(change)).second);
  };
  const auto with_drive = [&](const std::function<void(DriveRecord&)>& change) {
    expect_new([&](MapWriter& writer) {
      DriveRecord drive = sample_drive();
      change(drive);
      writer.put_drive(0, drive);
    });
  };
  with_drive([](DriveRecord& d) { d.stamps_fingerprint.reset(); });
  with_drive([](DriveRecord& d) { d.calibration_fingerprint = "other"; });
  with_drive([](DriveRecord& d) { d.height_type = HeightType::kEllipsoidal; });
  with_drive([](DriveRecord& d) { d.epoch_year.reset(); });
  with_drive([](DriveRecord& d) { d.origin.reset(); });
  expect_new([](MapWriter& writer) {
    SensorRecord sensor = sample_sensor();
    sensor.profile.height.reset();
    writer.put_sensor(0, sensor);
  });
  expect_new([](MapWriter& writer) {
    SubmapRecord submap = sample_submap(RigidMotion::Identity());
    writer.put_submap(0, submap);
  });
  expect_new([](MapWriter& writer) {
    SubmapRecord submap = sample_submap(RigidMotion::Identity());
    submap.covariance.reset();
    writer.put_submap(0, submap);
  });
  expect_new([](MapWriter& writer) {
    KeyframeRecord keyframe = sample_keyframe();
    ++keyframe.ranges[0];
    writer.put_keyframe(keyframe);
  });
}

TEST(MapDigest, LeavesOutTheStateForResuming) {
  EXPECT_EQ(digest_with([](MapWriter& w) { w.put_checkpoint("tracker", {}); }),
            digest_with([](MapWriter& w) { w.put_checkpoint("other", sample_checkpoint()); }));
}

TEST(MapDigest, ChangesWithAnyBitOfATile) {
  const TileMap map = sample_tile_map();
  const auto& [key, largest] =
      *std::max_element(map.submaps()[1].tiles.begin(), map.submaps()[1].tiles.end(),
                        [](const auto& a, const auto& b) {
                          return a.second.points->size() < b.second.points->size();
                        });
  const PointCloud tile = largest.points->cloud();
  std::set<std::string> digests = {digest_with([](MapWriter&) {})};
  const auto expect_new = [&](const PointCloud& changed) {
    EXPECT_TRUE(
        digests.insert(digest_with([&](MapWriter& w) { w.put_tile({1, key}, changed); })).second);
  };
  const std::size_t last = tile.size() - 1;
  PointCloud changed = tile;
  changed.position[last].z() += 0.001f;
  expect_new(changed);
  changed = tile;
  changed.color[last].code[2] ^= 1;
  expect_new(changed);
  changed = tile;
  changed.camera[0] = 3;
  expect_new(changed);
  changed = tile;
  changed.frame[0] ^= 1 << 30;
  expect_new(changed);
  changed = tile;
  changed.range[0] += 0.01f;
  expect_new(changed);
  changed = tile;
  changed.incidence[last] = changed.incidence[last] == 0.25f ? 0.5f : 0.25f;
  expect_new(changed);
  changed = tile;
  changed.interpolated[last] ^= 1;
  expect_new(changed);
  changed = tile;
  changed.views[0] ^= 1;
  expect_new(changed);
  changed = tile;
  changed.spread[last] ^= 1;
  expect_new(changed);
  changed = tile;
  changed.weight[last] ^= 256;
  expect_new(changed);
  changed = tile;
  changed.reason[0] ^= kExposureMatched;
  expect_new(changed);
  changed = tile;
  changed.intensity[last] = -1;
  expect_new(changed);
  changed = tile;
  changed.intensity.clear();
  expect_new(changed);
  changed = tile;
  changed.origin.x() += 1;
  expect_new(changed);
  std::vector<std::uint32_t> swapped(tile.size());
  std::iota(swapped.rbegin(), swapped.rend(), 0u);
  expect_new(tile.select(swapped));
}

TEST(MapReader, AMissingTileIsNoReasonToLoseTheOthers) {
  const TemporaryFolder folder;
  write_sample_map(folder / "a.fovea");
  const MapReader reader(folder / "a.fovea");
  const auto tiles = reader.tile_sizes();
  const TileId nowhere{0, {1000, 0, 0}};
  EXPECT_FALSE(reader.find_tile(nowhere).has_value());
  EXPECT_THROW(reader.read_tile(nowhere), InputError);
  for (const auto& [id, points] : tiles) EXPECT_EQ(reader.find_tile(id)->size(), points);
}

}  // namespace fovea::map_store_test
