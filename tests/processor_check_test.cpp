#include "app/processor_check.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace fovea::processor_check_test {

using app::missing_feature;
using app::ProcessorWords;

// What qemu 7.2's models report (leaves 1, 7 and 0x80000001).
constexpr ProcessorWords kHaswell{0xfffa3223, 0x000007a9, 0x00000021, 0x7};
constexpr ProcessorWords kIvyBridge{0xbfba2203, 0x00000281, 0x00000001, 0x7};
constexpr ProcessorWords kNehalem{0x00b82201, 0, 0x00000001, 0};

TEST(ProcessorCheck, AcceptsTheFirstProcessorsOfX86_64V3) {
  EXPECT_EQ(missing_feature(kHaswell), nullptr);
}

TEST(ProcessorCheck, NamesTheFirstFeatureThatAnOlderProcessorLacks) {
  EXPECT_STREQ(missing_feature(kIvyBridge), "AVX2");
  EXPECT_STREQ(missing_feature(kNehalem), "AVX");
  EXPECT_STREQ(missing_feature({}), "SSE3");
}

TEST(ProcessorCheck, RejectsASystemThatDoesNotSaveAvxRegisters) {
  ProcessorWords words = kHaswell;
  words.xcr0 = 0x3;  // x87 and SSE
  EXPECT_STREQ(missing_feature(words), "AVX registers in the operating system");
}

TEST(ProcessorCheck, EachFeatureIsNeeded) {
  using Word = std::uint32_t ProcessorWords::*;
  const struct {
    Word word;
    std::vector<int> bits;
  } needed[] = {{&ProcessorWords::leaf_1_ecx, {0, 9, 12, 13, 19, 20, 22, 23, 27, 28, 29}},
                {&ProcessorWords::leaf_7_ebx, {3, 5, 8}},
                {&ProcessorWords::leaf_80000001_ecx, {0, 5}},
                {&ProcessorWords::xcr0, {1, 2}}};
  for (const auto& [word, bits] : needed) {
    for (const int bit : bits) {
      ProcessorWords words = kHaswell;
      words.*word &= ~(std::uint32_t{1} << bit);
      EXPECT_NE(missing_feature(words), nullptr) << "bit " << bit;
    }
  }
}

}  // namespace fovea::processor_check_test
