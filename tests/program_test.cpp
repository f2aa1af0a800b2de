// The program as a user meets it: commands, exit codes, one-line errors, nothing half-written.
#include "tests/program.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"

namespace fovea::program_test {

using testing::HasSubstr;

/// A short synthetic drive in KITTI form, written once.
class Program : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    scratch_ = new TemporaryFolder;
    SyntheticDrive drive(street_scene(), 6, 0.8);
    drive_ = write_kitti_drive(drive, scratch_->path());
  }
  static void TearDownTestSuite() { delete scratch_; }

  /// A copy of the drive that a test may damage.
  std::filesystem::path damaged_drive() const {
    const auto root = own_ / "damaged";
    std::filesystem::copy(drive_.parent_path(), root, std::filesystem::copy_options::recursive);
    return root / drive_.filename();
  }
  ProgramRun map(const std::filesystem::path& drive, const std::string& more = "") const {
    return run_fovea(fmt::format("map '{}' -o '{}' {}", drive.string(), output().string(), more));
  }
  std::filesystem::path output() const { return own_ / "out.fovea"; }
  nlohmann::json info() const {
    return nlohmann::json::parse(run_fovea("info --json '" + output().string() + "'").out);
  }
  std::string digest() const { return run_fovea("info --digest '" + output().string() + "'").out; }

  /// One line "fovea: error: ...", exit code 1, and nothing left where the output would be.
  void expect_failure(const ProgramRun& run, const std::string& says) const {
    EXPECT_EQ(run.exit_code, 1) << run.err;
    EXPECT_THAT(run.err, testing::StartsWith("fovea: error: "));
    EXPECT_THAT(run.err, HasSubstr(says));
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
    EXPECT_TRUE(leftovers().empty()) << leftovers();
  }
  std::string leftovers() const {
    std::string names;
    for (const auto& entry : std::filesystem::directory_iterator(own_.path())) {
      if (entry.path().filename().string().starts_with("out.")) {
        names += entry.path().filename().string() + " ";
      }
    }
    return names;
  }

  static TemporaryFolder* scratch_;
  static std::filesystem::path drive_;
  TemporaryFolder own_;
};
TemporaryFolder* Program::scratch_ = nullptr;
std::filesystem::path Program::drive_;

TEST_F(Program, MapsInfoExportEvaluate) {
  const auto report = own_ / "report.json";
  const ProgramRun run = map(drive_, "--hold-out 4:2 --report '" + report.string() + "'");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(run.err, "");  // no progress bar where there is no terminal

  const auto figures = nlohmann::json::parse(read_text(report)).at("map");
  EXPECT_EQ(figures.at("frames"), 5);
  EXPECT_EQ(figures.at("frames_held_out"), 1);
  EXPECT_GT(figures.at("points"), 10000);
  for (const char* stage :
       {"decode", "upsample", "register", "fovea", "filter", "texture", "store", "frame"}) {
    for (const char* key : {"p50", "p95", "max"}) {
      EXPECT_GT(figures.at("latency_ms").at(stage).at(key), 0) << stage;
    }
  }
  EXPECT_EQ(info().at("points"), figures.at("points"));
  EXPECT_EQ(info().at("meta").at("georeferenced"), "1");

  const std::string quoted = "'" + output().string() + "' ";
  const auto ply = own_ / "map.ply", poses = own_ / "poses.txt";
  EXPECT_EQ(run_fovea("export " + quoted + ply.string()).exit_code, 0);
  EXPECT_THAT(read_text(ply), testing::StartsWith("ply\nformat binary_little_endian 1.0\n"));
  EXPECT_EQ(run_fovea("export " + quoted + poses.string() + " --format kitti-poses").exit_code, 0);
  const std::string lines = read_text(poses);
  EXPECT_EQ(std::count(lines.begin(), lines.end(), '\n'), 6);  // held-out frames too

  const auto scores = own_ / "scores.json";
  const ProgramRun held_out =
      run_fovea("evaluate " + quoted + "'" + drive_.string() +
                "' --protocol held-out --color-rules --json " + scores.string());
  ASSERT_EQ(held_out.exit_code, 0) << held_out.err;
  const auto score = nlohmann::json::parse(read_text(scores));
  EXPECT_LT(score.at("me_mean"), 0.05);
  EXPECT_LT(score.at("te_mean"), 5);  // the scene's colours are smooth
  EXPECT_GT(score.at("coverage_20cm"), 0.9);
  ASSERT_EQ(score.at("color_rules").size(), 9u);
  EXPECT_EQ(score.at("color_rules").at(0).at("rule"), "fovea");
  EXPECT_NEAR(score.at("color_rules").at(0).at("te_mean"), score.at("te_mean"), 0.5);
  EXPECT_THAT(held_out.out, HasSubstr("oracle"));

  // The exported cloud scores the same through its own door.
  const ProgramRun cloud = run_fovea("evaluate " + ply.string() + " '" + drive_.string() +
                                     "' --protocol held-out --hold-out 4:2 --cameras 2 --poses " +
                                     poses.string() + " --json " + scores.string());
  ASSERT_EQ(cloud.exit_code, 0) << cloud.err;
  const auto cloud_score = nlohmann::json::parse(read_text(scores));
  // A cloud knows no sweep velocities: they come from its poses, and differ a little.
  EXPECT_NEAR(cloud_score.at("me_mean"), score.at("me_mean"), 5e-4);
  EXPECT_NEAR(cloud_score.at("te_mean"), score.at("te_mean"), 0.1);
}

