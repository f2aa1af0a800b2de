#include "app/progress_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace fovea::app {
namespace {

/// What is longer ago does not count: frames get slower and faster along a drive.
constexpr double kRecent = 20;  // s
constexpr int kBarWidth = 30;

}  // namespace

ProgressRate::Reading ProgressRate::at(int done, int total, double seconds) {
  if (recent_.empty()) recent_.push_back({0, done - 1});
  recent_.push_back({seconds, done});
  // One that is older stays, for the rate to be of the whole time.
  while (recent_.size() > 2 && recent_[1].seconds < seconds - kRecent) recent_.pop_front();
  const Sample& first = recent_.front();
  const double rate = (done - first.done) / std::max(seconds - first.seconds, 1e-3);
  return {done, total, rate, (total - done) / std::max(rate, 1e-3)};
}

std::string duration_text(double seconds) {
  const long whole = std::lround(std::clamp(seconds, 0.0, 1e9));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

std::string progress_text(const ProgressRate::Reading& reading, std::string_view unit,
                          std::string_view detail) {
  if (reading.total <= 0) {
    return fmt::format("{} {}, {:.1f}/s{}{}", reading.done, unit, reading.per_second,
                       detail.empty() ? "" : ", ", detail);
  }
  return fmt::format("{} of {} {}, {:.1f}/s{}{}, {} left", reading.done, reading.total, unit,
                     reading.per_second, detail.empty() ? "" : ", ", detail,
                     duration_text(reading.seconds_left));
}

std::string progress_bar(const ProgressRate::Reading& reading, std::string_view text, int columns) {
  const double share = reading.total > 0 ? double(reading.done) / reading.total : 1;
  const auto filled = static_cast<std::size_t>(kBarWidth * std::clamp(share, 0.0, 1.0));
  std::string line = fmt::format("[{:<{}}] {}", std::string(filled, '#'), kBarWidth, text);
  // A line that wraps could not be written over.
  if (columns > 1) line.resize(std::min(line.size(), static_cast<std::size_t>(columns - 1)));
  return line;
}

}  // namespace fovea::app
