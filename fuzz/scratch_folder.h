// A folder for readers that need a name beside others: SQLite's files, the files of a calibration.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "fuzz_input.h"

namespace fovea {

/// Gone when the fuzzer ends well; where it stops at a finding, run.sh removes what is left.
class ScratchFolder {
 public:
  ScratchFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "fovea_fuzz_XXXXXX").string();
    require(mkdtemp(pattern.data()) != nullptr, "there is a temporary folder");
    path_ = pattern;
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;

  /// Removes what is in it.
  void clear() const {
    for (const auto& entry : std::filesystem::directory_iterator(path_)) {
      std::filesystem::remove_all(entry.path());
    }
  }

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

}  // namespace fovea
