// How the colors of a map are shown: the exposure of a picture, in 8 bits.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/color.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// Converts colors of a map to 8 bits.
class ColorDisplay {
 public:
  /// The reference exposure of the map. Values above 255 become 255.
  ColorDisplay() : ColorDisplay(ViewLight(), /*tone_mapped=*/false) {}
  /// @param light        of a view, whose vignetting is left out
  /// @param tone_mapped  values above 200 approach 255 smoothly instead of being cut off there
  ColorDisplay(const ViewLight& light, bool tone_mapped);

  Rgb operator()(LogColor color) const {
    return {byte_[0][color.code[0]], byte_[1][color.code[1]], byte_[2][color.code[2]]};
  }
  /// "exposure +0.00 +0.00 +0.00 stops (red, green, blue) above that of the map".
  const std::string& description() const { return description_; }

 private:
  std::array<std::array<std::uint8_t, kMaxColorCode + 1>, 3> byte_;  // of each code
  std::string description_;
};

/// A color of 16 bits a channel: 257 times the 8-bit value, with fractions.
using DeepRgb = std::array<std::uint16_t, 3>;

/// Converts colors of a map to 16 bits.
class DeepColorDisplay {
 public:
  explicit DeepColorDisplay(const ViewLight& light);

  DeepRgb operator()(LogColor color) const {
    return {value_[0][color.code[0]], value_[1][color.code[1]], value_[2][color.code[2]]};
  }
  const std::string& description() const { return description_; }

 private:
  std::array<std::array<std::uint16_t, kMaxColorCode + 1>, 3> value_;  // of each code
  std::string description_;
};

/// Which exposure a picture of a map has.
struct ExposureChoice {
  enum class Kind {
    kAuto,   ///< the median of the camera's exposures, tone-mapped
    kMap,    ///< the reference exposure of the map, tone-mapped
    kFrame,  ///< as in the images of a frame
    kStops   ///< stops above the reference exposure of the map
  };
  Kind kind = Kind::kAuto;
  int frame = 0;
  double stops = 0;
};

/// "auto", "map", "frame:N" or a number of stops, -16 to 16. ConfigError for other text.
ExposureChoice parse_exposure(std::string_view text);

/// Of several cameras in the chosen frame, the first counts. A map without gains is shown in its
/// reference exposure. InputError if the map states no gain of the chosen frame.
/// @param frames  of the map
ColorDisplay color_display(const ExposureChoice& choice, const std::vector<FrameRecord>& frames);

/// Number of points by the largest code of their channels.
using CodeCounts = std::array<std::size_t, kMaxColorCode + 1>;
/// For `auto` the reference exposure of the map, lowered in steps of half a stop until at most 0.1
/// % of the points are cut off; for `map` not lowered. InputError as above.
DeepColorDisplay deep_color_display(const ExposureChoice& choice,
                                    const std::vector<FrameRecord>& frames,
                                    const CodeCounts& points);

}  // namespace fovea
