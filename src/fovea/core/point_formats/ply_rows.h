// Point clouds in PLY.
#pragma once

#include "fovea/core/point_formats/cloud_rows.h"

namespace fovea {

/// Reads the vertices of a PLY file (binary little endian or ascii): x y z of type float or double
/// and those further properties that are wanted; others, and elements after the vertices, are
/// passed over. InputError that names the line for anything else.
void read_ply_rows(InputFile& file, CloudRows& rows);

}  // namespace fovea
