#include <algorithm>
#include <utility>

#include "fovea/errors.h"
#include "fovea/localization/surface_source.h"
#include "fovea/map/map_surfaces.h"

namespace fovea {
namespace {

class MapSource final : public SurfaceSource {
 public:
  explicit MapSource(const MapReader& map) : map_(map), state_(map.hold_state()), surfaces_(map) {
    if (map.size() == 0) {
      throw InputError("the map is empty", "the map's table 'tiles'", "map a drive first");
    }
    const std::vector<FrameRecord> frames = map.frames();
    const bool has_mapped = std::any_of(frames.begin(), frames.end(), [](const FrameRecord& frame) {
      return frame.status != FrameStatus::kSkipped;
    });
    if (!has_mapped) {
      throw InputError("the map has no frame that was mapped", "the map's table 'frames'",
                       kRestoreMap);
    }
  }

  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local,
                                           double radius) override {
    return surfaces_.points_near(center_local, radius);
  }
  std::vector<FrameRecord> new_frames_near(const Eigen::Vector3d& /*place_local*/) override {
    return new_frames();
  }
  bool is_of_many_drives() const override { return false; }
  std::vector<FrameRecord> new_frames() override {
    return std::exchange(returned_, true) ? std::vector<FrameRecord>() : map_.frames();
  }

 private:
  const MapReader& map_;
  std::shared_ptr<const void> state_;  // of the map
  MapSurfaces surfaces_;
  bool returned_ = false;  // the frames
};

}  // namespace

std::unique_ptr<SurfaceSource> map_surface_source(const MapReader& map) {
  return std::make_unique<MapSource>(map);
}

}  // namespace fovea
