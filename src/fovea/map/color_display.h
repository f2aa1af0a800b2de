// How the colors of a map are shown: the exposure of a picture, in 8 bits.
#pragma once

#include <array>
#include <string_view>
#include <vector>

#include "fovea/core/log_color.h"
#include "fovea/map/frame_record.h"

namespace fovea {

/// Converts colors of a map to 8 bits.
class ColorDisplay {
 public:
  /// The reference exposure of the map. Values above 255 become 255.
  ColorDisplay() : ColorDisplay(LogGain::Zero(), /*tone_mapped=*/false) {}
  /// @param gain         picture = map * 2^gain
  /// @param tone_mapped  values above 200 approach 255 smoothly instead of being cut off there
  ColorDisplay(const LogGain& gain, bool tone_mapped);

  Rgb operator()(LogColor color) const {
    return {byte_[0][color.code[0]], byte_[1][color.code[1]], byte_[2][color.code[2]]};
  }

 private:
  std::array<std::array<std::uint8_t, kMaxColorCode + 1>, 3> byte_;  // of each code
};

/// Which exposure a picture of a map has.
struct ExposureChoice {
  enum class Kind {
    kAuto,   ///< the median of the camera's exposures, tone-mapped
    kFrame,  ///< as in the images of a frame
    kStops   ///< stops above the reference exposure of the map
  };
  Kind kind = Kind::kAuto;
  int frame = 0;
  double stops = 0;
};

/// "auto", "frame:N" or a number of stops, -16 to 16. ConfigError for other text.
ExposureChoice parse_exposure(std::string_view text);

/// Of several cameras in the chosen frame, the first counts. A map without gains is shown in its
/// reference exposure. InputError if the map states no gain of the chosen frame.
/// @param frames  of the map
ColorDisplay color_display(const ExposureChoice& choice, const std::vector<FrameRecord>& frames);

}  // namespace fovea
