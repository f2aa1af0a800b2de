// The manifest of a city. Its tiles may have the names of three files that exist.
#include "fovea/city/city.h"

#include <algorithm>
#include <fstream>

#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

namespace {

/// A city's folder with files for tiles. open_city() does not read them.
class CityFolder : public ScratchFolder {
 public:
  CityFolder() {
    std::filesystem::create_directory(path() / "tiles");
    for (const char* tile : {"0_0", "1_-1", "-2_3"}) {
      std::ofstream(path() / "tiles" / fmt::format("{}_0.fovea", tile)) << "a tile";
    }
  }
};

void check(const City& city) {
  const auto is_before = [](const CityTileFile& a, const CityTileFile& b) {
    return !(b.tile <= a.tile);
  };
  require(std::is_sorted(city.tiles.begin(), city.tiles.end(), is_before), "tiles are in order");
  for (const CityTileFile& file : city.tiles) {
    const std::filesystem::path in_city = file.map.lexically_relative(city.folder);
    require(!in_city.empty() && *in_city.begin() != "..", "a tile lies in the folder of the city");
    require(city.T_local_tile(file.tile).matrix().allFinite(), "a tile is somewhere");
    require(file.revision >= 0, "revisions are counted");
  }
  for (const CityDrive& drive : city.drives) {
    require(drive.length >= 0, "a drive has a length");
  }
  for (const double meters : city.extent()) require(meters >= 0, "a city has an extent");
  require(city.tiles_near(Eigen::Vector3d::Zero(), 1e9).size() <= city.tiles.size(),
          "each tile is near once");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const CityFolder folder;
  std::ofstream(folder / "city.json", std::ios::binary) << as_text(data, size);
  read_or_refuse([&] { check(open_city(folder.path())); });
  return 0;
}
