#include "fovea/mapping/ground.h"
