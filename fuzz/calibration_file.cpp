// Calibration files of ROS, Kalibr and SensorsCalibration.
#include "fovea/drive/calibration_file.h"

#include <fstream>

#include "fuzz_input.h"
#include "scratch_folder.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const ScratchFolder folder;
  const std::filesystem::path file = folder / "c.yaml";
  std::ofstream(file, std::ios::binary) << as_text(data, size);
  for (const char* camera : {"", "cam0"}) {
    read_or_refuse([&] {
      const LensCamera found = read_calibration_file(file, camera);
      require(coefficient_count(found.lens.model()) <= 8, "a lens has its coefficients");
    });
  }
  return 0;
}
