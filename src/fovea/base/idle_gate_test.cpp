#include "fovea/base/idle_gate.h"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>

namespace fovea::idle_gate_test {

using namespace std::chrono_literals;

/// What would be waited for, were it not for something else: the test fails by its time limit.
const WallClock::time_point kNever = WallClock::now() + 24h;

TEST(IdleGate, NobodyWaitsWhereNothingIsUnderWay) {
  IdleGate gate;
  gate.wait(kNever, {});
  gate.begin();
  gate.end();
  gate.wait(kNever, {});
}

TEST(IdleGate, OpensWhenAllThatIsUnderWayHasEnded) {
  IdleGate gate;
  gate.begin();
  gate.begin();
  std::atomic<bool> ended = false;
  std::jthread other([&] {
    gate.end();
    std::this_thread::sleep_for(5ms);
    ended = true;
    gate.end();
  });
  gate.wait(kNever, {});
  EXPECT_TRUE(ended);
}

TEST(IdleGate, HoldsNobodyUpForLongerThanAllowed) {
  IdleGate gate;
  gate.begin();
  const WallClock::time_point latest = WallClock::now() + 5ms;
  gate.wait(latest, {});
  EXPECT_GE(WallClock::now(), latest);
  gate.wait(latest, {});  // past: at once
}

TEST(IdleGate, AStopEndsTheWait) {
  IdleGate gate;
  gate.begin();
  std::stop_source stop;
  std::jthread other([&] { stop.request_stop(); });
  gate.wait(kNever, stop.get_token());
  EXPECT_TRUE(stop.stop_requested());
}

}  // namespace fovea::idle_gate_test
