// A drive played again and again, each time from where the last one ended: hours of input from ten
// seconds, for what only long drives show (memory, latency). Scans and images are links to the
// first ones: nothing is stored twice.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "fovea/core/read_file.h"
#include "fovea/drive/kitti/oxts.h"
#include "fovea/drive/time_stamps.h"
#include "fovea/errors.h"
#include "fovea/geometry/geodesy.h"
#include "fovea/simulation/drive_texts.h"

namespace {

namespace fs = std::filesystem;
using namespace fovea;

/// "0000000012.png" of a frame.
std::string file_name(int frame, const std::string& ending) {
  return fmt::format("{:010d}{}", frame, ending);
}

std::ofstream create(const fs::path& path) {
  fs::create_directories(path.parent_path());
  std::ofstream file(path);
  file.exceptions(std::ios::failbit | std::ios::badbit);
  return file;
}

/// Where a run of the drive begins: everything in it is turned about the vertical and moved there.
struct Start {
  GeodeticPoint place;
  double turn = 0;  // rad, counter-clockwise seen from above, from the drive as it was
};

/// A record as read: what is not of position and attitude is kept as it is.
struct Record {
  OxtsRecord oxts;
  std::string rest;
};

Record read_record(const fs::path& file) {
  const std::vector<std::uint8_t> bytes = read_bytes(file);
  const std::string text(bytes.begin(), bytes.end());
  const auto record = parse_oxts(text);
  if (const auto* reason = std::get_if<std::string>(&record)) {
    throw InputError("the GPS/INS record " + *reason, file.string(), "replay a whole drive");
  }
  std::istringstream words(text);
  std::string word, rest;
  for (int i = 0; words >> word; ++i) rest += i < 6 ? "" : " " + word;
  return {std::get<OxtsRecord>(record), rest};
}

class Replay {
 public:
  Replay(const fs::path& drive, const fs::path& folder, int times)
      : from_(fs::canonical(drive)),
        to_(folder / from_.parent_path().filename() / from_.filename()),
        times_(times) {
    const NumberedFiles records = list_numbered_files(from_ / "oxts/data", {".txt"});
    const auto period = median_period(read_date_times(from_ / "velodyne_points/timestamps.txt"));
    if (records.size() < 2 || !period) {
      throw InputError("the drive has no two GPS/INS records or time stamps", from_.string(),
                       "give a longer one");
    }
    frames_ = records.rbegin()->first + 1;
    for (int i = 0; i < frames_; ++i) {
      records_.push_back(read_record(from_ / "oxts/data" / file_name(i, ".txt")));
    }
    lap_ = frames_ * from_seconds(*period);
  }

  void write() const {
    fs::create_directories(to_);
    for (const auto& entry : fs::directory_iterator(from_.parent_path())) {  // the calibration
      const std::string name = entry.path().filename().string();
      if (name.starts_with("calib_")) fs::copy(entry.path(), to_.parent_path() / name);
    }
    for (const auto& entry : fs::directory_iterator(from_)) {
      const std::string name = entry.path().filename().string();
      if (name == "velodyne_points" || name.starts_with("image_")) link_files(name);
      if (entry.is_directory() && fs::exists(entry.path() / "timestamps.txt")) write_stamps(name);
    }
    write_records();
  }

  int frames() const { return frames_ * times_; }
  const fs::path& folder() const { return to_; }

 private:
  void link_files(const std::string& name) const {
    fs::create_directories(to_ / name / "data");
    for (const auto& [frame, file] :
         list_numbered_files(from_ / name / "data", {".bin", ".png", ".jpg", ".jpeg"})) {
      for (int lap = 0; lap < times_; ++lap) {
        fs::create_symlink(file, to_ / name / "data" /
                                     file_name(lap * frames_ + frame, file.extension().string()));
      }
    }
  }

  void write_stamps(const std::string& name) const {
    for (const char* stamps : {"timestamps.txt", "timestamps_start.txt", "timestamps_end.txt"}) {
      if (!fs::exists(from_ / name / stamps)) continue;
      const TimeStamps times = read_date_times(from_ / name / stamps);
      std::ofstream file = create(to_ / name / stamps);
      for (int lap = 0; lap < times_; ++lap) {
        for (const std::optional<TimeNs>& time : times.times) {
          file << (time ? date_time_text(*time + lap * lap_) : "") << '\n';
        }
      }
    }
  }

  /// Where the next run begins: a frame's motion beyond this run's last frame.
  Start after(const Start& start) const {
    const LocalTangentPlane plane(records_.front().oxts.position);
    const auto place = [&](const Record& record) {
      return Eigen::Vector3d(plane.T_local_enu(record.oxts.position).translation());
    };
    const Record &last = records_.back(), &before = records_[records_.size() - 2];
    const Eigen::Vector3d end = 2 * place(last) - place(before);
    return {moved(start, end), start.turn + last.oxts.yaw - records_.front().oxts.yaw};
  }

  /// @param p  m, about the drive's first record, east, north, up there
  static GeodeticPoint moved(const Start& start, const Eigen::Vector3d& p) {
    const Eigen::AngleAxisd turn(start.turn, Eigen::Vector3d::UnitZ());
    return LocalTangentPlane(start.place).to_geodetic(turn * p);
  }

  void write_records() const {
    const LocalTangentPlane plane(records_.front().oxts.position);
    Start start{records_.front().oxts.position, 0};
    for (int lap = 0; lap < times_; ++lap, start = after(start)) {
      for (int i = 0; i < frames_; ++i) {
        const Record& record = records_[std::size_t(i)];
        const GeodeticPoint p = moved(start, plane.T_local_enu(record.oxts.position).translation());
        const double yaw = std::remainder(record.oxts.yaw + start.turn, 2 * std::numbers::pi);
        create(to_ / "oxts/data" / file_name(lap * frames_ + i, ".txt")) << fmt::format(
            "{:.17g} {:.17g} {:.17g} {:.17g} {:.17g} {:.17g}{}\n", p.latitude, p.longitude,
            p.altitude, record.oxts.roll, record.oxts.pitch, yaw, record.rest);
      }
    }
  }

  fs::path from_, to_;
  int times_;
  int frames_ = 0;               // of a run
  std::vector<Record> records_;  // of a run
  TimeNs lap_ = 0;               // duration of a run
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("A KITTI raw drive played again and again, each time from where the last one ended.",
               "replay_drive");
  std::string drive, folder;
  int times = 2;
  app.add_option("drive", drive, "The drive: .../DATE/DATE_drive_NNNN_sync")->required();
  app.add_option("--times", times, "How often")->check(CLI::Range(1, 10'000))->required();
  app.add_option("-o,--output", folder, "Folder to make")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    if (fs::exists(folder)) {
      throw OutputError("the output exists", folder, "remove it or give another name");
    }
    const Replay replay(drive, folder, times);
    replay.write();
    fmt::print("{}: {} frames\n", replay.folder().string(), replay.frames());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "replay_drive: error: {}\n", error.what());
    return 1;
  }
}
