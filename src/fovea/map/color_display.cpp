#include "fovea/map/color_display.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "fovea/core/median.h"
#include "fovea/core/read_file.h"
#include "fovea/errors.h"

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

std::optional<ViewLight> light_of_frame(const FrameRecord& frame) {
  for (const ViewRecord& view : frame.views) {
    if (view.log2_gain) return view.light();
  }
  return std::nullopt;
}

/// The median gain of each channel; absent without gains.
std::optional<ViewLight> median_light(const std::vector<FrameRecord>& frames) {
  ViewLight light;
  std::array<std::vector<double>, 3> gains;
  for (const FrameRecord& frame : frames) {
    for (const ViewRecord& view : frame.views) {
      if (!view.log2_gain) continue;
      light.response = view.response;
      for (int c = 0; c < 3; ++c) gains[std::size_t(c)].push_back((*view.log2_gain)[c]);
    }
  }
  if (gains[0].empty()) return std::nullopt;
  for (int c = 0; c < 3; ++c) {
    light.gain[c] = static_cast<float>(median_of(std::move(gains[std::size_t(c)])));
  }
  return light;
}

/// Of a code, as a view with this light shows it; may exceed 255.
Eigen::Array3f shown_value(int code, const ViewLight& light) {
  const auto number = static_cast<std::uint16_t>(code);
  const Eigen::Vector3f in_map = to_float(LogColor::of_codes(number, number, number));
  return image_color(in_map.array(), light, /*s=*/0).max(0.0f);
}

std::string describe(const ViewLight& light) {
  return fmt::format(
      "exposure {:+.2f} {:+.2f} {:+.2f} stops (red, green, blue) above that of the map",
      light.gain[0], light.gain[1], light.gain[2]);
}

/// Of a choice other than auto.
ViewLight light_of_choice(const ExposureChoice& choice, const std::vector<FrameRecord>& frames) {
  if (choice.kind == ExposureChoice::Kind::kMap) return {};
  if (choice.kind == ExposureChoice::Kind::kStops) {
    ViewLight light = median_light(frames).value_or(ViewLight());
    light.gain.setConstant(static_cast<float>(choice.stops));
    return light;
  }
  const auto frame = std::find_if(frames.begin(), frames.end(), [&](const FrameRecord& record) {
    return record.index == choice.frame;
  });
  const std::optional<ViewLight> light =
      frame != frames.end() ? light_of_frame(*frame) : std::nullopt;
  if (!light) {
    throw InputError("the map states no exposure of the frame",
                     fmt::format("frame {}", choice.frame), "choose a frame that was mapped");
  }
  return *light;
}

}  // namespace

ColorDisplay::ColorDisplay(const ViewLight& light, bool tone_mapped)
    : description_(describe(light) + (tone_mapped ? ", tone-mapped from 200 on" : "")) {
  for (int code = 0; code <= kMaxColorCode; ++code) {
    const Eigen::Array3f shown = shown_value(code, light);
    for (int c = 0; c < 3; ++c) {
      auto value = double(shown[c]);
      if (tone_mapped) value = tone_mapped_value(value);
      byte_[std::size_t(c)][std::size_t(code)] =
          static_cast<std::uint8_t>(std::lround(std::min(value, 255.0)));
    }
  }
}

DeepColorDisplay::DeepColorDisplay(const ViewLight& light) : description_(describe(light)) {
  for (int code = 0; code <= kMaxColorCode; ++code) {
    const Eigen::Array3f shown = shown_value(code, light).min(255.0f);
    for (int c = 0; c < 3; ++c) {
      value_[std::size_t(c)][std::size_t(code)] =
          static_cast<std::uint16_t>(std::lround(257 * shown[c]));
    }
  }
}

ExposureChoice parse_exposure(std::string_view text) {
  constexpr std::string_view kFramePrefix = "frame:";
  if (text == "auto") return {};
  if (text == "map") return {ExposureChoice::Kind::kMap, 0, 0};
  if (text.starts_with(kFramePrefix)) {
    const auto frame = one_number(text.substr(kFramePrefix.size()));
    if (frame && *frame >= 0 && *frame <= kMaxFrame && *frame == std::floor(*frame)) {
      return {ExposureChoice::Kind::kFrame, static_cast<int>(*frame), 0};
    }
  } else if (const auto stops = one_number(text); stops && std::abs(*stops) <= kMaxStops) {
    return {ExposureChoice::Kind::kStops, 0, *stops};
  }
  throw ConfigError(
      fmt::format("'{}' is no exposure", text), "--exposure",
      fmt::format("write auto, map, frame:N or stops from -{0:g} to {0:g}", kMaxStops));
}

ColorDisplay color_display(const ExposureChoice& choice, const std::vector<FrameRecord>& frames) {
  if (choice.kind == ExposureChoice::Kind::kMap) return {ViewLight(), /*tone_mapped=*/true};
  if (choice.kind != ExposureChoice::Kind::kAuto) {
    return {light_of_choice(choice, frames), /*tone_mapped=*/false};
  }
  const std::optional<ViewLight> light = median_light(frames);
  return light ? ColorDisplay(*light, /*tone_mapped=*/true) : ColorDisplay();
}

DeepColorDisplay deep_color_display(const ExposureChoice& choice,
                                    const std::vector<FrameRecord>& frames,
                                    const CodeCounts& points) {
  if (choice.kind != ExposureChoice::Kind::kAuto) {
    return DeepColorDisplay(light_of_choice(choice, frames));
  }
  constexpr float kStep = 0.5f;  // stops
  constexpr double kMostCutOff = 0.001;
  const auto all = double(std::accumulate(points.begin(), points.end(), std::size_t{0}));
  ViewLight light;
  light.response = median_light(frames).value_or(ViewLight()).response;
  const auto cut_off = [&] {
    std::size_t count = 0;
    for (int code = kMaxColorCode; code > 0 && shown_value(code, light)[0] > 255; --code) {
      count += points[std::size_t(code)];
    }
    return double(count);
  };
  while (cut_off() > kMostCutOff * all) light.gain -= kStep;
  return DeepColorDisplay(light);
}

}  // namespace fovea
