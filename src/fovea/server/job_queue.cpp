#include "fovea/server/job_queue.h"

#include <utility>

#include "fovea/core/thread.h"

namespace fovea {

JobQueue::JobQueue(int threads) {
  for (int i = 0; i < threads; ++i) {
    threads_.push_back(
        start_thread("fovea-jobs", [this](const std::stop_token& stop) { work(stop); }));
  }
}

JobQueue::~JobQueue() = default;

void JobQueue::push(std::function<void()> job) {
  {
    const std::lock_guard lock(guard_);
    jobs_.push_back(std::move(job));
  }
  changed_.notify_one();
}

void JobQueue::work(const std::stop_token& stop) {
  for (;;) {
    std::function<void()> job;
    {
      std::unique_lock lock(guard_);
      if (!changed_.wait(lock, stop, [this] { return !jobs_.empty(); })) return;
      if (stop.stop_requested()) return;
      job = std::move(jobs_.back());
      jobs_.pop_back();
    }
    job();
  }
}

}  // namespace fovea
