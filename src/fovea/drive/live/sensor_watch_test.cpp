#include "fovea/drive/live/sensor_watch.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fovea::sensor_watch_test {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr TimeNs kStep = kNsPerSecond / 10;
enum SensorNumber : std::size_t { kLidar, kCamera, kPositions, kUnused };

class SensorWatchTest : public testing::Test {
 protected:
  SensorWatchTest() { watch_.begin({true, true, true, false}, {true, true, true, true}); }
  /// @param begin, end  tenths of a second
  void run(std::size_t sensor, int begin, int end, int step = 1) {
    for (int i = begin; i < end; i += step) watch_.add(sensor, i * kStep);
  }
  const std::vector<std::string>& warnings() const { return watch_.messages().warnings; }

  SensorWatch watch_{{"the LiDAR", "camera front", "the source of positions", "camera side"}};
};

TEST_F(SensorWatchTest, ReportsASensorThatStopsAndComesBack) {
  run(kCamera, 0, 5);
  run(kLidar, 0, 24);
  EXPECT_THAT(warnings(), IsEmpty());
  run(kLidar, 24, 30);
  EXPECT_THAT(warnings(), ElementsAre("camera front has sent no data since 0.4 s of the drive"));
  run(kCamera, 30, 31);
  EXPECT_THAT(warnings().back(), "camera front sends data again, after 2.6 s");
}

TEST_F(SensorWatchTest, ReportsALidarThatStops) {
  run(kLidar, 0, 5);
  run(kCamera, 0, 30);
  EXPECT_THAT(warnings(), ElementsAre("the LiDAR has sent no data since 0.4 s of the drive"));
}

TEST_F(SensorWatchTest, APauseOfAllSensorsIsNone) {
  for (const int begin : {0, 300, 900}) {
    for (int i = begin; i < begin + 30; ++i) {
      run(kLidar, i, i + 1);
      run(kCamera, i, i + 1);
    }
  }
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(SensorWatchTest, ASlowSensorDoesNotStop) {
  for (int i = 0; i < 300; ++i) {
    run(kLidar, i, i + 1);
    run(kCamera, i, i + 1);
    if (i % 50 == 0) run(kPositions, i, i + 1);
  }
  // After the first position no rate is known.
  EXPECT_THAT(warnings(),
              ElementsAre("the source of positions has sent no data since 0.0 s of the drive",
                          "the source of positions sends data again, after 5.0 s"));
}

TEST_F(SensorWatchTest, ReportsASensorThatBeginsLateOnce) {
  run(kUnused, 10, 20);
  EXPECT_THAT(warnings(),
              ElementsAre("camera side sends data after the beginning: they are not used"));
}

TEST_F(SensorWatchTest, WarningsDoNotGrow) {
  for (int i = 0; i < 1000; ++i) {
    run(kLidar, 100 * i, 100 * i + 50);
    run(kCamera, 100 * i + 50, 100 * i + 52);
  }
  EXPECT_EQ(warnings().size(), 100u);
  EXPECT_EQ(warnings().back(), "further warnings are left out");
}

}  // namespace fovea::sensor_watch_test
