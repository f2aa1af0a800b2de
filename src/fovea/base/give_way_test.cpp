#include "fovea/base/give_way.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <thread>

namespace fovea::give_way_test {

int priority() { return getpriority(PRIO_PROCESS, static_cast<id_t>(gettid())); }

TEST(GiveWay, IsOfTheThreadThatCalls) {
  const int before = priority();
  int in_thread = before;
  std::thread([&] {
    give_way(before + 1);
    in_thread = priority();
  }).join();
  EXPECT_EQ(priority(), before);
  EXPECT_EQ(in_thread, std::min(before + 1, 19));
}

}  // namespace fovea::give_way_test
