#include "app/processor_check.h"

namespace fovea::app {
namespace {

using Word = std::uint32_t ProcessorWords::*;

struct Feature {
  const char* name;
  Word word;
  std::uint32_t bits;
};

constexpr std::uint32_t bit(int number) { return std::uint32_t{1} << number; }

// The lists of x86-64-v2 and x86-64-v3 in the x86-64 psABI.
constexpr Feature kFeatures[] = {
    {"SSE3", &ProcessorWords::leaf_1_ecx, bit(0)},
    {"SSSE3", &ProcessorWords::leaf_1_ecx, bit(9)},
    {"CMPXCHG16B", &ProcessorWords::leaf_1_ecx, bit(13)},
    {"SSE4.1", &ProcessorWords::leaf_1_ecx, bit(19)},
    {"SSE4.2", &ProcessorWords::leaf_1_ecx, bit(20)},
    {"POPCNT", &ProcessorWords::leaf_1_ecx, bit(23)},
    {"LAHF-SAHF", &ProcessorWords::leaf_80000001_ecx, bit(0)},
    {"AVX", &ProcessorWords::leaf_1_ecx, bit(28)},
    {"AVX2", &ProcessorWords::leaf_7_ebx, bit(5)},
    {"FMA", &ProcessorWords::leaf_1_ecx, bit(12)},
    {"F16C", &ProcessorWords::leaf_1_ecx, bit(29)},
    {"MOVBE", &ProcessorWords::leaf_1_ecx, bit(22)},
    {"BMI1", &ProcessorWords::leaf_7_ebx, bit(3)},
    {"BMI2", &ProcessorWords::leaf_7_ebx, bit(8)},
    {"LZCNT", &ProcessorWords::leaf_80000001_ecx, bit(5)},
    {"OSXSAVE", &ProcessorWords::leaf_1_ecx, bit(27)},
    {"AVX registers in the operating system", &ProcessorWords::xcr0, bit(1) | bit(2)},
};

}  // namespace

const char* missing_feature(const ProcessorWords& words) noexcept {
  for (const Feature& feature : kFeatures) {
    if ((words.*feature.word & feature.bits) != feature.bits) return feature.name;
  }
  return nullptr;
}

}  // namespace fovea::app
