#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <map>
#include <string>
#include <vector>

#include "fovea/errors.h"

namespace fovea {

/// The one topic of a kind of message: `wanted`, which its option named, or, if that is empty, the
/// only one there is; empty if there is none. InputError if there is no such topic, or more than
/// one to choose from.
template <class Messages>
std::string only_topic(const std::map<std::string, Messages>& topics, const std::string& wanted,
                       const char* kind, const char* option) {
  if (!wanted.empty()) {
    if (topics.contains(wanted)) return wanted;
    throw InputError(fmt::format("no {} of this topic can be read", kind), wanted,
                     "choose one that 'fovea convert --list' prints");
  }
  if (topics.size() > 1) {
    std::vector<std::string> names;
    for (const auto& [name, messages] : topics) names.push_back(name);
    throw InputError(fmt::format("there are {} topics of {}", topics.size(), kind),
                     fmt::format("{}", fmt::join(names, ", ")),
                     fmt::format("choose by {} TOPIC", option));
  }
  return topics.empty() ? std::string() : topics.begin()->first;
}

}  // namespace fovea
