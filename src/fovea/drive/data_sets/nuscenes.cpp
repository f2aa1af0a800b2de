// Layout: nuscenes.org/nuscenes#data-format. Every table is a JSON list of records with a token.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "fovea/core/input_file.h"
#include "fovea/drive/data_sets/data_set.h"
#include "fovea/drive/kitti/kitti_scan.h"
#include "fovea/errors.h"

namespace fovea {
namespace {

using nlohmann::json;
using Table = std::map<std::string, json>;  // by token

constexpr const char* kLidar = "LIDAR_TOP";
/// The cameras by number. Camera 2 colors a map unless the user chooses others: the one ahead.
constexpr std::array<std::string_view, 6> kCameras = {"CAM_FRONT_LEFT", "CAM_FRONT_RIGHT",
                                                      "CAM_FRONT",      "CAM_BACK_LEFT",
                                                      "CAM_BACK_RIGHT", "CAM_BACK"};
constexpr TimeNs kNsPerMicrosecond = 1000;
/// The HDL-32E turns clockwise, 20 times a second. A sweep begins and ends on its left, which is at
/// 180 degrees since its x axis points right. Its stamp is that of its end.
constexpr SweepTiming kSweep{0.05, SweepDirection::kClockwise, std::numbers::pi, 1};

class Tables {
 public:
  explicit Tables(const std::filesystem::path& root) {
    std::error_code unknown;
    for (const auto& entry : std::filesystem::directory_iterator(root, unknown)) {
      const std::string name = entry.path().filename().string();
      if (name.starts_with("v1.0-") && std::filesystem::exists(entry.path() / "scene.json")) {
        folders_.push_back(entry.path());
      }
    }
    if (folders_.size() == 1) return;
    throw InputError(fmt::format("there are {} folders v1.0-* with a scene.json", folders_.size()),
                     root.string(), "give the folder of nuScenes with the tables of one version");
  }

  /// The records of a table for which is_wanted(record) holds. The others take no memory.
  template <class IsWanted>
  Table read(const std::string& name, IsWanted&& is_wanted) const {
    const std::filesystem::path file = folders_.front() / (name + ".json");
    Table table;
    InputFile input(file, kStreamedFile);
    try {
      const json discarded =
          json::parse(input.stream(), [&](int depth, json::parse_event_t event, json& record) {
            if (depth != 1 || event != json::parse_event_t::object_end) return true;
            if (is_wanted(record)) table.emplace(record.at("token").get<std::string>(), record);
            return false;
          });
    } catch (const json::exception& error) {
      throw InputError(fmt::format("the table is damaged ({})", error.what()), file.string(),
                       "restore it from the archive");
    }
    return table;
  }

 private:
  std::vector<std::filesystem::path> folders_;
};

const json& record_of(const Table& table, const std::string& token, const char* name) {
  const auto found = table.find(token);
  if (found != table.end()) return found->second;
  throw InputError(fmt::format("there is no record '{:.40}'", token),
                   fmt::format("{}.json of nuScenes", name), "restore the tables from the archive");
}

Eigen::Quaterniond checked_rotation(const std::array<double, 4>& q) {
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (std::abs(rotation.norm() - 1) < 0.01) return rotation.normalized();
  throw InputError("a rotation is no quaternion of length 1", "the tables of nuScenes",
                   "restore the tables from the archive");
}

QuaternionMotion motion_of(const json& record) {
  const auto t = record.at("translation").get<std::array<double, 3>>();
  const auto q = record.at("rotation").get<std::array<double, 4>>();  // w first
  return {{t[0], t[1], t[2]}, checked_rotation(q)};
}

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// A file of a sensor.
struct Data {
  TimeNs stamp;
  std::filesystem::path file;
  std::string ego_pose, calibrated_sensor;  // tokens
  int width, height;                        // of an image
};

class Scene {
 public:
  explicit Scene(const DataSetOptions& options) : options_(options), tables_(options.root) {
    find_scene();
    find_data();
  }

  DataSetFigures convert() {
    const std::vector<Data>& scans = data_.at(kLidar);
    std::vector<RecordedCamera> cameras;
    int further = int(kCameras.size());  // number of a camera of another name
    for (const auto& [channel, images] : data_) {
      if (channel == kLidar) continue;
      const auto place = std::find(kCameras.begin(), kCameras.end(), channel);
      const int number = place == kCameras.end() ? further++ : int(place - kCameras.begin());
      cameras.push_back(camera_of(channel, number, images));
    }
    AdapterWriter writer(options_.output, cameras, {options_.force, false, kSweep});
    std::map<std::string, std::size_t> next;  // image, by channel
    DataSetFigures figures;
    DroppedPoints dropped;
    for (std::size_t i = 0; i < scans.size(); ++i) {
      const Data& scan = scans[i];
      if (!options_.contains(scan.stamp, scans.front().stamp)) continue;
      const QuaternionMotion T_world_lidar =
          motion_of(record_of(poses_, scan.ego_pose, "ego_pose")) * T_ego(scan);
      const LidarScan points = read_kitti_scan(scan.file);
      add_scan(scan.file, scan.stamp, points, images_before(scan.stamp, next),
               T_world_lidar.matrix(), writer);
      dropped += points.dropped;
      options_.progress(int(i + 1), int(scans.size()));
    }
    if (writer.scans() == 0) options_.throw_nothing_left();
    static_cast<DriveWriterFigures&>(figures) = writer.close();
    figures.dropped += dropped;
    return figures;
  }

