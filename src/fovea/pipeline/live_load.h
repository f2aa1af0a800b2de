// Whether a live run has time to texture a frame.
#pragma once

namespace fovea {

/// Chooses the frames of a live run that add nothing to the map, so that each scan is tracked. Once
/// the run falls behind its robot, frames add nothing until it has caught up.
///
/// The reader, the tracker and their queues hold few frames. If they are full, scans wait in the
/// queue of the live source, which drops its oldest. So the number of frames that are read shows
/// when time is short. It does not count scans that only wait for their images.
class LiveLoad {
 public:
  /// Frames that are read: from the first number on the run may be behind (at 10 Hz by 0.3 s), up
  /// to the second one it has caught up.
  static constexpr int kBehind = 3, kCaughtUp = 1;
  /// In a row: a robot whose scans are too fast for the tracker gets a sparse map, not an empty
  /// one.
  static constexpr int kMostSkipped = 15;

  /// Whether the next frame is to add nothing to the map.
  /// @param waiting  later frames that are read already
  /// @param age      s since the arrival of the frame's scan. A run whose frames get younger
  ///                 catches up without a skip, as after the first frames
  bool skips_next(int waiting, double age) {
    const bool falls_behind = waiting >= kBehind && age >= last_age_;
    is_behind_ = is_behind_ ? waiting > kCaughtUp : falls_behind;
    last_age_ = age;
    const bool skips = is_behind_ && skipped_ < kMostSkipped;
    skipped_ = skips ? skipped_ + 1 : 0;
    return skips;
  }

 private:
  bool is_behind_ = false;
  double last_age_ = 0;
  int skipped_ = 0;  // in a row
};

}  // namespace fovea