TEST_F(Program, ExportsScoreTheSameInEveryFormat) {
  ASSERT_EQ(map(drive_, "--hold-out 4:2").exit_code, 0);
  const auto scores = own_ / "scores.json", poses = own_ / "poses.txt";
  const auto exported = [&](const std::filesystem::path& to, const std::string& more) {
    return run_fovea(fmt::format("export '{}' '{}' {}", output().string(), to.string(), more));
  };
  ASSERT_EQ(exported(poses, "--format kitti-poses").exit_code, 0);
  const auto score = [&](const std::string& name, const std::string& more) {
    const ProgramRun made = exported(own_ / name, more);
    EXPECT_EQ(made.exit_code, 0) << made.err;
    EXPECT_THAT(made.out, HasSubstr(" points\n"));
    const ProgramRun run = run_fovea(
        fmt::format("evaluate {} '{}' --protocol held-out --hold-out 4:2 --cameras 2 --poses {} "
                    "--json {}",
                    (own_ / name).string(), drive_.string(), poses.string(), scores.string()));
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read_text(scores));
  };
  const auto ply = score("map.ply", "--double");
  for (const auto& other : {score("float.ply", ""), score("map.pcd", ""),
                            score("double.pcd", "--double"), score("map.las", "")}) {
    EXPECT_EQ(other.at("map_points"), ply.at("map_points"));
    EXPECT_NEAR(other.at("me_mean"), ply.at("me_mean"), 2e-4);
    EXPECT_NEAR(other.at("te_mean"), ply.at("te_mean"), 0.05);
  }
  const ProgramRun tiles = exported(own_ / "tiles", "--format 3dtiles");
  ASSERT_EQ(tiles.exit_code, 0) << tiles.err;
  EXPECT_THAT(tiles.out, HasSubstr(" tiles\n"));
  EXPECT_TRUE(std::filesystem::exists(own_ / "tiles/tileset.json"));
  const ProgramRun mesh = exported(own_ / "mesh", "--format mesh --voxel 0.2");
  ASSERT_EQ(mesh.exit_code, 0) << mesh.err;
  EXPECT_THAT(mesh.out, HasSubstr(" triangles "));
  EXPECT_TRUE(std::filesystem::exists(own_ / "mesh/tileset.json"));
  ASSERT_EQ(exported(own_ / "scenery.glb", "--voxel 0.2").exit_code, 0);
  EXPECT_THAT(read_text(own_ / "scenery.glb"), testing::StartsWith("glTF"));
  // A folder of other things is not replaced.
  std::filesystem::create_directory(own_ / "notes");
  write_text(own_ / "notes/a.txt", "something dear");
  const ProgramRun other = exported(own_ / "notes", "--format 3dtiles --force");
  EXPECT_EQ(other.exit_code, 1);
  EXPECT_THAT(other.err, HasSubstr("something else"));
  EXPECT_TRUE(std::filesystem::exists(output()));
}

