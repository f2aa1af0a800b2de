#include "tools/paper/upsampling_times.h"

#include <algorithm>
#include <chrono>
#include <numeric>

#include "fovea/core/parallel.h"
#include "fovea/core/random.h"
#include "fovea/errors.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/upsample.h"
#include "tools/paper/paper_numbers.h"

namespace fovea::paper {
namespace {

constexpr int kMaxRate = 5;
constexpr int kRuns = 7;

}  // namespace

PointCloud scan_in_view(const FrameSource& drive) {
  const DriveInfo& info = drive.info();
  const Camera& camera = info.calibration.cameras.at(0);
  for (int index = (info.begin + info.end) / 2; index < info.end; ++index) {
    const LoadedFrame loaded = drive.load(index);
    if (std::holds_alternative<SkippedFrame>(loaded)) continue;
    PointCloud scan = std::get<Frame>(loaded).scan;
    scan.intensity.clear();
    scan.time.clear();
    const PointCloud points_cam = transform_cloud(std::move(scan), camera.T_cam_lidar);
    std::vector<std::uint32_t> visible;
    for (std::uint32_t i = 0; i < points_cam.size(); ++i) {
      const auto pixel = camera.project(points_cam.position[i].cast<double>());
      if (pixel && camera.in_view(*pixel)) visible.push_back(i);
    }
    return points_cam.select(visible);
  }
  throw InputError("no frame of the drive can be read", info.path.string(), "check its files");
}

PointCloud shuffled_scan(const FrameSource& drive) {
  const PointCloud scan = scan_in_view(drive);
  std::vector<std::uint32_t> order(scan.size());
  std::iota(order.begin(), order.end(), 0u);
  Random random(1);
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[random.below(i)]);
  return scan.select(order);
}

namespace {

/// `count` of the shuffled points, in the order of a scan's rings as near as can be told.
PointCloud first_points(const PointCloud& shuffled, std::size_t count) {
  std::vector<std::uint32_t> indices(count);
  for (std::uint32_t i = 0; i < count; ++i) indices[i] = i;
  return shuffled.select(indices);
}

UpsamplingCase case_of(const PointCloud& shuffled, const Camera& camera, int wanted) {
  UpsampleOptions options;
  const auto produced = [&](std::size_t count) {
    return upsample(first_points(shuffled, count), camera, options).size();
  };
  const auto goal = static_cast<std::size_t>(wanted);
  for (options.rate = 1; options.rate < kMaxRate && produced(shuffled.size()) < goal;)
    ++options.rate;
  // As few points as give the number wanted: what they give grows with their number.
  std::size_t low = 3, high = shuffled.size();
  while (high - low > high / 100 + 1) {
    const std::size_t middle = low + (high - low) / 2;
    (produced(middle) < goal ? low : high) = middle;
  }
  return {wanted, options.rate, first_points(shuffled, high)};
}

UpsamplingTime time_one(const UpsamplingCase& given, const Camera& camera) {
  UpsampleOptions options;
  options.rate = given.rate;
  UpsamplingTime time{given.wanted, given.points_cam.size(), 0, given.rate, 0};
  std::vector<double> seconds;
  for (int run = 0; run < kRuns; ++run) {
    const auto start = std::chrono::steady_clock::now();
    time.points = upsample(given.points_cam, camera, options).size();
    seconds.push_back(
        std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  std::sort(seconds.begin(), seconds.end());
  time.seconds = seconds[kRuns / 2];
  return time;
}

}  // namespace

std::vector<UpsamplingCase> upsampling_cases(const FrameSource& drive) {
  const Camera& camera = drive.info().calibration.cameras.at(0);
  const PointCloud shuffled = shuffled_scan(drive);
  std::vector<UpsamplingCase> cases;
  for (const PaperUpsampling& column : paper_table_1()) {
    cases.push_back(case_of(shuffled, camera, column.points));
  }
  return cases;
}

std::vector<UpsamplingTime> time_upsampling(const FrameSource& drive) {
  const ThreadLimit one(1);
  std::vector<UpsamplingTime> times;
  for (const UpsamplingCase& given : upsampling_cases(drive)) {
    times.push_back(time_one(given, drive.info().calibration.cameras.at(0)));
  }
  return times;
}

}  // namespace fovea::paper
