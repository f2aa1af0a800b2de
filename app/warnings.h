// Warnings: something may be wrong with a result. A note only informs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fovea/core/messages.h"

namespace fovea::app {

/// Prints the warnings of a command on standard error and counts them for --strict.
class Warnings {
 public:
  /// Prints "warning: TEXT" for each of the texts.
  /// @param quiet  prints them only with --strict
  void add(const std::vector<std::string>& texts, bool quiet = false);
  /// As above, after the other notes on standard output.
  void add(const Messages& messages, std::string_view note_prefix, bool quiet);

  /// One line for the user if --strict makes the warnings errors; otherwise empty.
  std::string error() const;

  bool strict = false;  ///< --strict

 private:
  std::size_t count_ = 0;
};

}  // namespace fovea::app
