// A check of numbers on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <cmath>
#include <string>

namespace fovea::app {

/// CLI::Range of real numbers, without the NaN that it lets pass.
inline CLI::Validator finite_range(double low, double high) {
  const CLI::Validator finite(
      [](const std::string& text) {
        double value = 0;
        const bool is_finite = CLI::detail::lexical_cast(text, value) && std::isfinite(value);
        return is_finite ? std::string() : std::string("not a finite number");
      },
      "");
  return CLI::Range(low, high) & finite;
}

}  // namespace fovea::app
