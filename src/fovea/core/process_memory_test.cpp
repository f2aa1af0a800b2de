#include "fovea/core/process_memory.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

/// There in allocator_tests, which have the program's allocator.
extern "C" [[gnu::weak]] int mallctl(const char* name, void* old_value, std::size_t* old_size,
                                     void* new_value, std::size_t new_size);

namespace fovea::process_memory_test {

#if defined(FOVEA_SANITIZER)
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

bool has_huge_pages() {
  std::string modes;
  std::getline(std::ifstream("/sys/kernel/mm/transparent_hugepage/enabled"), modes);
  return modes.find("[always]") != std::string::npos ||
         modes.find("[madvise]") != std::string::npos;
}

long page_faults() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_minflt;
}

TEST(ProcessMemory, ReservedMemoryIsTakenInHugePages) {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kBlock = std::size_t{1} << 18;
  const std::size_t before = resident_memory();
  reserve_memory(kBytes);
  EXPECT_LT(resident_memory(), before + kBytes / 8);
  if (kOwnAllocator || mallctl == nullptr || !has_huge_pages()) return;
  const long faults = page_faults();
  std::vector<std::vector<char>> blocks;
  while (blocks.size() * kBlock < kBytes / 4) blocks.emplace_back(kBlock, 'x');
  EXPECT_LT(page_faults(), faults + long(kBytes / 4 / 4096) / 8);
}

TEST(ProcessMemory, WarmMemoryIsTakenAgain) {
  constexpr std::size_t kBytes = std::size_t{64} << 20, kBlock = std::size_t{1} << 18;
  release_free_memory();
  const std::size_t before = resident_memory();
  warm_memory(kBytes);
  const std::size_t warm = resident_memory();
  if (kOwnAllocator || mallctl == nullptr) return;  // another allocator need not keep it
  EXPECT_GT(warm, before + kBytes * 3 / 4);
  std::vector<std::vector<char>> blocks;
  while (blocks.size() * kBlock < kBytes / 2) blocks.emplace_back(kBlock, 'x');
  EXPECT_LT(resident_memory(), warm + kBytes / 8);
  blocks.clear();
  release_free_memory();
  EXPECT_LT(resident_memory(), before + kBytes / 4);
}

}  // namespace fovea::process_memory_test