// A map of whole scans: what no camera saw is in the map, and in no score and no export unasked.
TEST_F(Program, UnseenPointsAreNeitherScoredNorBlack) {
  ASSERT_EQ(map(drive_, "--variant baseline-gicp --hold-out 4:2").exit_code, 0);
  const auto poses = own_ / "poses.txt", ply = own_ / "map.ply", scores = own_ / "scores.json";
  const std::string exporting = "export '" + output().string() + "' --force ";
  ASSERT_EQ(run_fovea(exporting + poses.string() + " --format kitti-poses").exit_code, 0);
  const auto score = [&](const std::string& more) {
    EXPECT_EQ(run_fovea(exporting + ply.string() + more).exit_code, 0);
    const ProgramRun run = run_fovea("evaluate " + ply.string() + " '" + drive_.string() +
                                     "' --protocol held-out --hold-out 4:2 --cameras 2 --poses " +
                                     poses.string() + " --json " + scores.string());
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return nlohmann::json::parse(read_text(scores));
  };
  const auto coloured = score(""), all = score(" --uncolored");
  const auto by_camera = score(" --uncolored --where 'camera>=0'");
  EXPECT_EQ(all.at("map_points"), info().at("points"));
  EXPECT_GT(all.at("map_points"), 2 * coloured.at("map_points").get<std::size_t>());
  EXPECT_EQ(all.at("map_points_coloured"), coloured.at("map_points"));
  EXPECT_EQ(by_camera.at("map_points"), coloured.at("map_points"));
  for (const char* key : {"me_mean", "te_mean", "coverage_5cm", "sharpness", "pictures"}) {
    EXPECT_EQ(all.at(key), coloured.at(key)) << key;
  }
}

TEST_F(Program, TheWrittenDriveIsReadBackToTheTruth) {
  // Calibration, geodesy, stamps, poses: with true poses every measured point lies on a surface.
  ASSERT_EQ(map(drive_, "--poses navigation --set motion.compensate=false").exit_code, 0);
  const auto ply = own_ / "map.ply";
  ASSERT_EQ(run_fovea("export '" + output().string() + "' " + ply.string() +
                      " --double --where \"interpolated == 0\"")
                .exit_code,
            0);
  const std::string text = read_text(ply);
  const std::size_t header = text.find("end_header\n") + 11;
  const auto count = std::stoul(text.substr(text.find("element vertex ") + 15));
  ASSERT_GT(count, 1000u);
  const std::size_t stride = (text.size() - header) / count;
  const BoxScene scene = street_scene();
  double worst = 0;
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d p;
    std::memcpy(p.data(), text.data() + header + i * stride, 24);
    worst = std::max(worst, scene.distance(p));
  }
  EXPECT_LT(worst, 2e-3);
}

TEST_F(Program, SameDigestAtAnyThreadCountAndAfterResume) {
  ASSERT_EQ(map(drive_, "--threads 1").exit_code, 0);
  const std::string one = digest();
  EXPECT_EQ(one.size(), 33u);
  ASSERT_EQ(map(drive_, "--threads 2 --force").exit_code, 0);
  EXPECT_EQ(digest(), one);
  ASSERT_EQ(map(drive_, "--force --frames 0:5").exit_code, 0);
  EXPECT_NE(digest(), one);

  // Ctrl-C after the first frames, then --resume: retried with longer waits, for the interruption
  // has to fall into the run.
  for (const char* wait : {"0.3", "0.2", "0.15", "0.1", "0.05"}) {
    const ProgramRun cut =
        run_fovea("map '" + drive_.string() + "' --force -o '" + output().string() + "'",
                  std::string("timeout --preserve-status -s INT ") + wait);
    if (cut.exit_code != 130 || !std::filesystem::exists(output()) ||
        info().at("meta").at("complete") != "0")
      continue;
    EXPECT_THAT(cut.out, HasSubstr("--resume"));
    ASSERT_EQ(map(drive_, "--resume").exit_code, 0);
    EXPECT_EQ(digest(), one);
    return;
  }
}

