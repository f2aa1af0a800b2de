// What all public headers need: visible symbols, Eigen's alignment, and the version.
#pragma once

#if __cplusplus < 202002L
#error "Fovea needs C++20: compile with -std=c++20"
#endif

#include <Eigen/Core>

/// A class or function of the shared library.
#define FOVEA_API __attribute__((visibility("default")))

// The library and its programs must align and allocate Eigen's objects alike. Otherwise a program
// with other machine flags could corrupt its heap.
static_assert(
    EIGEN_MAX_ALIGN_BYTES == 32 && EIGEN_MAX_STATIC_ALIGN_BYTES == 32,
    "Fovea needs Eigen's alignment of 32 bytes in the whole program: link fovea::fovea in "
    "CMake, or compile all files with -DEIGEN_MAX_ALIGN_BYTES=32 "
    "-DEIGEN_MAX_STATIC_ALIGN_BYTES=32");

namespace fovea {

/// Version of the library and program, "MAJOR.MINOR.PATCH".
FOVEA_API const char* version();

}  // namespace fovea
