// Benchmarks of one thing against a peer: in turns in one process, so that what else the machine
// does hits both.
#pragma once

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fovea::bench {

/// Seconds that this thread has had a processor: others' work on the machine does not count.
inline double thread_seconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

/// A wrong result ends the program: Google Benchmark would note it and report success.
inline void check(bool right, const std::string& wrong) {
  if (!right) throw std::logic_error("wrong result: " + wrong);
}

template <class Work>
double seconds_of(Work&& work) {
  const double start = thread_seconds();
  benchmark::DoNotOptimize(work());
  return thread_seconds() - start;
}

inline double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

/// Times `ours`, and in turns with it `peer`. Counters: the peer's median in ms (`peer_ms`), ours
/// (`median_ms`), and the median of the turns' ratios, above 1 where ours is faster (`ratio`).
template <class Ours, class Peer>
void duel(benchmark::State& state, Ours&& ours, Peer&& peer) {
  std::vector<double> our_ms, peer_ms, ratio;
  for (auto _ : state) {
    const double seconds = seconds_of(ours), peer_seconds = seconds_of(peer);
    state.SetIterationTime(seconds);
    our_ms.push_back(1e3 * seconds);
    peer_ms.push_back(1e3 * peer_seconds);
    ratio.push_back(peer_seconds / seconds);
  }
  state.counters["median_ms"] = median(our_ms);
  state.counters["peer_ms"] = median(peer_ms);
  state.counters["ratio"] = median(ratio);
}

/// Times `ours` alone; counter `median_ms`. `prepare` is called before each turn, and not timed.
template <class Prepare, class Ours>
void solo(benchmark::State& state, Prepare&& prepare, Ours&& ours) {
  std::vector<double> our_ms;
  for (auto _ : state) {
    prepare();
    const double seconds = seconds_of(ours);
    state.SetIterationTime(seconds);
    our_ms.push_back(1e3 * seconds);
  }
  state.counters["median_ms"] = median(our_ms);
}

template <class Ours>
void solo(benchmark::State& state, Ours&& ours) {
  solo(state, [] {}, std::forward<Ours>(ours));
}

}  // namespace fovea::bench
