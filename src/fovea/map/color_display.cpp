#include "fovea/map/color_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "fovea/core/errors.h"
#include "fovea/core/median.h"
#include "fovea/core/read_file.h"

namespace fovea {
namespace {

constexpr double kMaxStops = 16, kMaxFrame = 1e9;

std::optional<double> one_number(std::string_view text) {
  const auto numbers = parse_numbers(text);
  if (!numbers || numbers->size() != 1) return std::nullopt;
  return numbers->front();
}

/// Identity up to 200. From there on the slope falls from 1, and the value approaches 255.
double tone_mapped_value(double value) {
  constexpr double kShoulder = 200, kWhite = 255;
  if (value <= kShoulder) return value;
  return kShoulder +
         (kWhite - kShoulder) * (1 - std::exp(-(value - kShoulder) / (kWhite - kShoulder)));
}

std::optional<LogGain> gain_of_frame(const FrameRecord& frame) {
  for (const ViewRecord& view : frame.views) {
    if (view.log2_gain) return view.log2_gain->cast<float>().array();
  }
  return std::nullopt;
}

/// Of each channel; absent without gains.
std::optional<LogGain> median_gain(const std::vector<FrameRecord>& frames) {
  std::array<std::vector<double>, 3> gains;
  for (const FrameRecord& frame : frames) {
    for (const ViewRecord& view : frame.views) {
      if (!view.log2_gain) continue;
      for (int c = 0; c < 3; ++c) gains[std::size_t(c)].push_back((*view.log2_gain)[c]);
    }
  }
  if (gains[0].empty()) return std::nullopt;
  LogGain median;
  for (int c = 0; c < 3; ++c) {
    median[c] = static_cast<float>(median_of(std::move(gains[std::size_t(c)])));
  }
  return median;
}

}  // namespace

ColorDisplay::ColorDisplay(const LogGain& gain, bool tone_mapped) {
  for (int c = 0; c < 3; ++c) {
    const double factor = std::exp2(double(gain[c]));
    for (int code = 0; code <= kMaxColorCode; ++code) {
      double value = factor * color_value(static_cast<std::uint16_t>(code));
      if (tone_mapped) value = tone_mapped_value(value);
      byte_[std::size_t(c)][std::size_t(code)] =
          static_cast<std::uint8_t>(std::lround(std::min(value, 255.0)));
    }
  }
}

ExposureChoice parse_exposure(std::string_view text) {
  constexpr std::string_view kFramePrefix = "frame:";
  if (text == "auto") return {};
  if (text.starts_with(kFramePrefix)) {
    const auto frame = one_number(text.substr(kFramePrefix.size()));
    if (frame && *frame >= 0 && *frame <= kMaxFrame && *frame == std::floor(*frame)) {
      return {ExposureChoice::Kind::kFrame, static_cast<int>(*frame), 0};
    }
  } else if (const auto stops = one_number(text); stops && std::abs(*stops) <= kMaxStops) {
    return {ExposureChoice::Kind::kStops, 0, *stops};
  }
  throw ConfigError(fmt::format("'{}' is no exposure", text), "--exposure",
                    fmt::format("write auto, frame:N or stops from -{0:g} to {0:g}", kMaxStops));
}

ColorDisplay color_display(const ExposureChoice& choice, const std::vector<FrameRecord>& frames) {
  if (choice.kind == ExposureChoice::Kind::kStops) {
    return {LogGain::Constant(static_cast<float>(choice.stops)), /*tone_mapped=*/false};
  }
  if (choice.kind == ExposureChoice::Kind::kAuto) {
    const std::optional<LogGain> gain = median_gain(frames);
    return gain ? ColorDisplay(*gain, /*tone_mapped=*/true) : ColorDisplay();
  }
  const auto frame = std::find_if(frames.begin(), frames.end(), [&](const FrameRecord& record) {
    return record.index == choice.frame;
  });
  const std::optional<LogGain> gain = frame != frames.end() ? gain_of_frame(*frame) : std::nullopt;
  if (!gain) {
    throw InputError("the map states no exposure of the frame",
                     fmt::format("frame {}", choice.frame), "choose a frame that was mapped");
  }
  return {*gain, /*tone_mapped=*/false};
}

}  // namespace fovea
