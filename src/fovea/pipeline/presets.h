// The presets of config/, built into the program by cmake/presets.cmake.
#pragma once

#include <span>
#include <string_view>

namespace fovea {

struct Preset {
  std::string_view name;
  std::string_view text;
};

extern const std::span<const Preset> kPresets;

}  // namespace fovea
