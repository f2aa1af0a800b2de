// The map file as it lies on disk: pages of SQLite that anything may have happened to. The first
// byte says how the file is used.
#include <fstream>

#include "fuzz_input.h"
#include "map_reading.h"
#include "scratch_folder.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  if (size == 0) return 0;
  std::ofstream(folder / "a.fovea", std::ios::binary) << as_text(data + 1, size - 1);
  use_map(folder / "a.fovea", data[0]);
  folder.clear();
  return 0;
}
