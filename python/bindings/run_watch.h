// A Python program that looks on while C++ works.
#pragma once

#include <pybind11/pybind11.h>

#include <exception>
#include <functional>
#include <stop_token>
#include <string>

namespace fovea::python {

/// KeyboardInterrupt where Ctrl-C was pressed: Python itself does not run meanwhile. Needs the GIL.
void raise_signals();

/// Runs Python between two steps of a run that has let go of the GIL. The first exception there, or
/// Ctrl-C, stops the run as Ctrl-C stops the program; Python is not called again.
class RunWatch {
 public:
  std::stop_token token() const { return stop_.get_token(); }
  void call(const std::function<void()>& python);
  bool has_raised() const { return raised_ != nullptr; }
  /// Raises what was raised, if anything was. Needs the GIL.
  /// @param error  with what the run ended then, or empty: a note to the exception
  void rethrow(const std::string& error) const;

 private:
  std::stop_source stop_;
  std::exception_ptr raised_;
};

}  // namespace fovea::python
