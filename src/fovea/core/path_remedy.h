// What helps if the operating system refuses a path.
#pragma once

#include <cerrno>
#include <string>

namespace fovea {

/// @param error      errno
/// @param otherwise  for all other errors
inline std::string path_remedy(int error, const char* otherwise) {
  if (error == ELOOP) return "correct the symbolic links, which form a loop";
  if (error == ENAMETOOLONG) return "give a shorter path";
  return otherwise;
}

}  // namespace fovea
