// JPEG images.
#include <stdexcept>

#include "fovea/drive/images/jpeg_decode.h"
#include "fuzz_input.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  read_or_refuse<std::runtime_error>([&] {
    const Image image = decode_jpeg({data, size});
    require(image.channels == 1 || image.channels == 3, "an image is grey or RGB");
    require(image.data.size() == std::size_t(image.width) * image.height * image.channels,
            "an image is whole");
  });
  return 0;
}
