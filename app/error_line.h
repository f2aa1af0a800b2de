// Errors that are not Fovea's own, as a line of the same form: WHAT, WHERE, WHAT TO DO.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace fovea::app {

/// @param command  subcommand that ran, for the remedy
std::string error_line(const std::exception& error, std::string_view command);

}  // namespace fovea::app
