#include "fovea/base/process_memory.h"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace fovea::process_memory_test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool kOwnAllocator = true;  // the sanitizer's, which keeps what is freed
#else
constexpr bool kOwnAllocator = false;
#endif

TEST(ProcessMemory, WhatIsFreedAmongWhatStaysIsGivenBack) {
  constexpr std::size_t kBlock = 1 << 14, kBlocks = 4096;
  release_free_memory();  // of earlier tests
  const std::size_t before = resident_memory();
  std::vector<std::unique_ptr<std::vector<char>>> blocks;
  for (std::size_t i = 0; i < kBlocks; ++i) {
    blocks.push_back(std::make_unique<std::vector<char>>(kBlock, 'x'));
  }
  EXPECT_GT(resident_memory(), before + kBlock * kBlocks * 3 / 4);
  EXPECT_GT(peak_resident_memory(), before + kBlock * kBlocks * 3 / 4);
  for (std::size_t i = 0; i + 1 < kBlocks; ++i) {
    if (i % 8 != 0) blocks[i].reset();  // no end of the heap is free
  }
  release_free_memory();
  if (!kOwnAllocator) {
    EXPECT_LT(resident_memory(), before + kBlock * kBlocks / 2);
  }
}

TEST(ProcessMemory, WarmMemoryIsTakenAgain) {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kBlock = std::size_t{1} << 18;
  release_free_memory();
  const std::size_t before = resident_memory();
  warm_memory(kBytes);
  // Where it is not kept, there is nothing to be said of it: run by allocator_tests, too.
  if (kOwnAllocator || resident_memory() < before + kBytes * 3 / 4) return;
  const std::size_t warm = resident_memory();
  std::vector<std::vector<char>> blocks;
  while (blocks.size() * kBlock < kBytes / 2) blocks.emplace_back(kBlock, 'x');
  EXPECT_LT(resident_memory(), warm + kBytes / 8);
  blocks.clear();
  release_free_memory();
  EXPECT_LT(resident_memory(), before + kBytes / 4);
}

}  // namespace fovea::process_memory_test
