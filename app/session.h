// What a run of the program has once.
#pragma once

#include "app/interrupt.h"
#include "app/warnings.h"

namespace fovea::app {

struct Session {
  InterruptGuard interrupt;
  Warnings warnings;
};

}  // namespace fovea::app
