// Clouds in PCD.
#include "cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fovea::fuzz_cloud(fovea::CloudFormat::kPcd, data, size);
  return 0;
}
