// The thread of a fovea.LiveMapper: frames of a live source into a map file.
#pragma once

#include <pybind11/pybind11.h>

#include <chrono>
#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>

#include "fovea/drive/live/live_source.h"
#include "fovea/pipeline/frame_result.h"
#include "fovea/pipeline/map_drive.h"

namespace fovea::python {

struct LiveRunOptions {
  std::string drive_toml;
  LiveOptions source;
  MapJob job;
  int threads = 0;
  pybind11::object on_pose;  ///< is called with a LivePose; or None
};

/// Maps in a thread of its own. All functions need the GIL, and release it while they wait.
class LiveRun {
 public:
  /// Begins. Errors as LiveSource.
  static std::shared_ptr<LiveRun> start(LiveRunOptions options);
  ~LiveRun() = default;  // end() comes first
  LiveRun(const LiveRun&) = delete;
  LiveRun& operator=(const LiveRun&) = delete;

  /// Calls `add` with the source; not if the source is closed.
  /// @throws what has ended the run; std::logic_error in on_pose
  void add(const std::function<void(LiveSource&)>& add);
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

  /// What has ended the run early; empty: nothing so far.
  std::string failure() const;
  bool was_closed() const { return was_closed_; }
  const LiveSource& source() const { return source_; }
  /// For the garbage collector: the objects that the run keeps.
  pybind11::object& on_pose() { return on_pose_; }
  pybind11::object& raised() { return raised_; }

 private:
  explicit LiveRun(LiveRunOptions options);
  void run();
  void map();
  void report_pose(const FrameResult& frame);
  /// @return false if the run has not ended in this time
  bool wait_for(std::chrono::milliseconds time);
  void wait_for_thread();
  void rethrow() const;
  void require_outside_on_pose() const;

  LiveSource source_;
  MapJob job_;
  const int threads_;
  std::stop_source stop_;

  // With the GIL.
  pybind11::object on_pose_;
  pybind11::object raised_;  // by on_pose; null: nothing
  bool was_closed_ = false;
  int callers_ = 0;  // of add()

  mutable std::mutex guard_;  // of all below
  std::condition_variable ended_;
  bool has_ended_ = false;
  std::exception_ptr error_;
  std::string summary_;

  std::jthread thread_;  // last: it uses the others
};

/// Figures of a source, as JSON.
std::string live_figures_json(const LiveFigures& figures);

}  // namespace fovea::python
