#include "fovea/pipeline/drive_match.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <set>
#include <utility>

#include "fovea/core/path_name.h"
#include "fovea/drive/renumbered_drive.h"
#include "fovea/errors.h"
#include "fovea/map/drive_fingerprint.h"

namespace fovea {
namespace {

constexpr const char* kRemedy =
    "give the drive that 'fovea info' names, or use this one all the same with --foreign";

using Frames = std::vector<FrameRecord>;
/// Frame numbers by stamp.
using Stamps = std::map<TimeNs, int>;
/// Frame numbers in the drive by frame numbers in the map.
using Numbers = std::map<int, int>;

Stamps stamps_of(const FrameSource& drive) {
  Stamps stamps;
  for (int index = drive.info().begin; index < drive.info().end; ++index) {
    if (const auto stamp = drive.stamp(index)) stamps.emplace(*stamp, index);
  }
  return stamps;
}

Stamps stamps_of(const Frames& frames) {
  Stamps stamps;
  for (const FrameRecord& frame : frames) {
    if (frame.stamp) stamps.emplace(*frame.stamp, frame.index);
  }
  return stamps;
}

/// The smaller number of stamps in the common time of both.
std::size_t comparable_stamps(const Stamps& a, const Stamps& b) {
  if (a.empty() || b.empty()) return 0;
  const TimeNs first = std::max(a.begin()->first, b.begin()->first),
               last = std::min(a.rbegin()->first, b.rbegin()->first);
  if (first > last) return 0;
  const auto count = [&](const Stamps& stamps) {
    return static_cast<std::size_t>(
        std::distance(stamps.lower_bound(first), stamps.upper_bound(last)));
  };
  return std::min(count(a), count(b));
}

Numbers common_frames(const Stamps& in_map, const Stamps& in_drive) {
  Numbers numbers;
  for (const auto& [stamp, index] : in_map) {
    if (const auto found = in_drive.find(stamp); found != in_drive.end()) {
      numbers.emplace(index, found->second);
    }
  }
  return numbers;
}

/// Whether the motions by navigation agree in map and drive, between the first common frame and two
/// others. False if one has no navigation.
bool has_same_navigation(const Frames& frames, const Numbers& numbers, const FrameSource& drive) {
  if (!drive.info().navigation) return false;
  struct Poses {
    RigidMotion in_map, in_drive;
  };
  std::vector<Poses> poses;
  for (const FrameRecord& frame : frames) {
    if (!numbers.contains(frame.index) || !frame.stamp || !frame.T_local_lidar_navigation) continue;
    const auto in_drive = drive.info().navigation->at(*frame.stamp);
    if (in_drive) poses.push_back({*frame.T_local_lidar_navigation, *in_drive});
  }
  if (poses.size() < 2) return false;
  // The two local frames may have different origins.
  constexpr double kTolerance = 0.005;  // m, rad
  const auto agree = [&](const Poses& a, const Poses& b) {
    const RigidMotion difference =
        (a.in_map.inverse() * b.in_map).inverse() * (a.in_drive.inverse() * b.in_drive);
    return log_se3(difference).norm() < kTolerance;
  };
  return agree(poses.front(), poses.back()) && agree(poses.front(), poses[poses.size() / 2]);
}

/// Whether one of two scans may be the other without some of its rings.
bool may_be_thinned(double points_a, double points_b) {
  constexpr double kLeastShare = 0.1;  // of a ring or more
  return std::abs(points_a - points_b) > kLeastShare * std::max(points_a, points_b);
}

/// Delays of a camera's images after their scans. The camera's fingerprint contains the median,
/// which changes if images are removed.
std::set<TimeNs> image_delays(const Frames& frames, const DriveInfo& drive, std::size_t slot) {
  const Camera& camera = drive.calibration.cameras[slot];
  std::set<TimeNs> delays;
  for (const FrameRecord& frame : frames) {
    for (const ViewRecord& view : frame.views) {
      if (view.camera == camera.index && view.stamp && frame.stamp) {
        delays.insert(*view.stamp - *frame.stamp);
      }
    }
  }
  if (slot < drive.image_offsets.size()) {
    for (const auto& [index, offset] : drive.image_offsets[slot]) {
      delays.insert(from_seconds(camera.image_delay + offset));
    }
  }
  return delays;
}

/// Whether a camera has the fingerprint "2:HASH", with its median delay or that of any image.
bool has_fingerprint(const std::string& fingerprint, const Frames& frames, const DriveInfo& drive,
                     std::size_t slot) {
  Calibration one;
  one.cameras = {drive.calibration.cameras[slot]};
  if (calibration_fingerprint(one, {}) == fingerprint) return true;
  const std::set<TimeNs> delays = image_delays(frames, drive, slot);
  return std::any_of(delays.begin(), delays.end(), [&](TimeNs delay) {
    one.cameras[0].image_delay = seconds(delay);
    return calibration_fingerprint(one, {}) == fingerprint;
  });
}

/// Names the differences between the common parts of two calibrations; empty if there are none.
std::optional<std::string> different_calibration(const std::string& stored, const Frames& frames,
                                                 const DriveInfo& drive) {
  const std::vector<Camera>& cameras = drive.calibration.cameras;
  const auto in_drive = fingerprint_parts(calibration_fingerprint(drive.calibration, drive.lidars));
  std::string mapped, now;
  for (const auto& [name, hash] : fingerprint_parts(stored)) {
    const auto found = in_drive.find(name);
    if (found == in_drive.end()) continue;
    const auto camera =
        std::find_if(cameras.begin(), cameras.end(),
                     [&part = name](const Camera& c) { return fmt::to_string(c.index) == part; });
    const auto slot = static_cast<std::size_t>(camera - cameras.begin());
    if (camera != cameras.end() && has_fingerprint(name + hash, frames, drive, slot)) continue;
    mapped += fmt::format("{}{} ", name, hash);
    now += fmt::format("{}{} ", name, found->second);
  }
  return calibration_difference(mapped, now);
}

/// The frames of one drive of a map.
Frames frames_of(const Frames& frames, const DriveRecord& drive) {
  Frames of_drive;
  std::copy_if(frames.begin(), frames.end(), std::back_inserter(of_drive),
               [&](const FrameRecord& frame) { return drive.has_frame(frame.index); });
  return of_drive;
}

/// The drives of a map. A repaired map without drives counts as one drive.
std::vector<DriveRecord> drives_of(const MapReader& map) {
  std::vector<DriveRecord> drives = map.drives();
  if (!drives.empty()) return drives;
  DriveRecord& any = drives.emplace_back();
  any.end_frame = std::numeric_limits<int>::max();
  return drives;
}

/// Whether the frames of a map have the same stamps as the drive's frames of the same numbers.
bool has_same_numbers(const Frames& frames, const FrameSource& drive) {
  return std::all_of(frames.begin(), frames.end(), [&](const FrameRecord& frame) {
    const DriveInfo& info = drive.info();
    if (!frame.stamp || frame.index < info.begin || frame.index >= info.end) return true;
    const std::optional<TimeNs> stamp = drive.stamp(frame.index);
    return !stamp || *stamp == *frame.stamp;
  });
}

}  // namespace

std::optional<std::string> scan_difference(const std::vector<FrameRecord>& frames,
                                           const std::map<int, int>& number_in_drive,
                                           const FrameSource& drive, bool allow_thinned) {
  constexpr const char* kPoints = "points_scan";
  std::vector<const FrameRecord*> candidates;
  for (const FrameRecord& frame : frames) {
    if (number_in_drive.contains(frame.index) && frame.has(kPoints)) candidates.push_back(&frame);
  }
  // A thinned drive may lack most frames.
  constexpr std::size_t kCompared = 3, kTried = 100;
  allow_thinned = allow_thinned && has_same_navigation(frames, number_in_drive, drive);
  int compared = 0, equal = 0;
  std::optional<std::string> difference;
  for (std::size_t k = 0; k < kCompared; ++k) {
    const std::size_t begin = k * candidates.size() / kCompared,
                      end = std::min((k + 1) * candidates.size() / kCompared, begin + kTried);
    for (std::size_t i = begin; i < end; ++i) {
      const LoadedFrame loaded = drive.load(number_in_drive.at(candidates[i]->index));
      const auto* frame = std::get_if<Frame>(&loaded);
      if (frame == nullptr) continue;
      const double in_map = candidates[i]->figures.at(kPoints), now = as_figure(frame->scan.size());
      ++compared;
      if (in_map == now || (allow_thinned && may_be_thinned(in_map, now))) {
        ++equal;
      } else {
        difference = fmt::format("its scan {} has {} points, that of the map has {}", frame->index,
                                 frame->scan.size(), in_map);
      }
      break;
    }
  }
  return 2 * equal >= compared ? std::nullopt : difference;
}

DriveMatch match_drive(const MapReader& map, const FrameSource& drive,
                       const std::filesystem::path& path) {
  const Frames all_frames = map.frames();
  const std::vector<DriveRecord> drives = drives_of(map);
  const Stamps in_drive = stamps_of(drive);
  DriveMatch match;
  std::string calibration, difference;
  for (std::size_t k = 0; k < drives.size(); ++k) {
    const Frames frames = frames_of(all_frames, drives[k]);
    const Stamps in_map = stamps_of(frames);
    const Numbers numbers = common_frames(in_map, in_drive);
    const std::size_t comparable = comparable_stamps(in_map, in_drive);
    if (numbers.empty() || double(numbers.size()) < kMinCommonStamps * double(comparable)) {
      difference = in_drive.empty() ? "it has no stamps"
                   : comparable == 0
                       ? "their stamps have no common time"
                       : fmt::format("{} of {} stamps within their common time are equal",
                                     numbers.size(), comparable);
      continue;
    }
    if (!drives[k].calibration_fingerprint) {
      match.notes = {
          "the map has no fingerprint of its drive: only the stamps of the frames are compared"};
    } else if (const auto scans = scan_difference(frames, numbers, drive, /*allow_thinned=*/true)) {
      difference = *scans;
      continue;
    } else if (const auto cameras = different_calibration(*drives[k].calibration_fingerprint,
                                                          frames, drive.info())) {
      calibration = *cameras;
      continue;
    }
    match.drives.push_back(static_cast<int>(k));
    match.number_in_drive.insert(numbers.begin(), numbers.end());
  }
  if (match.drives.empty()) {
    const std::string name = name_of(drive.info().path);
    throw InputError(
        calibration.empty()
            ? fmt::format("the map was not made of the drive '{}': {}", name, difference)
            : fmt::format("the drive '{}' has another calibration than the map: {}", name,
                          calibration),
        path.string(), kRemedy);
  }
  match.keeps_numbers = drives.size() == 1 && has_same_numbers(all_frames, drive);
  return match;
}

std::unique_ptr<FrameSource> with_map_numbers(std::unique_ptr<FrameSource> drive,
                                              const DriveMatch& match) {
  if (match.keeps_numbers) return drive;
  return std::make_unique<RenumberedDrive>(std::move(drive), match.number_in_drive);
}

}  // namespace fovea
