#include "fovea/simulation/image_schedule.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <string>

#include "fovea/simulation/drive_texts.h"
#include "fovea/simulation/option_checks.h"

namespace fovea {
namespace {

using Times = std::vector<TimeNs>;  // ascending

Times sweep_middles(const SimulationOptions& options) {
  Times middles;
  for (int frame = 0; frame < options.frames; ++frame) {
    middles.push_back(stamp_of(frame, options) + from_seconds(sweep_middle(options.lidar)));
  }
  return middles;
}

/// Stamps of a camera that runs at its own rate, from the start of the first sweep to the end of
/// the last.
/// @param phase  s, of one of the images after the middle of the first sweep
Times free_running_stamps(double rate, double phase, const Times& middles, double period) {
  const double interval = 1 / rate;
  const double first = -0.5 * period - phase;  // s, from that image
  const double last = seconds(middles.back() - middles.front()) + 0.5 * period - phase;
  Times stamps;
  for (double k = std::ceil(first / interval); k * interval <= last; ++k) {
    stamps.push_back(middles.front() + from_seconds(phase + k * interval));
  }
  return stamps;
}

std::size_t nearest(const Times& times, TimeNs time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  const auto place = static_cast<std::size_t>(after - times.begin());
  if (after == times.begin()) return 0;
  if (after == times.end()) return place - 1;
  return time - times[place - 1] <= times[place] - time ? place - 1 : place;
}

/// The frame of each image that is the nearest one to a sweep's middle and a delay.
std::map<std::size_t, std::size_t> match(const Times& images, const Times& middles, TimeNs delay) {
  constexpr double kTolerance = 0.06;  // s, images.tolerance in docs/drives.md
  std::map<std::size_t, std::size_t> frame_of;
  const auto away = [&](std::size_t image, std::size_t frame) {
    return std::abs(images[image] - middles[frame] - delay);
  };
  for (std::size_t frame = 0; frame < middles.size(); ++frame) {
    const std::size_t image = nearest(images, middles[frame] + delay);
    if (seconds(away(image, frame)) > kTolerance) continue;
    const auto [taken, is_new] = frame_of.emplace(image, frame);
    if (!is_new && away(image, frame) < away(image, taken->second)) taken->second = frame;
  }
  return frame_of;
}

/// The rule of docs/drives.md: the nearest image, once more around the median delay.
std::map<std::size_t, std::size_t> frames_of_images(const Times& images, const Times& middles) {
  if (images.empty()) return {};
  const auto first = match(images, middles, 0);
  if (first.empty()) return {};
  Times delays;
  for (const auto& [image, frame] : first) delays.push_back(images[image] - middles[frame]);
  std::sort(delays.begin(), delays.end());
  return match(images, middles, delays[delays.size() / 2]);
}

}  // namespace

double image_rate(const CameraOptions& options, const SimulatedCamera& camera) {
  return camera.rate != 0 ? camera.rate : options.rate;
}

void check_image_times(const CameraOptions& options) {
  const auto check_rate = [](const std::string& key, double rate) {
    if (rate != 0) check_range(key, rate, 1, 200, "Hz");
  };
  check_rate("camera.rate", options.rate);
  for (const SimulatedCamera& camera : options.cameras) {
    check_rate(fmt::format("camera.rate_{}", camera.number), camera.rate);
    const double largest = image_rate(options, camera) == 0 ? 0.05 : 1;
    check_range(camera.phase == 0 ? "camera.phase" : fmt::format("camera.phase_{}", camera.number),
                options.phase + camera.phase, -largest, largest, "s");
  }
}

void check_kitti_image_times(const CameraOptions& options) {
  const auto require_zero = [](const std::string& key, double value) {
    if (value == 0) return;
    reject("KITTI's cameras are triggered in the middle of each sweep", key,
           "use --format generic");
  };
  require_zero("camera.rate", options.rate);
  require_zero("camera.phase", options.phase);
  for (const SimulatedCamera& camera : options.cameras) {
    require_zero(fmt::format("camera.rate_{}", camera.number), camera.rate);
    require_zero(fmt::format("camera.phase_{}", camera.number), camera.phase);
  }
}

std::vector<std::vector<Shot>> image_schedule(const SimulationOptions& options,
                                              const SimulatedCamera& camera) {
  const double rate = image_rate(options.camera, camera);
  const double phase = options.camera.phase + camera.phase;
  const Times middles = sweep_middles(options);
  std::vector<std::vector<Shot>> shots(middles.size());
  if (rate == 0) {
    for (std::size_t frame = 0; frame < middles.size(); ++frame) {
      const TimeNs stamp = middles[frame] + from_seconds(phase);
      shots[frame] = {{stamp, static_cast<int>(frame), true}};
    }
    return shots;
  }
  const Times images = free_running_stamps(rate, phase, middles, options.lidar.period);
  const auto frame_of = frames_of_images(images, middles);
  std::vector<bool> has_image(middles.size(), false);
  for (std::size_t image = 0; image < images.size(); ++image) {
    const auto found = frame_of.find(image);
    const bool belongs = found != frame_of.end();
    const std::size_t frame = belongs ? found->second : nearest(middles, images[image]);
    shots[frame].push_back({images[image], static_cast<int>(image), belongs});
    if (belongs) has_image[frame] = true;
  }
  for (std::size_t frame = 0; frame < middles.size(); ++frame) {
    if (!has_image[frame]) shots[frame].push_back({middles[frame], std::nullopt, true});
  }
  return shots;
}

std::size_t image_count(const std::vector<std::vector<Shot>>& schedule) {
  std::size_t count = 0;
  for (const std::vector<Shot>& shots : schedule) {
    count += static_cast<std::size_t>(std::count_if(
        shots.begin(), shots.end(), [](const Shot& s) { return s.image.has_value(); }));
  }
  return count;
}

}  // namespace fovea
