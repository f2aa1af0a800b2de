// The run of a fovea.LiveMapper: its map, its on_pose and its end.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "fovea/live.h"

namespace fovea::python {

struct LiveRunOptions {
  std::string drive_toml;
  std::filesystem::path output;
  LiveMapperOptions mapper;
  pybind11::object on_pose;  ///< is called with a LivePose; or None
};

/// All functions need the GIL, and release it while they wait.
class LiveRun {
 public:
  /// Begins. Errors as LiveMapper.
  static std::shared_ptr<LiveRun> start(LiveRunOptions options);
  ~LiveRun() = default;  // end() comes first
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Calls `add` with the mapper.
  /// @throws what has ended the run; std::logic_error in on_pose
  void add(const std::function<void(LiveMapper&)>& add);
  /// Waits until the map has the frames at hand. Ctrl-C stops the run.
  /// @return the summary, as JSON
  /// @throws what has ended the run; std::logic_error in on_pose
  std::string close();
  /// Ends the run early: the map is complete up to the frames at hand.
  void stop();
  /// Stops, and waits for the thread, except in its own on_pose: it then ends with the program.
  static void end(const std::shared_ptr<LiveRun>& run);
  /// Ends all runs.
  static void end_all();

  /// What has ended the run early; empty: nothing so far. No more data are taken.
  std::string failure();
  bool was_closed() const { return was_closed_; }
  const LiveMapper& mapper() const { return *mapper_; }
  /// For the garbage collector: the objects that the run keeps.
  pybind11::object& on_pose() { return on_pose_; }
  pybind11::object& raised() { return raised_; }

 private:
  explicit LiveRun(pybind11::object on_pose) : on_pose_(std::move(on_pose)) {}
  void report_pose(const LivePose& pose);
  /// @return false if the run has not ended in this time
  bool close_within(std::chrono::milliseconds time);
  void wait_for_end();
  void rethrow_raised() const;
  void require_outside_on_pose() const;

  // With the GIL.
  pybind11::object on_pose_;
  pybind11::object raised_;  // by on_pose; null: nothing
  bool was_closed_ = false;
  int callers_ = 0;  // of add()

  std::unique_ptr<LiveMapper> mapper_;  // last: its thread uses the others
};

}  // namespace fovea::python
