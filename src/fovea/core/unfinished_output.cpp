#include "fovea/core/unfinished_output.h"

#include <chrono>
#include <mutex>
#include <system_error>
#include <utility>

namespace fovea {
namespace {

namespace fs = std::filesystem;

struct Register {
  std::shared_timed_mutex steps;  // shared: a step that must not be cut; exclusive: discarding
  std::mutex guard;               // of the entries
  std::list<UnfinishedOutput::Entry> entries;
  std::vector<fs::path> finished;
};

/// Never destroyed: threads may still use it while the process ends.
Register& outputs() {
  static auto* const all = new Register;
  return *all;
}

/// Other threads may still write into a folder while this empties it.
void remove_with_contents(const fs::path& file) {
  constexpr int kAttempts = 100;
  std::error_code error;
  for (int i = 0; i < kAttempts; ++i) {
    fs::remove_all(file, error);
    if (!error) return;
  }
}

}  // namespace

UnfinishedOutput::UnfinishedOutput(const fs::path& output, std::vector<fs::path> files,
                                   const std::function<void()>& create) {
  const OutputStep step;
  create();
  const std::lock_guard lock(outputs().guard);
  entry_ = outputs().entries.insert(outputs().entries.end(), {output, std::move(files)});
}

UnfinishedOutput::~UnfinishedOutput() {
  const OutputStep step;
  const std::lock_guard lock(outputs().guard);
  if (entry_->finished) outputs().finished.push_back(std::move(entry_->output));
  outputs().entries.erase(entry_);
}

void UnfinishedOutput::finish() {
  const std::lock_guard lock(outputs().guard);
  entry_->finished = true;
}

OutputStep::OutputStep() : lock_(outputs().steps) {}

OutputNames discard_unfinished_outputs() {
  Register& all = outputs();
  static_cast<void>(all.steps.try_lock_for(std::chrono::seconds(1)));  // and never unlocked
  const std::lock_guard lock(all.guard);
  OutputNames names{std::move(all.finished), {}};
  for (const UnfinishedOutput::Entry& entry : all.entries) {
    (entry.finished ? names.finished : names.discarded).push_back(entry.output);
    if (entry.finished) continue;
    for (const fs::path& file : entry.files) remove_with_contents(file);
  }
  // Scratch outputs are finished, too, and then removed.
  std::erase_if(names.finished, [](const fs::path& path) {
    std::error_code ignored;
    return !fs::exists(path, ignored);
  });
  return names;
}

}  // namespace fovea
