// What a city holds, for `fovea info`.
#pragma once

#include <string>

namespace fovea::app {

/// As text unless one is set.
struct CityInfoForm {
  bool json = false;
  bool digest = false;  ///< only the digest
  bool check = false;   ///< reads all tiles and names those that are damaged
};

/// @param path  folder of the city, or one of its manifests
/// @throws InputError  if the manifest is damaged, or if a tile is and `form` has it read
void print_city(const std::string& path, const CityInfoForm& form);

}  // namespace fovea::app
