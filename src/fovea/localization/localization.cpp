#include "fovea/localize.h"

namespace fovea {

const char* to_string(LocalizationState state) {
  switch (state) {
    case LocalizationState::kLocalized:
      return "localized";
    case LocalizationState::kLost:
      return "lost";
    case LocalizationState::kOutside:
      return "outside";
    case LocalizationState::kSkipped:
      return "skipped";
  }
  return "unknown";
}

}  // namespace fovea
