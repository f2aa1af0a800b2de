// Clouds in LAS.
#include "cloud.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fovea::fuzz_cloud(fovea::CloudFormat::kLas, data, size);
  return 0;
}
