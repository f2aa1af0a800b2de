// Errors as a line of the form WHAT, WHERE, WHAT TO DO, also those that are not Fovea's own.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace fovea::app {

/// @param command  subcommand that ran, for the remedy
std::string error_line(const std::exception& error, std::string_view command);

/// Whether the machine is the cause, not the inputs: a full disk, too little memory.
bool is_of_machine(const std::exception& error);

}  // namespace fovea::app
