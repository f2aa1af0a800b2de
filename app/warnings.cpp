#include "app/warnings.h"

#include <fmt/format.h>

#include <cstdio>
#include <set>

#include "app/print.h"

namespace fovea::app {

void Warnings::add(const std::vector<std::string>& texts, bool quiet) {
  count_ += texts.size();
  if (quiet && !strict) return;
  std::fflush(stdout);  // the terminal shows lines in the order of printing
  for (const std::string& text : texts) print_err("warning: {}\n", text);
}

void Warnings::add(const Messages& messages, std::string_view note_prefix, bool quiet) {
  const std::set<std::string_view> warnings(messages.warnings.begin(), messages.warnings.end());
  for (const std::string& note : messages.notes) {
    if (!quiet && !warnings.contains(note)) print_out("{}{}\n", note_prefix, note);
  }
  add(messages.warnings, quiet);
}

std::string Warnings::error() const {
  if (!strict || count_ == 0) return {};
  return fmt::format("{} warning{} with --strict, see above, remove the cause or --strict", count_,
                     count_ == 1 ? "" : "s");
}

}  // namespace fovea::app
