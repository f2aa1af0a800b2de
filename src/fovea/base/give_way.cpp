#include "fovea/base/give_way.h"

#include <sys/resource.h>
#include <unistd.h>

namespace fovea {

void give_way(int nice) {
  static_cast<void>(setpriority(PRIO_PROCESS, static_cast<id_t>(gettid()), nice));
}

}  // namespace fovea