// As a live sensor would give it: at a million frames a second every one is late, and mapped alike.
TEST_F(Program, LateFramesAreCountedAndNeverDropped) {
  const auto report = own_ / "report.json";
  const auto figures = [&](const std::string& more) {
    const ProgramRun run = map(drive_, "--force --report '" + report.string() + "' " + more);
    EXPECT_EQ(run.exit_code, 0) << run.err;
    return std::pair(nlohmann::json::parse(read_text(report)).at("map"), run.out);
  };
  const auto [unhurried, nothing_said] = figures("");
  EXPECT_TRUE(unhurried.at("late_frames").is_null());
  EXPECT_TRUE(unhurried.at("rate_hz").is_null());
  EXPECT_THAT(nothing_said, Not(HasSubstr("late")));
  const std::string whole = digest();
  for (const char* threads : {"", " --threads 1"}) {
    const auto [live, said] = figures(std::string("--rate 1e6") + threads);
    EXPECT_EQ(live.at("late_frames"), 6);
    EXPECT_EQ(live.at("rate_hz"), 1e6);
    EXPECT_EQ(live.at("frames"), 6);
    EXPECT_THAT(said, HasSubstr("6 frames late"));
    EXPECT_EQ(digest(), whole);
  }
}

TEST_F(Program, ResumeRefusesOtherSettings) {
  ASSERT_EQ(map(drive_).exit_code, 0);
  const ProgramRun run = map(drive_, "--resume --set texture.footprint_m=0.03");
  EXPECT_EQ(run.exit_code, 1);
  EXPECT_THAT(run.err, HasSubstr("config"));
}

TEST_F(Program, WrongUsageIsExitCode2) {
  for (const char* arguments : {"",
                                "nonsense",
                                "map",
                                "map x",
                                "map x -o y --frames five",
                                "map x -o y --variant E12",
                                "map x -o y --preset nonsense",
                                "map x -o y --cameras two",
                                "map x -o y --hold-out eight",
                                "map x -o y --threads -1",
                                "map x -o y --rate 0",
                                "map x -o y --rate nan",
                                "register a b --voxel nan",
                                "export a b.las --utc-offset nan",
                                "export a b.glb --voxel nan",
                                "info",
                                "info a --json --digest",
                                "evaluate a b --protocol nonsense",
                                "evaluate a b --protocol in-sample --color-rules",
                                "evaluate a b --truth --color-rules",
                                "export a",
                                "export a b",
                                "export a b.ply --crs wgs84",
                                "export a b --format 3dtiles --crs utm",
                                "export a b --format mesh --crs utm",
                                "export a b.glb --format mesh",
                                "export a b.glb --voxel 0",
                                "export a b.ply --voxel 0.1",
                                "export a b.las --double",
                                "export a b.las --utc-offset soon",
                                "map x -o y --nonsense"}) {
    const ProgramRun run = run_fovea(arguments);
    EXPECT_EQ(run.exit_code, 2) << arguments << "\n" << run.err;
    EXPECT_THAT(run.err, testing::StartsWith("fovea: error: ")) << arguments;
    EXPECT_EQ(std::count(run.err.begin(), run.err.end(), '\n'), 1) << run.err;
  }
  EXPECT_EQ(run_fovea("--version").exit_code, 0);
  EXPECT_EQ(run_fovea("--help").exit_code, 0);
  EXPECT_THAT(run_fovea("map --help").out, HasSubstr("--hold-out"));
}

TEST_F(Program, BadDrives) {
  expect_failure(map(own_ / "nowhere"), "nowhere");
  std::filesystem::create_directory(own_ / "empty");
  expect_failure(map(own_ / "empty"), "empty");
  expect_failure(map(drive_, "--cameras 7"), "camera");
  expect_failure(map(drive_, "--frames 50:60"), "frame");
}

TEST_F(Program, BadCalibration) {
  const auto drive = damaged_drive();
  const auto file = drive.parent_path() / "calib_velo_to_cam.txt";
  const std::string good = read_text(file);
  std::filesystem::remove(file);
  expect_failure(map(drive), "calib_velo_to_cam.txt");
  write_text(file, "R: 1 0 0 0 1 0 0 0\nT: 0 0 0\n");
  expect_failure(map(drive), "calib_velo_to_cam.txt:1");
  write_text(file, "R: 2 0 0 0 1 0 0 0 1\nT: 0 0 0\n");
  expect_failure(map(drive), "rotation");
  write_text(file, good);
  EXPECT_EQ(map(drive).exit_code, 0);
}

