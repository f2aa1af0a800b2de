#include "fovea/base/worker.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <vector>

namespace fovea::worker_test {

TEST(Worker, DoesItsTasksInOrder) {
  for (const bool threaded : {false, true}) {
    std::vector<int> done;
    Worker worker(threaded);
    for (int i = 0; i < 99; ++i) worker.post([&, i] { done.push_back(i); });
    EXPECT_EQ(worker.post([&] { return done.size(); }).get(), 99u);
    EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  }
}

TEST(Worker, PostingDoesNotWait) {
  std::promise<int> answer;
  Worker worker;
  auto asked = worker.post([&] { return answer.get_future().get(); });
  answer.set_value(7);  // would never be reached
  EXPECT_EQ(asked.get(), 7);
}

TEST(Worker, AnErrorIsItsTasksOwn) {
  for (const bool threaded : {false, true}) {
    Worker worker(threaded);
    auto failed = worker.post([] { throw std::runtime_error("full"); });
    auto moved = worker.post([value = std::make_unique<int>(3)] { return *value; });
    EXPECT_THROW(failed.get(), std::runtime_error);
    EXPECT_EQ(moved.get(), 3);
  }
}

TEST(Worker, TasksNotBegunAreDroppedAtTheEnd) {
  std::atomic<int> done = 0;
  std::promise<void> begun, go;
  std::thread opener;
  std::future<void> dropped;
  {
    Worker worker;
    worker.post([&] {
      begun.set_value();
      go.get_future().wait();
      ++done;
    });
    begun.get_future().wait();
    opener = std::thread([&] {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
      go.set_value();
    });
    dropped = worker.post([&] { done += 100; });
  }
  opener.join();
  EXPECT_TRUE(done == 1 || done == 101);  // the end may have come late
  EXPECT_EQ(dropped.wait_for(std::chrono::seconds(0)), std::future_status::ready);
}

}  // namespace fovea::worker_test
