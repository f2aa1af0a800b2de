// Points in binary glTF: the overviews of a city's tiles, and the parts of an export.
#include "fovea/exporting/tileset/glb.h"

#include "fovea/exporting/tileset/glb_reader.h"
#include "fuzz_input.h"

using namespace fovea;

namespace {

/// The points can be written again.
void check(const std::vector<ExportPoint>& points) {
  for (const ExportPoint& point : points) {
    require(point.position.allFinite(), "positions are finite");
  }
  const Glb again = make_glb(points, /*with_sources=*/true);
  require(read_glb(again.bytes, "again").size() == points.size(), "all points come back");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes = as_text(data, size);
  read_or_refuse([&] {
    const std::vector<ExportPoint> points = read_glb(bytes, "input");
    check(points);
    for (const std::size_t level : {0, 1, 9}) {
      require(read_glb_level(bytes, level, "input").size() <= points.size(),
              "a level is a part of all");
    }
  });
  read_or_refuse([&] {
    const Eigen::AlignedBox3d box = glb_box(bytes.substr(0, kGlbHead), "head");
    require(box.isEmpty() || (box.min().allFinite() && box.max().allFinite()), "a box is finite");
  });
  return 0;
}
