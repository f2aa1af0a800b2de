#include "fovea/evaluation/drive_in_city.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <optional>
#include <utility>

#include "fovea/city/city_frames.h"
#include "fovea/core/path_name.h"
#include "fovea/errors.h"
#include "fovea/pipeline/drive_match.h"

namespace fovea {
namespace {

/// A tile around a place of the vehicle has the place's frame. Navigation may be this far off, m.
constexpr double kNavigationReach = 40;
/// Places of the navigation are this far apart, m.
constexpr double kStep = 5;
constexpr const char* kOtherDrive =
    "give a drive that city.json names, or use this one all the same with --foreign";

std::vector<std::size_t> tiles_around(const City& city, const DriveInfo& drive) {
  if (!drive.navigation || !drive.origin) {
    std::vector<std::size_t> all(city.tiles.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return all;
  }
  const RigidMotion T_city_drive = LocalTangentPlane(city.origin).T_local_enu(*drive.origin);
  std::vector<Eigen::Vector3d> path;
  for (const StampedPose& pose : drive.navigation->poses()) {
    const Eigen::Vector3d place = T_city_drive * pose.T_local_body.translation();
    if (path.empty() || (path.back() - place).norm() >= kStep) path.push_back(place);
  }
  return city.tiles_near(path, kNavigationReach);
}

/// Reads tiles, and compares each map of the city with the drive once.
class DriveFinder {
 public:
  DriveFinder(const City& city, const FrameSource& drive, bool foreign)
      : city_(city), drive_(drive), name_(name_of(drive.info().path)), foreign_(foreign) {}

  void read(const CityTileFile& file) {
    const MapReader map(file.map);
    const std::vector<CityFrames> all = frames_of_tile(city_, file.tile, map);
    compare(all, map, file.map);
    for (const CityFrames& of_map : all) {
      if (is_drive_.at(of_map.map_id())) take(of_map);
    }
  }

  DriveInCity result() {
    if (result_.numbers.empty()) {
      throw InputError(fmt::format("the city was not made of the drive '{}'{}", name_,
                                   difference_.empty() ? "" : ": " + difference_),
                       city_.folder.string(), kOtherDrive);
    }
    for (auto& [number, frame] : frames_) result_.frames.push_back(std::move(frame));
    return std::move(result_);
  }

 private:
  /// Finds out which of the maps in a tile are of the drive.
  void compare(const std::vector<CityFrames>& all, const MapReader& map,
               const std::filesystem::path& path) {
    const auto is_known = [&](const CityFrames& of_map) {
      return is_drive_.contains(of_map.map_id());
    };
    if (std::all_of(all.begin(), all.end(), is_known)) return;
    std::vector<int> matches;
    if (foreign_) {
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (all[i].drive.name == name_) matches.push_back(static_cast<int>(i));
      }
    } else {
      matches = matching(map, path);
    }
    for (std::size_t i = 0; i < all.size(); ++i) {
      const bool matches_drive =
          std::count(matches.begin(), matches.end(), static_cast<int>(i)) > 0;
      is_drive_.try_emplace(all[i].map_id(), matches_drive);
    }
  }

  std::vector<int> matching(const MapReader& map, const std::filesystem::path& path) {
    try {
      DriveMatch match = match_drive(map, drive_, path);
      result_.notes = std::move(match.notes);
      return std::move(match.drives);
    } catch (const InputError& error) {  // the tables were read before: they are not damaged
      const std::string& problem = error.problem();
      difference_ = problem.substr(problem.find(": ") + 2);
      return {};
    }
  }

  /// Takes the frames of a map of the drive.
  void take(const CityFrames& of_map) {
    result_.name = of_map.drive.name;
    std::map<int, int>& numbers = result_.numbers[of_map.map_id()];
    for (FrameRecord frame : of_map.frames) {
      const std::optional<int> number = number_in_drive(frame);
      if (!number) continue;
      numbers[frame.index] = *number;
      frame.index = *number;
      const auto [place, is_new] = frames_.try_emplace(*number, frame);
      if (!is_new && frame.status == FrameStatus::kMapped) place->second.status = frame.status;
    }
  }

  /// By the stamp of the frame: a copy of the drive may have other numbers.
  std::optional<int> number_in_drive(const FrameRecord& frame) {
    if (foreign_ || !frame.stamp) return frame.index;
    if (numbers_by_stamp_.empty()) {
      for (int index = drive_.info().begin; index < drive_.info().end; ++index) {
        if (const auto stamp = drive_.stamp(index)) numbers_by_stamp_.emplace(*stamp, index);
      }
    }
    const auto found = numbers_by_stamp_.find(*frame.stamp);
    return found == numbers_by_stamp_.end() ? std::nullopt : std::optional(found->second);
  }

  const City& city_;
  const FrameSource& drive_;
  std::string name_;
  bool foreign_;
  std::map<std::string, bool> is_drive_;  // by map_id()
  std::map<TimeNs, int> numbers_by_stamp_;
  std::map<int, FrameRecord> frames_;
  DriveInCity result_;
  std::string difference_;  // of the latest map that is not of the drive
};

}  // namespace

DriveInCity find_drive_in_city(const City& city, const FrameSource& drive, bool foreign) {
  const std::vector<std::size_t> tiles = tiles_around(city, drive.info());
  if (tiles.empty()) {
    throw InputError(
        fmt::format("the drive '{}' lies outside of the city", name_of(drive.info().path)),
        city.folder.string(), "give a drive of this place");
  }
  DriveFinder finder(city, drive, foreign);
  for (const std::size_t number : tiles) finder.read(city.tiles[number]);
  return finder.result();
}

}  // namespace fovea
