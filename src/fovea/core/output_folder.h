// Output folders that appear under their name only when they are whole.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/unfinished_output.h"

namespace fovea {

/// A folder that grows as PATH.partial and gets its name by commit(); what was not committed is
/// removed.
class OutputFolder {
 public:
  /// @param contents  names that an output of this kind may have in it: with `force` an existing
  ///                  folder is replaced if it holds no other, so that no slip of the hand removes
  ///                  a folder of something else
  /// OutputError if `path` exists and may not be replaced, if its parent does not exist or cannot
  /// be written to, or if another program is writing the same output.
  OutputFolder(const std::filesystem::path& path, bool force, std::vector<std::string> contents);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where the contents grow.
  const std::filesystem::path& partial() const { return partial_; }

  /// Makes a file, and the folders it lies in. OutputError if that fails.
  void write(const std::filesystem::path& relative, std::string_view bytes) const;

  /// Flushes everything to disk and gives the folder its name, in one step also where it replaces
  /// another. Nothing can be written afterwards.
  void commit();
  /// commit() under another name in the same folder: for names that depend on the contents.
  void commit_as(const std::string& name);

 private:
  std::filesystem::path check_target() const;
  void open_partial_folder();
  /// Gives the folder its name, and `partial_` the old folder or none.
  void exchange();
  void discard() noexcept;

  std::filesystem::path path_;  // as the user named it
  bool force_;
  std::vector<std::string> contents_;
  std::filesystem::path target_, partial_;
  int lock_ = -1;
  UnfinishedOutput unfinished_;  // below lock_, which it opens
};

}  // namespace fovea
