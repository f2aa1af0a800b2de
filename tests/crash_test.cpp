// The program killed at any moment: what it had committed stays, and a resumed run ends with the
// map of an undisturbed one.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <thread>

#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/map/map_store.h"
#include "tests/kitti_writer.h"
#include "tests/program.h"

namespace fovea::crash_test {

using Clock = std::chrono::steady_clock;

/// Many small frames: some five commits.
std::filesystem::path write_long_drive(const std::filesystem::path& folder) {
  SyntheticDrive drive(street_scene(), 160, 0.12);
  drive.beams = 20;
  drive.columns = 300;
  Camera& camera = drive.editable_info().calibration.cameras[0];
  camera.width = 155;
  camera.height = 47;
  camera.fx = camera.fy = 90;
  camera.cx = 77;
  camera.cy = 20;
  return write_kitti_drive(drive, folder);
}

/// Frames that a map has, all of whose tiles can be read; 0 if there is no map yet.
std::size_t committed_frames(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) return 0;
  const MapReader map(path);
  map.for_each_tile([](std::size_t, const TileKey&, const PointCloud&) {});
  return map.frames().size();
}

class Mapping {
 public:
  Mapping(const std::filesystem::path& drive, const std::filesystem::path& output, bool resume)
      : process_(::fork()) {
    if (process_ != 0) return;
    const int nowhere = ::open("/dev/null", O_WRONLY);
    ::dup2(nowhere, 1);
    ::dup2(nowhere, 2);
    ::execl(FOVEA_PROGRAM, "fovea", "map", drive.c_str(), "-o", output.c_str(), "--set",
            "surface.spacing_m=0.1", resume ? "--resume" : "--force", nullptr);
    ::_exit(127);
  }
  void stop() const { ::kill(process_, SIGSTOP); }
  /// @return the exit status if it had ended by itself
  std::optional<int> kill() const {
    ::kill(process_, SIGKILL);
    return wait();
  }
  std::optional<int> wait() const {
    int status = 0;
    ::waitpid(process_, &status, 0);
    if (WIFEXITED(status)) return WEXITSTATUS(status);
    return std::nullopt;
  }

 private:
  pid_t process_;
};

TEST(Crash, AKilledMapperLosesNoCommittedFrame) {
  const TemporaryFolder folder;
  const auto drive = write_long_drive(folder.path());
  const auto output = folder / "out.fovea";
  const Clock::time_point start = Clock::now();
  ASSERT_EQ(Mapping(drive, output, false).wait(), 0);
  const double whole_time = std::chrono::duration<double>(Clock::now() - start).count();
  const std::string whole = MapReader(output).digest();
  ASSERT_EQ(committed_frames(output), 160u);
  std::filesystem::remove(output);

  Random random(2);
  int killed = 0, killed_half_way = 0;
  std::size_t kept = 0;
  for (int attempt = 0; killed < 100 && attempt < 1000; ++attempt) {
    const Mapping mapping(drive, output, kept > 0);
    // Seldom so long that it ends by itself: what was kept is not done again.
    std::this_thread::sleep_for(std::chrono::duration<double>(random.uniform(0, 0.7 * whole_time)));
    mapping.stop();
    std::size_t seen = 0;
    try {
      seen = committed_frames(output);
    } catch (const InputError&) {
      // Stopped while it has the file for itself: what is there, others see later.
    }
    const std::optional<int> exit = mapping.kill();
    if (exit) {
      ASSERT_EQ(exit, 0) << "after " << killed << " kills";
      ASSERT_EQ(MapReader(output).digest(), whole) << "after " << killed << " kills";
      std::filesystem::remove(output);
      kept = 0;
      continue;
    }
    ++killed;
    const std::size_t before = std::max(seen, kept);
    kept = committed_frames(output);
    ASSERT_GE(kept, before) << "after " << killed << " kills";
    killed_half_way += kept > 0 && kept < 160;
  }
  EXPECT_EQ(killed, 100);
  EXPECT_GT(killed_half_way, 10);
  ASSERT_EQ(Mapping(drive, output, kept > 0).wait(), 0);
  EXPECT_EQ(MapReader(output).digest(), whole);
}

}  // namespace fovea::crash_test
