#include "python/bindings/live_run.h"

#include <algorithm>
#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "python/bindings/run_watch.h"

namespace fovea::python {
namespace py = pybind11;
namespace {

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

}  // namespace

std::shared_ptr<LiveRun> LiveRun::start(LiveRunOptions options) {
  std::shared_ptr<LiveRun> run(new LiveRun(std::move(options.on_pose)));
  if (!run->on_pose_.is_none()) {
    options.mapper.on_pose = [&here = *run](const LivePose& pose) { here.report_pose(pose); };
  }
  run->mapper_ = std::make_unique<LiveMapper>(options.drive_toml, options.output, options.mapper);
  std::erase_if(all_runs(), [](const std::weak_ptr<LiveRun>& other) { return other.expired(); });
  all_runs().push_back(run);
  return run;
}

void LiveRun::add(const std::function<void(LiveMapper&)>& add) {
  require_outside_on_pose();
  rethrow_raised();
  if (was_closed_) {
    // With the GIL: end_all() does not wait for this thread. Throws what has ended the map early.
    // Otherwise data after the end are dropped.
    if (mapper_->close_within(std::chrono::milliseconds(0))) mapper_->close();
    return;
  }
  ++callers_;
  std::exception_ptr refused;
  {
    const py::gil_scoped_release others_run;
    try {
      add(*mapper_);
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
  while (!close_within(kSignalCheck)) {
    try {
      raise_signals();
    } catch (...) {
      stop();
      wait_for_end();
      throw;
    }
  }
  rethrow_raised();
  return mapper_->close().json;
}

void LiveRun::stop() {
  was_closed_ = true;
  mapper_->stop();
}

void LiveRun::end(const std::shared_ptr<LiveRun>& run) {
  run->stop();
  if (run_in_on_pose == run.get()) {
    dropped_runs().push_back(run);
  } else {
    run->wait_for_end();
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

void LiveRun::report_pose(const LivePose& pose) {
  const py::gil_scoped_acquire running;
  const py::object on_pose = on_pose_;  // which the garbage collector may clear
  if (raised_ || !on_pose || on_pose.is_none()) return;
  run_in_on_pose = this;
  try {
    on_pose(pose);
  } catch (py::error_already_set& exception) {
    raised_ = exception.value();
    if (exception.trace()) PyException_SetTraceback(raised_.ptr(), exception.trace().ptr());
    mapper_->stop();
  }
  run_in_on_pose = nullptr;
}

bool LiveRun::close_within(std::chrono::milliseconds time) {
  const py::gil_scoped_release others_run;
  return mapper_->close_within(time);
}

void LiveRun::wait_for_end() {
  while (!close_within(std::chrono::hours(1))) {
  }
}

void LiveRun::rethrow_raised() const {
  if (!raised_) return;
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(raised_.ptr())), raised_.ptr());
  throw py::error_already_set();
}

std::string LiveRun::failure() {
  try {
    rethrow_raised();
    if (close_within(std::chrono::milliseconds(0))) mapper_->close();
  } catch (const std::exception& error) {
    return error.what();
  }
  return {};
}

void LiveRun::require_outside_on_pose() const {
  if (run_in_on_pose == this) throw std::logic_error("on_pose calls the mapper that it waits for");
}

}  // namespace fovea::python
