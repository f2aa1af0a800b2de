#include "fovea/core/machine_error.h"

#include <cerrno>

namespace fovea {

bool is_machine_error(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EFBIG:  // a limit of the process (ulimit -f), or of the file system
    case EIO:
    case EROFS:
    case ESTALE:  // of a shared folder
    case ENOMEM:
    case EMFILE:
    case ENFILE:
      return true;
    default:
      return false;
  }
}

}  // namespace fovea
