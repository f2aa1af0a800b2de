#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <string>
#include <utility>

#include "fovea/city/city_frames.h"
#include "fovea/errors.h"
#include "fovea/geometry/voxel_grid.h"
#include "fovea/localization/surface_source.h"
#include "fovea/map/map_surfaces.h"

namespace fovea {
namespace {

/// How far around a place its drives' frames are candidates, m.
constexpr double kFramesReach = 100;

/// A tile whose points are being read. It does not move: `surfaces` refers to `map`.
struct OpenTile {
  OpenTile(const CityTileFile& file, const RigidMotion& T_city_tile)
      : map(file.map), surfaces(map), T_local_tile(T_city_tile) {}

  MapReader map;
  MapSurfaces surfaces;
  RigidMotion T_local_tile;
  std::size_t latest_use = 0;
};

class CitySource final : public SurfaceSource {
 public:
  CitySource(const City& city, std::size_t most_open)
      : city_(city), most_open_(std::max<std::size_t>(most_open, 1)) {
    if (city.points() == 0) {
      throw InputError("the city has no points", city.folder.string(), "add drives to it first");
    }
  }

  std::vector<Eigen::Vector3f> points_near(const Eigen::Vector3d& center_local,
                                           double radius) override {
    std::vector<Eigen::Vector3f> points;
    for (const std::size_t number : city_.tiles_near(center_local, radius)) {
      OpenTile& tile = open(number);
      const Eigen::Vector3d center_tile = tile.T_local_tile.inverse() * center_local;
      const Eigen::Matrix3f R = tile.T_local_tile.linear().cast<float>();
      for (const Eigen::Vector3f& p : tile.surfaces.points_near(center_tile, radius)) {
        points.emplace_back(R * p);
      }
    }
    return voxel_thinned(std::move(points), MapSurfaces::kVoxel);
  }

  std::vector<FrameRecord> new_frames_near(const Eigen::Vector3d& place_local) override {
    return new_frames_of(city_.tiles_near(place_local, kFramesReach));
  }
  std::vector<FrameRecord> new_frames() override {
    std::vector<std::size_t> all(city_.tiles.size());
    std::iota(all.begin(), all.end(), std::size_t{0});
    return new_frames_of(all);
  }
  bool is_of_many_drives() const override { return true; }

 private:
  /// A tile, opened. The one that was not used for longest is closed for it.
  OpenTile& open(std::size_t number) {
    auto found = open_.find(number);
    if (found == open_.end()) {
      if (open_.size() >= most_open_) {
        open_.erase(std::min_element(open_.begin(), open_.end(), [](const auto& a, const auto& b) {
          return a.second.latest_use < b.second.latest_use;
        }));
      }
      const CityTileFile& file = city_.tiles.at(number);
      found = open_.try_emplace(number, file, city_.T_local_tile(file.tile)).first;
    }
    found->second.latest_use = ++uses_;
    return found->second;
  }

  /// A frame lies in each tile that has points of its submap, and counts once.
  std::vector<FrameRecord> new_frames_of(const std::vector<std::size_t>& tiles) {
    std::vector<FrameRecord> frames;
    for (const std::size_t number : tiles) {
      if (!tiles_returned_.insert(number).second) continue;
      const CityTileFile& file = city_.tiles.at(number);
      for (CityFrames& drive : frames_of_tile(city_, file.tile, MapReader(file.map))) {
        std::set<int>& returned = frames_returned_[drive.map_id()];
        for (FrameRecord& frame : drive.frames) {
          if (returned.insert(frame.index).second) frames.push_back(std::move(frame));
        }
      }
    }
    return frames;
  }

  const City& city_;
  std::size_t most_open_;
  std::map<std::size_t, OpenTile> open_;  // by number of the tile
  std::size_t uses_ = 0;
  std::set<std::size_t> tiles_returned_;  // whose frames were returned
  std::map<std::string, std::set<int>> frames_returned_;
};

}  // namespace

std::unique_ptr<SurfaceSource> city_surface_source(const City& city, std::size_t most_open) {
  return std::make_unique<CitySource>(city, most_open);
}

}  // namespace fovea
