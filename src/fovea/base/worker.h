// Tasks done one after the other on a thread of their own.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <mutex>
#include <thread>
#include <type_traits>
#include <utility>

namespace fovea {

/// Tasks are done in the order of posting; what one returns or throws is in its future.
class Worker {
 public:
  /// @param threaded  false: post() itself does the task
  explicit Worker(bool threaded = true) {
    if (threaded) thread_ = std::thread([this] { run(); });
  }
  /// Begins no task any more.
  ~Worker() {
    if (!thread_.joinable()) return;
    {
      const std::lock_guard lock(guard_);
      ended_ = true;
    }
    changed_.notify_all();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  template <class Work>
  std::future<std::invoke_result_t<Work&>> post(Work work) {
    std::packaged_task<std::invoke_result_t<Work&>()> task(std::move(work));
    auto result = task.get_future();
    if (!thread_.joinable()) {
      task();
      return result;
    }
    {
      const std::lock_guard lock(guard_);
      tasks_.emplace_back([task = std::move(task)]() mutable { task(); });
    }
    changed_.notify_all();
    return result;
  }

 private:
  void run() {
    std::unique_lock lock(guard_);
    while (true) {
      changed_.wait(lock, [&] { return !tasks_.empty() || ended_; });
      if (ended_) return;
      std::packaged_task<void()> task = std::move(tasks_.front());
      tasks_.pop_front();
      lock.unlock();
      task();
      lock.lock();
    }
  }

  std::mutex guard_;
  std::condition_variable changed_;
  std::deque<std::packaged_task<void()>> tasks_;  // guarded, as is the one below
  bool ended_ = false;
  std::thread thread_;  // last: uses all of the above
};

}  // namespace fovea
