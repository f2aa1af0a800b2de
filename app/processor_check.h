// Whether a processor runs code for x86-64-v3. This file and processor_guard.cpp are compiled for
// any x86-64 and include no inline function, as the linker could replace it by another file's copy.
#pragma once

#include <cstdint>

namespace fovea::app {

/// What a processor and the operating system say they support (Intel's manual, CPUID and XGETBV).
struct ProcessorWords {
  std::uint32_t leaf_1_ecx = 0;
  std::uint32_t leaf_7_ebx = 0;
  std::uint32_t leaf_80000001_ecx = 0;
  std::uint32_t xcr0 = 0;  ///< which registers the operating system saves
};

/// The first feature of x86-64-v3 that `words` lack; nullptr if they have all.
const char* missing_feature(const ProcessorWords& words) noexcept;

}  // namespace fovea::app
