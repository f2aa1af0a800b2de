#include "bench/mapping_bench.h"

#include "bench/duel.h"
#include "fovea/geometry/transform_cloud.h"
#include "fovea/pipeline/config.h"
#include "fovea/pipeline/foveal_query.h"
#include "fovea/pipeline/mapper.h"
#include "fovea/pipeline/visible_map.h"
#include "fovea/upsample.h"

namespace fovea::bench {
namespace {

/// The first frames meet an empty map.
constexpr std::size_t kFirstCounted = 5;

}  // namespace

struct MappedStreet {
  MapperOptions options = load_preset("default").mapper();
  const BenchData& data;
  TileMap map;
  FrameRecord last;  // pose of the frame at hand, which is not in the map
  FovealRegion region;

  explicit MappedStreet(const BenchData& bench_data)
      : data(bench_data), region(options.foveal, data.camera, kOneLidar) {
    Mapper mapper(data.drive, options, PoseSource::kRefine);
    for (std::size_t k = 0; k < data.frames.size(); ++k) {
      const bool is_last = k + 1 == data.frames.size();
      last = record_of(mapper.process(data.frames[k], {.held_out = is_last}));
    }
    map = mapper.map();
    check(map.size() > 10'000, "a map without points");
  }
  const Frame& frame() const { return data.frames.back(); }
  RigidMotion T_cam_local() const { return data.camera.T_cam_lidar * last.T_local_lidar.inverse(); }
  ViewColors view(const ImagePyramid& image) const {
    return {image, data.camera, options.footprint};
  }
};

std::shared_ptr<const MappedStreet> map_street(const BenchData& data) {
  return std::make_shared<MappedStreet>(data);
}

void bench_render(benchmark::State& state, const MappedStreet& street) {
  VisibleMap seen;
  solo(state, [&] {
    seen.render(street.map, street.region, street.T_cam_local(), street.options.surface.spacing);
    return &seen;
  });
  state.counters["map"] = static_cast<double>(street.map.size());
}

void bench_recolor(benchmark::State& state, const MappedStreet& street) {
  TileMap map = street.map;
  VisibleMap seen;
  seen.render(map, street.region, street.T_cam_local(), street.options.surface.spacing);
  const ImagePyramid image(street.frame().images.front());
  std::size_t points = 0;
  solo(state, [&] {
    const ViewColors view = street.view(image);
    benchmark::DoNotOptimize(gain_of(seen.differences(view, /*below=*/1).recent));
    return points = seen.recolor(map, view, street.frame().index);
  });
  check(points > 1000, "nothing in view");
  state.counters["points"] = static_cast<double>(points);
}

void bench_moving(benchmark::State& state, const MappedStreet& street) {
  DynamicPointFilter moving(street.options.dynamic);
  int frame = street.frame().index;
  const RigidMotion T_odom_local = street.last.T_odom_lidar * street.last.T_local_lidar.inverse();
  solo(state, [&] {
    moving.replay(street.map, {{RangeImage(street.frame().scan.position)}},
                  street.last.T_odom_lidar, T_odom_local, ++frame);
    return frame;
  });
}

void bench_paper_filter(benchmark::State& state, const MappedStreet& street) {
  const RayFilterOptions options;
  const PointCloud dense = upsample(street.data.scan_cam, street.data.camera, UpsampleOptions());
  RayFilter filter;
  std::size_t in_view = 0;
  solo(state, [&] {
    const std::vector<Ray> map = map_rays(street.map, street.region, street.last.T_local_lidar);
    in_view = map.size();
    return filter.filter(rays_of(dense, street.data.camera), map, street.data.camera, options)
        .size();
  });
  check(in_view > 1000, "no map in view");
  state.counters["points"] = static_cast<double>(dense.size());
  state.counters["map"] = static_cast<double>(in_view);
}

void bench_store(benchmark::State& state, const MappedStreet& street) {
  // As many points as a frame adds, and where: those of the map's last frame.
  PointCloud added;
  const int newest = street.data.frames[street.data.frames.size() - 2].index;
  for (const Submap& submap : street.map.submaps()) {
    for (const auto& [key, stored] : submap.tiles) {
      const PointCloud tile = stored.points->cloud();
      std::vector<std::uint32_t> of_frame;
      for (std::uint32_t i = 0; i < tile.size(); ++i) {
        if (tile.frame[i] == newest) of_frame.push_back(i);
      }
      if (of_frame.empty()) continue;
      added.append(transform_cloud(tile.select(of_frame), submap.T_local_submap));
    }
  }
  check(!added.empty(), "a frame without points");
  TileMap map;
  const auto own_copy = [&] {
    map = street.map;
    for (std::size_t id = 0; id < map.submaps().size(); ++id) {
      for (const auto& [key, stored] : map.submaps()[id].tiles) map.colors({id, key});
    }
  };
  solo(state, own_copy, [&] {
    map.add(added);
    return map.size();
  });
  state.counters["points"] = static_cast<double>(added.size());
}

void bench_chain(benchmark::State& state, const BenchData& data) {
  const MapperOptions options = load_preset("default").mapper();
  std::unique_ptr<Mapper> mapper;
  std::size_t next = data.frames.size();
  const auto start_anew = [&] {
    if (next < data.frames.size()) return;
    mapper = std::make_unique<Mapper>(data.drive, options, PoseSource::kRefine);
    for (next = 0; next < std::min(kFirstCounted, data.frames.size() - 1); ++next) {
      mapper->process(data.frames[next]);
    }
  };
  solo(state, start_anew, [&] {
    const FrameResult result = mapper->process(data.frames[next++]);
    check(!result.tracking.is_weak(), "a scan that does not fit the ones before");
    return result.index;
  });
}

}  // namespace fovea::bench
