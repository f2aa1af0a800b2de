// For tests: clouds of other programs, written byte by byte, and damage done to them.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "fovea/core/random.h"
#include "fovea/errors.h"

namespace fovea {

template <class T>
void put(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

template <class T>
void put_at(std::string& bytes, std::size_t offset, T value) {
  bytes.replace(offset, sizeof value, reinterpret_cast<const char*>(&value), sizeof value);
}

/// A folder of the running test's own.
class CloudFileTest : public testing::Test {
 protected:
  CloudFileTest() {
    const testing::TestInfo* test = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = std::filesystem::temp_directory_path() /
              ("fovea_cloud_" + std::to_string(::getpid()) + "_" + test->test_suite_name() + "_" +
               test->name());
    std::filesystem::create_directories(folder_);
  }
  ~CloudFileTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path write(const std::string& content) const {
    std::filesystem::remove(folder_ / "cloud");  // writing it over can wait for the disk
    std::ofstream(folder_ / "cloud", std::ios::binary) << content;
    return folder_ / "cloud";
  }

  /// Every truncation and many bytes changed: read as something, or refused by an InputError.
  template <class Read>
  void expect_damage_is_harmless(const std::string& bytes, Read&& read) const {
    const auto try_to_read = [&](const std::string& damaged) {
      try {
        read(write(damaged));
      } catch (const InputError&) {
      }
    };
    for (std::size_t length = 0; length < bytes.size(); ++length) {
      ASSERT_NO_THROW(try_to_read(bytes.substr(0, length))) << "of length " << length;
    }
    Random random(11);
    for (std::size_t at = 0; at < bytes.size(); ++at) {
      std::string damaged = bytes;
      for (const int value : {0, 0xff, static_cast<int>(random.below(256))}) {
        damaged[at] = static_cast<char>(value);
        ASSERT_NO_THROW(try_to_read(damaged)) << "byte " << at << " is " << value;
      }
    }
  }

  std::filesystem::path folder_;
};

}  // namespace fovea
