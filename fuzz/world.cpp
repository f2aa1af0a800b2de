// The world of a simulated drive: world.json and, behind "---", world.ply.
#include <fstream>

#include "fovea/world/world_file.h"
#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  constexpr std::string_view kBetween = "---\n";
  const std::string_view text = as_text(data, size);
  const std::size_t end = text.find(kBetween);
  std::ofstream(folder / "world.json", std::ios::binary) << text.substr(0, end);
  std::ofstream(folder / "world.ply", std::ios::binary)
      << (end == text.npos ? "" : text.substr(end + kBetween.size()));
  read_or_refuse([&] {
    const World world = read_world(folder.path());
    world.mesh_local.check();
    for (const std::uint16_t material : world.mesh_local.material) {
      require(material < world.materials.size(), "triangles have a material");
    }
  });
  return 0;
}
