// What a run of the program has once.
#pragma once

#include "app/interrupt.h"

namespace fovea::app {

struct Session {
  InterruptGuard interrupt;
};

}  // namespace fovea::app
