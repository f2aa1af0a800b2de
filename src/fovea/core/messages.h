// What the user must know of a drive or a run.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace fovea {

/// Messages in the order in which they arose. A warning says that a result may be wrong or
/// incomplete; the other notes only inform.
struct Messages {
  std::vector<std::string> notes;     ///< all, warnings included
  std::vector<std::string> warnings;  ///< those of `notes` that are warnings

  void warn(std::string text) {
    notes.push_back(text);
    warnings.push_back(std::move(text));
  }
  void append(const Messages& other) {
    notes.insert(notes.end(), other.notes.begin(), other.notes.end());
    warnings.insert(warnings.end(), other.warnings.begin(), other.warnings.end());
  }
};

}  // namespace fovea
