#include "fovea/sensor/nearest_images.h"

#include <algorithm>
#include <cstdlib>

namespace fovea {
namespace {

struct StampedImage {
  TimeNs time;
  int number;
  friend auto operator<=>(const StampedImage&, const StampedImage&) = default;
};

const StampedImage& nearest(const std::vector<StampedImage>& images, TimeNs time) {
  const auto after = std::lower_bound(images.begin(), images.end(), time,
                                      [](const StampedImage& i, TimeNs t) { return i.time < t; });
  if (after == images.begin()) return *after;
  if (after == images.end()) return *(after - 1);
  return time - (after - 1)->time <= after->time - time ? *(after - 1) : *after;
}

}  // namespace

ImageMatches match_nearest(const NumberedTimes& scans, const NumberedTimes& images,
                           double tolerance) {
  ImageMatches matches;
  std::vector<StampedImage> in_time;
  for (const auto& [number, time] : images) in_time.push_back({time, number});
  std::sort(in_time.begin(), in_time.end());
  if (in_time.empty()) return matches;
  std::map<int, int> scan_of_image;
  for (const auto& [scan, time] : scans) {
    const StampedImage& image = nearest(in_time, time);
    const TimeNs away = std::abs(image.time - time);
    if (seconds(away) > tolerance) continue;
    const auto [taken, is_new] = scan_of_image.emplace(image.number, scan);
    if (!is_new && away < std::abs(image.time - scans.at(taken->second))) taken->second = scan;
  }
  std::vector<double> delays;
  for (const auto& [image, scan] : scan_of_image) {
    matches.image_of_scan.emplace(scan, image);
    delays.push_back(seconds(images.at(image) - scans.at(scan)));
  }
  if (delays.empty()) return matches;
  std::sort(delays.begin(), delays.end());
  matches.median_delay = delays[delays.size() / 2];
  matches.min_delay = delays.front();
  matches.max_delay = delays.back();
  return matches;
}

}  // namespace fovea
