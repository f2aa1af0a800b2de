// What a step takes of memory: readers must not take what a header asks for and the file cannot
// fill.
#pragma once

#include <cstddef>

#include "fovea/core/process_memory.h"

namespace fovea {

/// Bytes by which a step raises the most that the process has ever used. Less than it took where an
/// earlier step took more.
template <class Step>
std::size_t rise_of_peak_memory(Step&& step) {
  const std::size_t before = peak_resident_memory();
  step();
  return peak_resident_memory() - before;
}

inline constexpr std::size_t kMemoryOfASmallFile = std::size_t{20} << 20;

}  // namespace fovea
