// Point clouds in PCD, the Point Cloud Library's format (version 0.7).
#pragma once

#include "fovea/core/point_formats/cloud_rows.h"

namespace fovea {

/// Reads a PCD file (ascii, binary or binary_compressed): x y z of type F and those further fields
/// of COUNT 1 that are wanted; others are passed over. A colour packed into a field rgb or rgba (of
/// four bytes, as type U or I or as a float of these bits; in a text also a whole number) is handed
/// on as the whole number 0xAARRGGBB.
///
/// VIEWPOINT says where the sensor stood and moves no point, as in the library itself. InputError
/// that names line or offset for anything else.
void read_pcd_rows(InputFile& file, CloudRows& rows);

}  // namespace fovea
