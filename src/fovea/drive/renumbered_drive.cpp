#include "fovea/drive/renumbered_drive.h"

#include <fmt/format.h>

#include <utility>

namespace fovea {

RenumberedDrive::RenumberedDrive(std::unique_ptr<FrameSource> drive,
                                 std::map<int, int> number_in_drive)
    : drive_(std::move(drive)),
      number_in_drive_(std::move(number_in_drive)),
      info_(drive_->info()) {
  info_.begin = number_in_drive_.empty() ? 0 : number_in_drive_.begin()->first;
  info_.end = number_in_drive_.empty() ? 0 : number_in_drive_.rbegin()->first + 1;
  info_.reference_poses.clear();
  for (auto* of_cameras : {&info_.image_offsets, &info_.image_exposures}) {
    for (std::map<int, double>& values : *of_cameras) {
      const std::map<int, double> of_drive = std::exchange(values, {});
      for (const auto& [number, in_drive] : number_in_drive_) {
        const auto found = of_drive.find(in_drive);
        if (found != of_drive.end()) values.emplace(number, found->second);
      }
    }
  }
}

LoadedFrame RenumberedDrive::load(int index) const {
  const auto found = number_in_drive_.find(index);
  if (found == number_in_drive_.end()) {
    return SkippedFrame{index, SkipReason::kMissingScan,
                        fmt::format("frame {} of the map is not in the drive", index)};
  }
  LoadedFrame result = drive_->load(found->second);
  std::visit([&](auto& frame) { frame.index = index; }, result);
  return result;
}

void RenumberedDrive::expect(int index) const {
  const auto found = number_in_drive_.find(index);
  if (found != number_in_drive_.end()) drive_->expect(found->second);
}

std::optional<TimeNs> RenumberedDrive::stamp(int index) const {
  const auto found = number_in_drive_.find(index);
  if (found == number_in_drive_.end()) return std::nullopt;
  return drive_->stamp(found->second);
}

}  // namespace fovea