TEST_F(Program, DamagedFramesAreSkippedAndCounted) {
  const auto drive = damaged_drive();
  const auto scan = drive / "velodyne_points/data" / (kitti_stem(1) + ".bin");
  const auto image = drive / "image_02/data" / (kitti_stem(2) + ".png");
  const auto record = drive / "oxts/data" / (kitti_stem(3) + ".txt");
  write_text(scan, read_text(scan) + "odd");
  write_text(image, read_text(image).substr(0, 5000));
  write_text(record, "49.0 8.4 nan 0 0 0\n");
  const auto report = own_ / "report.json";
  const ProgramRun run = map(drive, "--report " + report.string());
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("1 of 6 GPS/INS records cannot be used"));
  const auto figures = nlohmann::json::parse(read_text(report)).at("map");
  EXPECT_EQ(figures.at("frames"), 4);  // one without its record is mapped all the same
  EXPECT_EQ(figures.at("frames_skipped").at("damaged scan"), 1);
  EXPECT_EQ(figures.at("frames_skipped").at("damaged image"), 1);
  EXPECT_EQ(info().at("frames_skipped"), 2);

  std::filesystem::remove(scan);
  std::filesystem::remove(image);
  EXPECT_EQ(map(drive, "--force").exit_code, 0);
}

TEST_F(Program, OddPointsAreDroppedAndCounted) {
  const auto drive = damaged_drive();
  const auto file = drive / "velodyne_points/data" / (kitti_stem(0) + ".bin");
  std::string scan = read_text(file);
  const float odd[] = {std::nanf(""), 0, 0, 0, 1e30f, 0, 0, 0};
  std::memcpy(scan.data(), odd, sizeof(odd));
  write_text(file, scan);
  EXPECT_EQ(map(drive).exit_code, 0);
  EXPECT_EQ(info().at("frames"), 6);
}

TEST_F(Program, BadStamps) {
  const auto drive = damaged_drive();
  const auto file = drive / "velodyne_points/timestamps.txt";
  write_text(file, kitti_stamp(0) + kitti_stamp(1) + "\n" + kitti_stamp(3) + kitti_stamp(2));
  ASSERT_EQ(map(drive).exit_code, 0);
  EXPECT_EQ(info().at("frames"), 3);  // 2 is blank, 4 out of order, 5 has none
  EXPECT_EQ(info().at("frames_skipped"), 3);
  std::filesystem::remove(file);
  const ProgramRun run = map(drive, "--force");
  ASSERT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.err, HasSubstr("10 Hz"));
}

TEST_F(Program, WithoutNavigationItSaysSo) {
  const auto drive = damaged_drive();
  std::filesystem::remove_all(drive / "oxts");
  const ProgramRun run = map(drive);
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("navigation"));
  EXPECT_EQ(info().at("meta").at("georeferenced"), "0");
  const ProgramRun nav = map(drive, "--force --poses navigation");
  EXPECT_EQ(nav.exit_code, 1);
  EXPECT_THAT(nav.err, HasSubstr("navigation"));
}

TEST_F(Program, BadOutputs) {
  const auto to = [&](const std::string& path) {
    return run_fovea("map '" + drive_.string() + "' -o '" + path + "'");
  };
  expect_failure(to((own_ / "no/such/folder/out.fovea").string()), "folder");
  expect_failure(to("/dev/full/out.fovea"), "/dev/full");
  write_text(output(), "something dear");
  const ProgramRun refused = map(drive_);
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("of another kind"));
  EXPECT_EQ(map(drive_, "--force").exit_code, 1);
  EXPECT_EQ(read_text(output()), "something dear");
  write_text(output(), "");
  EXPECT_THAT(map(drive_).err, HasSubstr("--force"));
  EXPECT_EQ(map(drive_, "--force").exit_code, 0);
}

