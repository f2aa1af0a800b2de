// Poses or positions of a live drive, from their arrival to the frames.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fovea/drive/drive_description.h"
#include "fovea/drive/live/record_window.h"
#include "fovea/drive/motion_data.h"
#include "fovea/drive/navigation/generic_navigation.h"
#include "fovea/drive/writers/generic_drive_writer.h"

namespace fovea {

/// Converts records as the tables of a drive's folder are converted. Each pose comes once.
///
/// Navigation begins with the first scans, or with a later one for which records can be used.
/// Over ten members: records of both kinds, the state before and since the beginning.
class LiveNavigation {
 public:
  using Inertia = RecordWindow<RecordedInertia>;

  /// @param description  must outlive this
  /// @param is_used      whether the drive uses navigation
  /// @param name         of the drive, for messages
  LiveNavigation(const DriveDescription& description, bool is_used, std::filesystem::path name)
      : description_(description), name_(std::move(name)), is_used_(is_used) {}

  // False for a record that is not later than the one before: it is dropped.
  bool add(const RecordedPose& pose) { return poses_.add(pose); }
  bool add(const RecordedPosition& position) { return positions_.add(position); }
  bool empty() const { return poses_.empty() && positions_.empty(); }

  /// See LiveMotion.
  /// @param inertia  has the orientations of positions
  bool reaches(TimeNs time, TimeNs longest_step, const Inertia& inertia) const;
  void pass(TimeNs time);

  /// Converts the records up to the first one at `until` or later. If they can be used, navigation
  /// begins, and the frame `local` is fixed. Otherwise the result has a note only.
  /// @throws InputError  as convert_navigation()
  GenericNavigation begin(const LocalFrame& frame, TimeNs until, const Inertia& inertia);
  /// Takes begin() back: navigation may begin later.
  void postpone(std::string problem);
  /// Adds the poses after those before, up to the first record at `until` or later.
  /// @param stamp  of the frame
  void take(TimeNs stamp, TimeNs until, const Inertia& inertia, MotionData& data);

  bool is_by_poses() const { return by_poses_.value_or(!poses_.empty()); }
  const LocalFrame& frame() const { return frame_; }
  /// Problems that came up after begin(); each of them once. Why navigation has not begun.
  Messages messages() const;

  /// Records are converted in a window: it shows positions that are far from the others.
  static constexpr TimeNs kWindow = 10 * kNsPerSecond;

 private:
  bool uses_orientations(const Inertia& inertia) const;
  /// Tables of the records up to the first one at `until` or later.
  NavigationTables tables(TimeNs until, const Inertia& inertia) const;
  /// Begins if the navigation can be used.
  /// @return whether it can
  bool begin_with(const GenericNavigation& navigation);
  /// Begins at a frame if the records can be used for it.
  void try_to_begin(TimeNs stamp, const GenericNavigation& navigation, MotionData& data);
  void add_new_poses(const GenericNavigation& navigation, MotionData& data);
  void drop_before(TimeNs time);
  void warn_once(const std::string& text);

  const DriveDescription& description_;
  std::filesystem::path name_;
  RecordWindow<RecordedPose> poses_;
  RecordWindow<RecordedPosition> positions_;
  bool is_used_;
  std::optional<bool> by_poses_;     // since navigation has begun
  LocalFrame given_, frame_;         // before and since
  std::string problem_;              // why navigation has not begun
  std::optional<double> heading_;    // of the body at the last pose
  std::optional<TimeNs> last_pose_;  // of the last results
  Messages messages_;
};

}  // namespace fovea