 private:
  void find_scene() {
    std::vector<std::string> names;
    std::map<std::string, std::string> token_of_name;
    for (const auto& [token, record] : tables_.read("scene", [](const json&) { return true; })) {
      names.push_back(record.at("name"));
      token_of_name[names.back()] = token;
    }
    const std::string scene = token_of_name.at(choose_scene(
        names, options_, [&](const std::string& name) { return name == options_.scene; }));
    samples_ = tables_.read("sample",
                            [&](const json& record) { return record.at("scene_token") == scene; });
  }

  void find_data() {
    const auto all = [](const json&) { return true; };
    calibration_ = tables_.read("calibrated_sensor", all);
    const Table sensors = tables_.read("sensor", all);
    std::set<std::string> poses;
    const Table data = tables_.read("sample_data", [&](const json& record) {
      return samples_.contains(record.at("sample_token").get<std::string>());
    });
    for (const auto& [token, record] : data) {
      const std::string calibrated = record.at("calibrated_sensor_token");
      const json& sensor = record_of(
          sensors, record_of(calibration_, calibrated, "calibrated_sensor").at("sensor_token"),
          "sensor");
      const std::string channel = sensor.at("channel");
      if (channel != kLidar && sensor.at("modality") != "camera") continue;
      poses.insert(record.at("ego_pose_token").get<std::string>());
      data_[channel].push_back({record.at("timestamp").get<TimeNs>() * kNsPerMicrosecond,
                                options_.root / record.at("filename").get<std::string>(),
                                record.at("ego_pose_token"), calibrated, record.value("width", 0),
                                record.value("height", 0)});
    }
    if (!data_.contains(kLidar)) {
      throw InputError("the scene has no scans of LIDAR_TOP", options_.root.string(),
                       "restore the tables from the archive");
    }
    for (auto& [channel, files] : data_) {
      std::sort(files.begin(), files.end(),
                [](const Data& a, const Data& b) { return a.stamp < b.stamp; });
    }
    poses_ = tables_.read("ego_pose", [&](const json& record) {
      return poses.contains(record.at("token").get<std::string>());
    });
  }

  QuaternionMotion T_ego(const Data& data) const {
    return motion_of(record_of(calibration_, data.calibrated_sensor, "calibrated_sensor"));
  }

  RecordedCamera camera_of(std::string name, int index, const std::vector<Data>& images) const {
    const Data& first = images.front();
    const json& calibrated = record_of(calibration_, first.calibrated_sensor, "calibrated_sensor");
    const auto K = calibrated.at("camera_intrinsic").get<std::array<std::array<double, 3>, 3>>();
    return {lower_case(std::move(name)),
            index,
            {first.width, first.height, K[0][0], K[1][1], K[0][2], K[1][2], Lens()},
            T_ego(data_.at(kLidar).front()).inverse() * motion_of(calibrated)};
  }

  /// Images up to a stamp that are not written yet.
  std::vector<DriveImage> images_before(TimeNs stamp,
                                        std::map<std::string, std::size_t>& next) const {
    std::vector<DriveImage> before;
    for (const auto& [channel, images] : data_) {
      if (channel == kLidar) continue;
      std::size_t& i = next[channel];
      for (; i < images.size() && images[i].stamp <= stamp; ++i) {
        const TimeNs half_sweep = kNsPerSecond / 40;
        if (options_.contains(images[i].stamp + half_sweep, data_.at(kLidar).front().stamp)) {
          before.push_back({lower_case(channel), images[i].stamp, images[i].file});
        }
      }
    }
    return before;
  }

  const DataSetOptions& options_;
  Tables tables_;
  Table samples_, calibration_, poses_;
  std::map<std::string, std::vector<Data>> data_;  // by channel, in order of stamps
};

/// Runs `read`. A record of another form is a fault of the data set.
template <class Read>
auto reading(const std::filesystem::path& root, Read&& read) {
  try {
    return read();
  } catch (const json::exception& error) {
    throw InputError(fmt::format("a record is damaged ({})", error.what()), root.string(),
                     "restore the tables from the archive");
  }
}

}  // namespace

DataSetFigures convert_nuscenes(const DataSetOptions& options) {
  return reading(options.root, [&] { return Scene(options).convert(); });
}

std::vector<std::string> nuscenes_scenes(const std::filesystem::path& root) {
  return reading(root, [&] {
    std::vector<std::string> names;
    for (const auto& [token, record] :
         Tables(root).read("scene", [](const json&) { return true; })) {
      names.push_back(record.at("name"));
    }
    std::sort(names.begin(), names.end());
    return names;
  });
}

}  // namespace fovea
