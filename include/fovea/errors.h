// Typed errors of the library. Each is one line: what is wrong, where, and what to do.
#pragma once

#include <stdexcept>
#include <string>
#include <string_view>

#include "fovea/platform.h"

namespace fovea {

/// Base of the errors of data, settings and files. A wrong argument of a function is
/// std::invalid_argument. `what()` reads "WHAT, WHERE, WHAT TO DO".
class FOVEA_API Error : public std::runtime_error {
 public:
  /// @param what    what is wrong ("matrix has 11 numbers, expected 12")
  /// @param where   file, frame, line or offset ("calib_cam_to_cam.txt:12")
  /// @param remedy  what the user can do ("restore the file from the KITTI archive")
  Error(std::string_view what, std::string_view where, std::string_view remedy);

  const std::string& problem() const { return problem_; }
  const std::string& where() const { return where_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string problem_, where_, remedy_;
};

/// A file or folder that was read is missing, damaged or not of the expected form.
class FOVEA_API InputError : public Error {
 public:
  using Error::Error;
};

/// An option or configuration key is unknown, of the wrong type or out of range.
class FOVEA_API ConfigError : public Error {
 public:
  using Error::Error;
};

/// An output cannot be written: it exists, its folder does not, or the disk is full.
class FOVEA_API OutputError : public Error {
 public:
  using Error::Error;
};

}  // namespace fovea
