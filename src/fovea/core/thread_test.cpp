#include "fovea/core/thread.h"

#include <gtest/gtest.h>
#include <pthread.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <string>

namespace fovea::thread_test {

int nice_value() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(Thread, HasItsNameAndPriority) {
  const int before = nice_value();
  std::array<char, 16> name{};
  int normal = -1, background = -1;
  start_thread("fovea-test", [&](const std::stop_token&) {
    pthread_getname_np(pthread_self(), name.data(), name.size());
    normal = nice_value();
  }).join();
  start_thread(
      "fovea-test", [&](const std::stop_token&) { background = nice_value(); },
      ThreadPriority::kBackground)
      .join();
  EXPECT_EQ(std::string(name.data()), "fovea-test");
  EXPECT_EQ(normal, before);
  EXPECT_GT(background, before);
  EXPECT_EQ(nice_value(), before);
}

TEST(Thread, DestructionStopsAndJoins) {
  bool ended = false;
  {
    const std::jthread thread = start_thread("fovea-test", [&](const std::stop_token& stop) {
      while (!stop.stop_requested()) std::this_thread::yield();
      ended = true;
    });
  }
  EXPECT_TRUE(ended);
}

}  // namespace fovea::thread_test
