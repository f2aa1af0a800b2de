// Conditions of `--where`.
#include "fovea/map/point_filter.h"

#include "fuzz_input.h"
#include "sample_tile.h"

using namespace fovea;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const PointCloud tile = sample_tile();
  read_or_refuse<ConfigError>([&] {
    const PointFilter filter = PointFilter::parse(as_text(data, size));
    require(!filter.empty(), "a text has a condition");
    for (std::size_t i = 0; i < tile.size(); ++i) filter.matches(tile, i, {});
  });
  return 0;
}
