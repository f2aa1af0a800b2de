#include "python/bindings/live_run.h"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "fovea/api/live_pose.h"
#include "fovea/core/parallel.h"
#include "fovea/pipeline/map_live.h"
#include "fovea/pipeline/summary_json.h"
#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

using nlohmann::ordered_json;

constexpr std::chrono::milliseconds kSignalCheck{50};

thread_local const LiveRun* run_in_on_pose = nullptr;  // of this thread

// With the GIL.
std::vector<std::weak_ptr<LiveRun>>& all_runs() {
  static std::vector<std::weak_ptr<LiveRun>> runs;
  return runs;
}

/// Runs that their own on_pose has dropped.
std::vector<std::shared_ptr<LiveRun>>& dropped_runs() {
  static std::vector<std::shared_ptr<LiveRun>> runs;
  return runs;
}

/// A note may quote a name in any encoding.
std::string text_of(const ordered_json& json) {
  return json.dump(-1, ' ', false, ordered_json::error_handler_t::replace);
}

}  // namespace

std::string live_figures_json(const LiveFigures& figures) { return text_of(to_json(figures)); }

LiveRun::LiveRun(LiveRunOptions options)
    : source_(options.drive_toml, options.source),
      job_(std::move(options.job)),
      threads_(options.threads),
      on_pose_(std::move(options.on_pose)) {
  job_.stop = stop_.get_token();
  if (!on_pose_.is_none()) {
    job_.on_tracked = [this](const FrameResult& frame) { report_pose(frame); };
  }
}

std::shared_ptr<LiveRun> LiveRun::start(LiveRunOptions options) {
  std::shared_ptr<LiveRun> run(new LiveRun(std::move(options)));
  std::erase_if(all_runs(), [](const std::weak_ptr<LiveRun>& other) { return other.expired(); });
  all_runs().push_back(run);
  run->thread_ = std::jthread([&here = *run] { here.run(); });
  return run;
}

void LiveRun::add(const std::function<void(LiveSource&)>& add) {
  require_outside_on_pose();
  rethrow();
  if (was_closed_) return;
  ++callers_;
  std::exception_ptr refused;
  {
    const py::gil_scoped_release others_run;
    try {
      add(source_);
    } catch (...) {
      refused = std::current_exception();
    }
  }
  --callers_;
  if (refused) std::rethrow_exception(refused);
}

std::string LiveRun::close() {
  require_outside_on_pose();
  was_closed_ = true;
  source_.close();
  while (!wait_for(kSignalCheck)) {
    try {
      raise_signals();
    } catch (...) {
      stop();
      wait_for_thread();
      throw;
    }
  }
  wait_for_thread();
  rethrow();
  return summary_;
}

void LiveRun::stop() {
  was_closed_ = true;
  stop_.request_stop();
  source_.close();
}

void LiveRun::end(const std::shared_ptr<LiveRun>& run) {
  run->stop();
  if (run_in_on_pose == run.get()) {
    dropped_runs().push_back(run);
  } else {
    run->wait_for_thread();
  }
}

void LiveRun::end_all() {
  for (const std::weak_ptr<LiveRun>& known : std::vector(all_runs())) {
    const std::shared_ptr<LiveRun> run = known.lock();
    if (!run) continue;
    end(run);
    // Threads that add data take the GIL back before Python ends.
    while (run->callers_ > 0) {
      const py::gil_scoped_release others_run;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  dropped_runs().clear();
}

void LiveRun::run() {
  std::exception_ptr error;
  try {
    map();
  } catch (...) {
    error = std::current_exception();
  }
  const std::lock_guard lock(guard_);
  error_ = error;
  has_ended_ = true;
  ended_.notify_all();
}

void LiveRun::map() {
  const ThreadLimit limit(threads_);
  MapSummary summary = map_live(source_, job_, {});
  source_.finish_recording();
  const LiveFigures figures = source_.figures();
  summary.append(figures);
  ordered_json json = to_json(summary);
  json["live"] = to_json(figures);
  const std::lock_guard lock(guard_);
  summary_ = text_of(json);
}

void LiveRun::report_pose(const FrameResult& frame) {
  const py::gil_scoped_acquire running;
  const py::object on_pose = on_pose_;  // which the garbage collector may clear
  if (raised_ || !on_pose || on_pose.is_none()) return;
  run_in_on_pose = this;
  try {
    on_pose(live_pose(frame));
  } catch (py::error_already_set& exception) {
    raised_ = exception.value();
    if (exception.trace()) PyException_SetTraceback(raised_.ptr(), exception.trace().ptr());
    stop_.request_stop();
  }
  run_in_on_pose = nullptr;
}

bool LiveRun::wait_for(std::chrono::milliseconds time) {
  const py::gil_scoped_release others_run;
  std::unique_lock lock(guard_);
  return ended_.wait_for(lock, time, [&] { return has_ended_; });
}

void LiveRun::wait_for_thread() {
  if (!thread_.joinable()) return;
  {
    const py::gil_scoped_release others_run;
    std::unique_lock lock(guard_);
    ended_.wait(lock, [&] { return has_ended_; });
  }
  // The thread needs the GIL no more.
  if (thread_.joinable()) thread_.join();
}

void LiveRun::rethrow() const {
  if (raised_) {
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(raised_.ptr())), raised_.ptr());
    throw py::error_already_set();
  }
  std::unique_lock lock(guard_);
  const std::exception_ptr error = error_;
  lock.unlock();
  if (error) std::rethrow_exception(error);
}

std::string LiveRun::failure() const {
  try {
    rethrow();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void LiveRun::require_outside_on_pose() const {
  if (run_in_on_pose == this) throw std::logic_error("on_pose calls the mapper that it waits for");
}

}  // namespace fovea::python
