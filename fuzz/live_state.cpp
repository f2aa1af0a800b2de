// What a live map keeps to be continued.
#include "fovea/pipeline/live_state.h"

#include "fuzz_input.h"

using namespace fovea;

namespace {

void check(const LiveState& state) {
  for (const auto& [camera, delay] : state.image_delays) {
    require(std::isfinite(delay), "delays are finite");
  }
  require(!state.world_origin || state.world_origin->allFinite(), "the origin is finite");
  for (const TargetScan& target : state.targets) {
    for (const Eigen::Vector3f& p : target.points_lidar) {
      require(p.allFinite(), "points are finite");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto* const bytes = reinterpret_cast<const std::byte*>(data);
  read_or_refuse([&] {
    const LiveState state = live_state(CheckpointRecord{0, {bytes, bytes + size}});
    check(state);
    const LiveState again = live_state(checkpoint_of(state, 0));
    require(again.image_delays == state.image_delays, "delays are written as they are");
    require(again.world_origin == state.world_origin, "the origin is written as it is");
    require(again.targets.size() == state.targets.size(), "all scans are written");
    for (std::size_t i = 0; i < state.targets.size(); ++i) {
      require(again.targets[i].frame == state.targets[i].frame &&
                  again.targets[i].points_lidar == state.targets[i].points_lidar,
              "scans are written as they are");
    }
  });
  return 0;
}