TEST_F(Program, FullDiskLeavesNothingBehind) {
  // A limit on file sizes stands in for the disk: writes fail with EFBIG.
  const auto run = [&](const std::string& more) {
    return run_fovea("map '" + drive_.string() + "' -o '" + output().string() + "' " + more,
                     "ulimit -f 64;");
  };
  expect_failure(run("--set fusion.loop_closure=false"), "out.fovea");
  expect_failure(run(""), "folder for temporary files");  // scans for closures come first
}

TEST_F(Program, ADamagedMapIsToldOfAndTheRestSaved) {
  ASSERT_EQ(map(drive_).exit_code, 0);
  const std::string name = fmt::format("'{}'", output().string());
  const ProgramRun whole = run_fovea("info --check " + name);
  EXPECT_EQ(whole.exit_code, 0);
  EXPECT_THAT(whole.out, HasSubstr("whole"));
  std::string bytes = read_text(output());
  for (std::size_t i = bytes.size() / 3; i < bytes.size() / 2; i += 997) bytes[i] ^= 0x20;
  write_text(output(), bytes);
  const ProgramRun check = run_fovea("info --check " + name);
  EXPECT_EQ(check.exit_code, 1);
  EXPECT_THAT(check.out, HasSubstr("tile "));
  EXPECT_THAT(check.err, HasSubstr("fovea repair"));

  const auto saved = own_ / "saved.fovea";
  const ProgramRun repair = run_fovea(fmt::format("repair {} -o '{}'", name, saved.string()));
  EXPECT_EQ(repair.exit_code, 0) << repair.err;
  EXPECT_THAT(repair.out, HasSubstr("left out: "));
  EXPECT_EQ(run_fovea(fmt::format("info --check '{}'", saved.string())).exit_code, 0);
  EXPECT_GT(MapReader(saved).size(), 1000u);
  // A part cannot be resumed.
  const ProgramRun resume =
      run_fovea(fmt::format("map '{}' -o '{}' --resume", drive_.string(), saved.string()));
  EXPECT_EQ(resume.exit_code, 1);
  EXPECT_THAT(resume.err, HasSubstr("was repaired"));
}

TEST_F(Program, CropAndRecolor) {
  ASSERT_EQ(map(drive_).exit_code, 0);
  const std::string name = fmt::format("'{}'", output().string());
  const auto part = own_ / "part.fovea", again = own_ / "again.fovea";
  const auto crop_with = [&](const std::string& more) {
    return run_fovea(fmt::format("crop {} -o '{}' {}", name, part.string(), more));
  };
  const float middle = MapReader(output()).all_points_local().position[0].x();
  const std::string half = fmt::format("--box=-999,-999,-99,{},999,99", middle);
  const ProgramRun crop = crop_with(half);
  ASSERT_EQ(crop.exit_code, 0) << crop.err;
  EXPECT_LT(MapReader(part).size(), MapReader(output()).size());
  EXPECT_EQ(crop_with(half).exit_code, 1);
  EXPECT_EQ(crop_with("--force").exit_code, 2);
  EXPECT_EQ(crop_with("--force --box 1,2").exit_code, 1);
  EXPECT_GT(MapReader(part).size(), 0u);  // none of these has touched it

  const auto recolor = [&](const std::filesystem::path& to, const char* more) {
    return run_fovea(fmt::format("recolor '{}' '{}' -o '{}' {}", part.string(), drive_.string(),
                                 to.string(), more));
  };
  const ProgramRun run = recolor(again, "--set foveal.far_range_m=12");
  ASSERT_EQ(run.exit_code, 0) << run.err;
  EXPECT_EQ(MapReader(again).size(), MapReader(part).size());
  EXPECT_THAT(MapReader(again).meta().at("config"), HasSubstr("far_range_m = 12"));
  EXPECT_EQ(recolor(part, "--force").exit_code, 1);  // into itself
  EXPECT_EQ(recolor(again, "--force --set map.tile_size_m=8").exit_code, 1);
}

TEST_F(Program, BadConfiguration) {
  const auto config = own_ / "my.toml";
  write_text(config, "[surface]\nspacng_m = 2\n");
  expect_failure(map(drive_, "--config " + config.string()), "my.toml:2");
  write_text(config, "[surface]\nspacing_m = \"two\"\n");
  expect_failure(map(drive_, "--config " + config.string()), "surface.spacing_m");
  write_text(config, "[surface]\nspacing_m = 77\n");
  expect_failure(map(drive_, "--config " + config.string()), "my.toml:2");
  expect_failure(map(drive_, "--set nonsense.key=1"), "nonsense.key");
  expect_failure(map(drive_, "--config " + (own_ / "none.toml").string()), "none.toml");
}

