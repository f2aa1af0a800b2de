// Registration's parts, as the default preset works: scan against local map.
#pragma once

#include <benchmark/benchmark.h>

#include "bench/bench_data.h"

namespace fovea::bench {

/// A scan to one point a voxel.
void bench_thinning(benchmark::State& state, const BenchData& data);
/// Normals of a thinned scan; the peer: by the nearest ten in a kd-tree.
void bench_normals(benchmark::State& state, const BenchData& data);
/// A scan against the local map of those before; the peer: pairs by a kd-tree, built before.
void bench_alignment(benchmark::State& state, const BenchData& data);
/// A scan into the local map, the oldest out of it.
void bench_local_map(benchmark::State& state, const BenchData& data);

}  // namespace fovea::bench
