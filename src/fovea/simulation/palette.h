// The materials that a city is built of.
#pragma once

#include <cstdint>
#include <vector>

#include "fovea/world/material.h"

namespace fovea {

/// Places of materials in `materials`. The first, kPaint, stands in models for the colour of the
/// single car, jacket or door, which a placement chooses.
struct Palette {
  static constexpr std::uint16_t kPaint = 0;

  std::vector<Material> materials;
  std::uint16_t road = 0, asphalt = 0, kerb = 0, pavement = 0, plaza = 0, grass = 0, soil = 0;
  std::uint16_t concrete = 0, metal = 0, dark_metal = 0, wood = 0, roof_tiles = 0, roof_felt = 0;
  std::uint16_t glass = 0, car_glass = 0, frame_white = 0, frame_dark = 0, curtain = 0, rubber = 0,
                chrome = 0;
  std::uint16_t headlight = 0, taillight = 0, skin = 0, hair = 0, trousers = 0, bark = 0,
                sign_red = 0;
  std::vector<std::uint16_t> walls, car_paints, clothes, doors, leaves, shop_signs, street_signs,
      plates, distant;
};

Palette make_palette();

/// Size of the boards that shop signs, street signs and number plates are made for (m).
inline const Eigen::Vector2f kShopSign{3.2f, 0.55f}, kStreetSign{0.9f, 0.22f}, kPlate{0.52f, 0.11f};

}  // namespace fovea
