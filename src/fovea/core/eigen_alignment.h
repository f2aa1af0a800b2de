// Checks that Eigen aligns and allocates as in Fovea's archives. All headers with Eigen's types
// include this file. Otherwise a program with other machine flags could corrupt its heap.
#pragma once

#include <Eigen/Core>

static_assert(
    EIGEN_MAX_ALIGN_BYTES == 32 && EIGEN_MAX_STATIC_ALIGN_BYTES == 32,
    "Fovea needs Eigen's alignment of 32 bytes in the whole program: link fovea::fovea in "
    "CMake, or compile all files with -DEIGEN_MAX_ALIGN_BYTES=32 "
    "-DEIGEN_MAX_STATIC_ALIGN_BYTES=32");
