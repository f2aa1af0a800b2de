// What a frame does with the map, as the default preset works, and the whole chain.
#pragma once

#include <benchmark/benchmark.h>

#include <memory>

#include "bench/bench_data.h"

namespace fovea::bench {

/// A map of all frames but the last, which is the one at hand.
struct MappedStreet;
std::shared_ptr<const MappedStreet> map_street(const BenchData& data);

/// The map as the camera sees it: tiles near it projected, its depth buffer.
void bench_render(benchmark::State& state, const MappedStreet& street);
/// The gain of the image to the map, and its colours into all points in view.
void bench_recolor(benchmark::State& state, const MappedStreet& street);
/// Which of the map's voxels the scan sees through.
void bench_moving(benchmark::State& state, const MappedStreet& street);
/// The paper's ray filter: the scan upsampled twice against the map.
void bench_paper_filter(benchmark::State& state, const MappedStreet& street);
/// New points into the map's tiles.
void bench_store(benchmark::State& state, const MappedStreet& street);
/// Frames by the whole chain, decoding left out, one after the other.
void bench_chain(benchmark::State& state, const BenchData& data);

}  // namespace fovea::bench
