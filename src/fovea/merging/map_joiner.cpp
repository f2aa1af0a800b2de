#include "fovea/merging/map_joiner.h"

#include <cstdint>

#include "fovea/merging/renumbered_column.h"

namespace fovea {
namespace {

/// A frame of a drive as it is in the merged map.
FrameRecord moved_frame(FrameRecord frame, const AddedDrive& drive, const MapContent& b,
                        const MapAlignment& alignment, const RigidMotion& stated_T_a_b,
                        const LogGain& gain, std::size_t& latest_submap) {
  const int to_submap = drive.merged.first_submap - drive.in_b.first_submap;
  if (frame.submap >= 0) latest_submap = std::size_t(frame.submap);  // a skipped one goes along
  frame.T_local_lidar = alignment.T_a_submap.at(latest_submap) *
                        b.T_local_submap.at(latest_submap).inverse() * frame.T_local_lidar;
  if (frame.T_local_lidar_navigation) {
    frame.T_local_lidar_navigation = stated_T_a_b * *frame.T_local_lidar_navigation;
  }
  frame.index = drive.number_of(frame.index);
  if (frame.submap >= 0) frame.submap += to_submap;
  if (frame.revisit && frame.revisit->submap >= 0) frame.revisit->submap += to_submap;
  for (ViewRecord& view : frame.views) {
    if (view.log2_gain) *view.log2_gain += gain.cast<double>().matrix();
  }
  return frame;
}

/// B's colors in the exposure of A.
void match_exposure(const LogGain& gain, TilePoints& tile) {
  for (FusedColor& color : tile.colors) {
    color.color = with_offset(color.color, -gain * kColorCodesPerStop);
  }
}

int number_at(const std::vector<int>& numbers, int place) {
  const auto at = static_cast<std::size_t>(place);
  return at < numbers.size() ? numbers[at] : 0;
}

}  // namespace

Renumbering::Renumbering(const MapContent& a, const MapContent& b,
                         const std::vector<AddedDrive>& added) {
  std::vector<bool> is_added(b.drives.size());
  for (const MergedDrive& drive : b.drives) {
    const MergedDrive* same = find_drive(a, drive.digest);
    drives_.push_back(same == nullptr ? 0 : static_cast<int>(same - a.drives.data()));
  }
  for (const AddedDrive& drive : added) {
    drives_[drive.number_in_b] = static_cast<int>(drive.number);
    is_added[drive.number_in_b] = true;
  }
  // Without sensors of A, the numbers in its tiles would be those of B's sensors.
  if (a.sensors.empty()) return;
  for (SensorRecord sensor : b.sensors) {
    const auto drive = static_cast<std::size_t>(sensor.drive);
    sensor_numbers_.push_back(0);
    if (drive >= is_added.size() || !is_added[drive]) continue;
    const std::size_t number = a.sensors.size() + sensors_.size();
    sensor_numbers_.back() = static_cast<int>(number);
    sensor.drive = drives_[drive];
    sensors_.emplace_back(number, sensor);
  }
}

int Renumbering::drive_of(int in_b) const { return number_at(drives_, in_b); }
int Renumbering::sensor_of(int in_b) const { return number_at(sensor_numbers_, in_b); }

void Renumbering::apply(TilePoints& tile) const {
  fill_with_zeros(tile.size(), tile.session);
  renumber(tile.session, [&](std::uint16_t drive) { return drive_of(drive); });
  fill_with_zeros(tile.size(), tile.sensor);
  renumber(tile.sensor, [&](std::uint16_t sensor) { return sensor_of(sensor); });
}

void MapJoiner::copy_a(const MapContent& content) {
  copy_all_but_tiles(a_, output_);
  for (const RigidMotion& T : content.T_local_submap) map_.add_submap(T);
  a_.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) { put(id, tile); });
}

void MapJoiner::add_b(const MapContent& content, const std::vector<AddedDrive>& drives,
                      const Renumbering& renumbering, const MapAlignment& alignment,
                      const RigidMotion& stated_T_a_b, const LogGain& gain) {
  // Of each submap of B the drive that it comes with, if it does.
  std::vector<const AddedDrive*> drive_of(content.T_local_submap.size(), nullptr);
  for (const AddedDrive& drive : drives) {
    for (int id = drive.in_b.first_submap; id < drive.in_b.end_submap; ++id) {
      drive_of.at(std::size_t(id)) = &drive;
      add_submap(alignment.T_a_submap.at(std::size_t(id)), drive);
    }
    add_frames(content, drive, alignment, stated_T_a_b, gain);
  }
  add_keyframes(drives, renumbering);
  b_.for_each_stored_tile([&](const TileId& id, const TilePoints& tile) {
    const AddedDrive* drive = drive_of[id.submap];
    if (drive == nullptr) return;
    TilePoints moved = tile;
    match_exposure(gain, moved);
    renumber(moved.frame, [&](std::int32_t frame) { return drive->number_of(frame); });
    renumbering.apply(moved);
    const int shift = drive->merged.first_submap - drive->in_b.first_submap;
    put({id.submap + std::size_t(shift), id.key}, std::move(moved));
  });
}

void MapJoiner::put(const TileId& id, TilePoints tile) {
  map_.declare_stored(id, tile.size());
  tiles_.put(id, std::move(tile));
}

void MapJoiner::add_submap(const RigidMotion& T_local_submap, const AddedDrive& drive) {
  SubmapRecord submap;
  submap.T_local_submap = T_local_submap;
  submap.drive = static_cast<int>(drive.number);
  output_.put_submap(map_.submaps().size(), submap);
  map_.add_submap(T_local_submap);
}

void MapJoiner::add_frames(const MapContent& content, const AddedDrive& drive,
                           const MapAlignment& alignment, const RigidMotion& stated_T_a_b,
                           const LogGain& gain) {
  auto latest_submap = std::size_t(drive.in_b.first_submap);
  for (const FrameRecord& frame : content.frames) {
    if (drive.number_of(frame.index) < 0) continue;
    output_.put_frame(
        moved_frame(frame, drive, content, alignment, stated_T_a_b, gain, latest_submap));
  }
}

void MapJoiner::add_keyframes(const std::vector<AddedDrive>& drives,
                              const Renumbering& renumbering) {
  b_.for_each_keyframe([&](KeyframeRecord keyframe) {
    for (const AddedDrive& drive : drives) {
      const int frame = drive.number_of(keyframe.frame);
      if (frame < 0) continue;
      keyframe.frame = frame;
      keyframe.sensor = renumbering.sensor_of(keyframe.sensor);
      output_.put_keyframe(keyframe);
      return;
    }
  });
}

void put_drives(const MapContent& a, const std::vector<AddedDrive>& added,
                const Renumbering& renumbering, const RigidMotion& stated_T_a_b,
                MapWriter& output) {
  for (std::size_t k = 0; k < a.records.size(); ++k) output.put_drive(k, a.records[k]);
  for (const AddedDrive& drive : added) {
    DriveRecord record = drive.record;
    record.T_local_drive = stated_T_a_b * record.T_local_drive;
    output.put_drive(drive.number, record);
  }
  for (const auto& [number, sensor] : renumbering.sensors()) output.put_sensor(number, sensor);
}

}  // namespace fovea