/// Where a line of a text begins.
std::size_t line_begin(const std::string& text, int line) {
  std::size_t begin = 0;
  for (int i = 0; i < line; ++i) begin = text.find('\n', begin) + 1;
  return begin;
}

TEST_F(Program, GivenPosesAreUsed) {
  ASSERT_EQ(map(drive_).exit_code, 0);
  const auto poses = own_ / "poses.txt";
  ASSERT_EQ(
      run_fovea("export '" + output().string() + "' " + poses.string() + " --format kitti-poses")
          .exit_code,
      0);
  ASSERT_EQ(map(drive_, "--force --poses " + poses.string()).exit_code, 0);
  const auto again = own_ / "again.txt";
  ASSERT_EQ(
      run_fovea("export '" + output().string() + "' " + again.string() + " --format kitti-poses")
          .exit_code,
      0);
  EXPECT_EQ(read_text(again), read_text(poses));
  // Fewer poses than frames: the rest is registered, and lies nearly where it did.
  write_text(poses, read_text(poses).substr(0, line_begin(read_text(poses), 4)));
  const ProgramRun few = map(drive_, "--force --poses " + poses.string());
  ASSERT_EQ(few.exit_code, 0) << few.err;
  EXPECT_THAT(few.out, HasSubstr("4 poses for 6 frames: the frames after them are registered"));
  EXPECT_EQ(map(drive_, "--force --frames 1:6 --poses " + poses.string()).exit_code, 1);

  write_text(poses, "1 0 0 0 0 1 0 0 0 0 1\n");
  const ProgramRun bad = map(drive_, "--force --poses " + poses.string());
  EXPECT_EQ(bad.exit_code, 1);
  EXPECT_THAT(bad.err, HasSubstr("poses.txt:1"));
}

TEST_F(Program, BadMaps) {
  const auto expect = [&](const std::string& contents, const std::string& says) {
    const auto file = own_ / "bad.fovea";
    write_text(file, contents);
    const ProgramRun run = run_fovea("info '" + file.string() + "'");
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.err, HasSubstr(says));
  };
  expect("", "bad.fovea");
  expect("this is no database", "bad.fovea");
  EXPECT_EQ(run_fovea("info " + (own_ / "missing.fovea").string()).exit_code, 1);
  EXPECT_EQ(run_fovea("export " + (own_ / "missing.fovea").string() + " x.ply").exit_code, 1);
}

TEST_F(Program, UpsampleAndRegister) {
  const auto scan = [&](int i) {
    const auto file = drive_ / "velodyne_points/data" / (kitti_stem(i) + ".bin");
    return fmt::format("'{}' ", file.string());
  };
  const auto ply = own_ / "dense.ply";
  const ProgramRun dense = run_fovea("upsample " + scan(0) + "'" + drive_.parent_path().string() +
                                     "' " + ply.string() + " --rate 2 --camera 2");
  ASSERT_EQ(dense.exit_code, 0) << dense.err;
  EXPECT_THAT(read_text(ply), testing::StartsWith("ply\n"));
  // Point to point is drawn towards no motion by the scan's own rings (docs/method.md 2): its
  // accuracy is the unit tests' business, here it meets a scan with itself.
  for (const auto& [method, source, step, tolerance] :
       {std::tuple{"gicp", 1, 0.8, 0.1}, {"plane", 1, 0.8, 0.2}, {"icp", 0, 0.0, 0.1}}) {
    const ProgramRun run = run_fovea("register " + scan(source) + scan(0) + "--method " + method);
    ASSERT_EQ(run.exit_code, 0) << run.err;
    std::istringstream numbers(run.out);
    std::vector<double> pose{std::istream_iterator<double>(numbers), {}};
    ASSERT_EQ(pose.size(), 12u);
    EXPECT_NEAR(pose[3], step, tolerance) << method;
  }
}

}  // namespace fovea::program_test
