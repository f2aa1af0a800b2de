// Checks that lens parameters can be those of a camera with images of the stated size.
#pragma once

#include <optional>
#include <string>

#include "fovea/camera.h"
#include "fovea/geometry/lens.h"

namespace fovea {

struct LensProblem {
  const char* key;     ///< "K" or "D"
  std::string what;    ///< the problem with its value
  const char* remedy;  ///< with the likely cause
};

/// Checks field of view, pixel aspect and principal point, then the distortion: half of the image
/// must have rays, at angles near those of the pinhole model. The limits are wide: a real lens that
/// is calibrated badly passes.
std::optional<LensProblem> lens_problem(const LensCamera& camera);
std::optional<LensProblem> lens_problem(const Camera& camera);

}  // namespace fovea
