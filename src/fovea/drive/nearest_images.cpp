#include "fovea/drive/nearest_images.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace fovea {
namespace {

struct StampedImage {
  TimeNs time;
  int number;
  friend auto operator<=>(const StampedImage&, const StampedImage&) = default;
};

std::vector<StampedImage> in_order_of_time(const NumberedTimes& images) {
  std::vector<StampedImage> in_time;
  for (const auto& [number, time] : images) in_time.push_back({time, number});
  std::sort(in_time.begin(), in_time.end());
  return in_time;
}

const StampedImage& nearest(const std::vector<StampedImage>& images, TimeNs time) {
  const auto after = std::lower_bound(images.begin(), images.end(), time,
                                      [](const StampedImage& i, TimeNs t) { return i.time < t; });
  if (after == images.begin()) return *after;
  if (after == images.end()) return *(after - 1);
  return time - (after - 1)->time <= after->time - time ? *(after - 1) : *after;
}

/// @param delay  of the images, that they are looked for after a scan's stamp
std::map<int, int> match(const NumberedTimes& scans, const std::vector<StampedImage>& images,
                         double tolerance, TimeNs delay) {
  struct Taken {
    int scan;
    TimeNs away;
  };
  std::map<int, Taken> by_image;
  for (const auto& [scan, time] : scans) {
    const StampedImage& image = nearest(images, time + delay);
    const TimeNs away = std::abs(image.time - time - delay);
    if (seconds(away) > tolerance) continue;
    const auto [taken, is_new] = by_image.emplace(image.number, Taken{scan, away});
    if (!is_new && away < taken->second.away) taken->second = {scan, away};
  }
  std::map<int, int> image_of_scan;
  for (const auto& [image, taken] : by_image) image_of_scan.emplace(taken.scan, image);
  return image_of_scan;
}

/// How much later than their scans the images are, ascending.
std::vector<TimeNs> delays_of(const std::map<int, int>& image_of_scan, const NumberedTimes& scans,
                              const NumberedTimes& images) {
  std::vector<TimeNs> delays;
  delays.reserve(image_of_scan.size());
  for (const auto& [scan, image] : image_of_scan) {
    delays.push_back(images.at(image) - scans.at(scan));
  }
  std::sort(delays.begin(), delays.end());
  return delays;
}

/// The first and the last of some times, at least one.
std::pair<TimeNs, TimeNs> time_span(const NumberedTimes& times) {
  std::pair<TimeNs, TimeNs> span(times.begin()->second, times.begin()->second);
  for (const auto& [number, time] : times) {
    span.first = std::min(span.first, time);
    span.second = std::max(span.second, time);
  }
  return span;
}

}  // namespace

ImageMatches match_nearest(const NumberedTimes& scans, const NumberedTimes& images,
                           double sweep_middle, double tolerance) {
  ImageMatches matches;
  const std::vector<StampedImage> in_time = in_order_of_time(images);
  if (in_time.empty()) return matches;
  const std::vector<TimeNs> first =
      delays_of(match(scans, in_time, tolerance, from_seconds(sweep_middle)), scans, images);
  if (first.empty()) return matches;
  matches.image_of_scan = match(scans, in_time, tolerance, first[first.size() / 2]);
  const std::vector<TimeNs> delays = delays_of(matches.image_of_scan, scans, images);
  matches.median_delay = seconds(delays[delays.size() / 2]);
  matches.min_delay = seconds(delays.front());
  matches.max_delay = seconds(delays.back());
  return matches;
}

std::map<int, int> match_scans(const NumberedTimes& scans, const NumberedTimes& others,
                               double delay, double tolerance) {
  const std::vector<StampedImage> in_time = in_order_of_time(others);
  if (in_time.empty()) return {};
  return match(scans, in_time, tolerance, from_seconds(delay));
}

std::string why_none_matches(const NumberedTimes& scans, const NumberedTimes& images,
                             double tolerance) {
  if (images.empty()) return "no image has a stamp";
  if (scans.empty()) return "no scan has a stamp";
  const auto [first_scan, last_scan] = time_span(scans);
  const auto [first_image, last_image] = time_span(images);
  const bool apart = first_image > last_scan || last_image < first_scan;
  return fmt::format(
      "{}, images have stamps from {:.3f} to {:.3f} s, scans from {:.3f} to {:.3f} s",
      apart ? "they have different clocks"
            : fmt::format("none lies within {:g} s of one", tolerance),
      seconds(first_image), seconds(last_image), seconds(first_scan), seconds(last_scan));
}

}  // namespace fovea
