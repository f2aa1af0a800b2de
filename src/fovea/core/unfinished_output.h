// Outputs that are not whole yet. A program that a signal ends removes them first.
#pragma once

#include <filesystem>
#include <functional>
#include <list>
#include <shared_mutex>
#include <vector>

namespace fovea {

/// Registers an output of this process from its creation until it has its name or is given up.
/// The register belongs to the process, as signals do. Thread-safe.
class UnfinishedOutput {
 public:
  struct Entry {
    std::filesystem::path output;              ///< as the user named it
    std::vector<std::filesystem::path> files;  ///< where it grows: files and folders
    bool finished = false;
  };

  /// @param create  makes the files. If it throws, nothing is registered.
  UnfinishedOutput(const std::filesystem::path& output, std::vector<std::filesystem::path> files,
                   const std::function<void()>& create);
  ~UnfinishedOutput();
  UnfinishedOutput(const UnfinishedOutput&) = delete;
  UnfinishedOutput& operator=(const UnfinishedOutput&) = delete;

  /// The output has its name: a signal no longer removes it.
  void finish();

 private:
  std::list<Entry>::iterator entry_;
};

/// While it lives, discard_unfinished_outputs() waits. For short steps that must not be cut.
class OutputStep {
 public:
  OutputStep();

 private:
  std::shared_lock<std::shared_timed_mutex> lock_;
};

/// Outputs of this process, as the user named them.
struct OutputNames {
  std::vector<std::filesystem::path> finished, discarded;
};

/// Removes the files of all unfinished outputs. From then on every thread that begins, finishes or
/// gives up an output stops there for ever: the caller must end the process. It waits a second for
/// steps that must not be cut, not longer: a disk may hang.
OutputNames discard_unfinished_outputs();

}  // namespace fovea
