// Work for a few threads, the newest first.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace fovea {

/// Runs jobs from construction to destruction, which drops those that have not begun.
class JobQueue {
 public:
  explicit JobQueue(int threads);
  ~JobQueue();
  JobQueue(const JobQueue&) = delete;
  JobQueue& operator=(const JobQueue&) = delete;

  /// @param job  must not throw
  void push(std::function<void()> job);

 private:
  void work(const std::stop_token& stop);

  std::mutex guard_;  // of jobs_
  std::condition_variable_any changed_;
  std::vector<std::function<void()>> jobs_;
  std::vector<std::jthread> threads_;  // last: they use all of the above
};

}  // namespace fovea
