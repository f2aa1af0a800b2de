# How everything is compiled: standard, warnings, target machine, sanitizers, ccache.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# One flag for libraries and programs alike, so that both share one precompiled header. Without
# semantic interposition the compiler may inline what a shared library could otherwise replace.
add_compile_options(-fPIC -fno-semantic-interposition)
# Of the shared library only what the public headers mark with FOVEA_API is visible.
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Products are added up in one instruction wherever that can be, as GCC does.
  add_compile_options(-ffp-contract=fast)
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

# Two targets, as only our own code is compiled for the machine: fovea_warnings for all code,
# fovea_compile_options for all but the processor check and the libraries of other projects (bench/).
add_library(fovea_warnings INTERFACE)
target_compile_options(fovea_warnings INTERFACE -Wall -Wextra -Wpedantic -Wshadow -Wconversion
                       -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Conditions joined without a branch are intended.
  target_compile_options(fovea_warnings INTERFACE -Wno-bitwise-instead-of-logical)
endif()
if(FOVEA_WARNINGS_AS_ERRORS)
  target_compile_options(fovea_warnings INTERFACE -Werror)
endif()
add_library(fovea_compile_options INTERFACE)
target_link_libraries(fovea_compile_options INTERFACE fovea_warnings)
if(FOVEA_X86_64_V3 AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(FOVEA_FOR_X86_64_V3 TRUE)
  target_compile_options(fovea_compile_options INTERFACE -march=x86-64-v3)
else()
  # Vectors of eight floats are passed between our own files only.
  target_compile_options(fovea_compile_options INTERFACE -Wno-psabi)
endif()

# The library and the programs that link it must agree on the alignment and the allocation of Eigen's
# objects, whatever their machine flags. Eigen's own default depends on these flags. 32 is its value for
# x86-64-v3. A smaller value is not enough: with AVX, Eigen allocates for 32 bytes all the same.
set(FOVEA_EIGEN_ALIGNMENT EIGEN_MAX_ALIGN_BYTES=32 EIGEN_MAX_STATIC_ALIGN_BYTES=32)

if(FOVEA_SANITIZE)
  add_compile_options(-fsanitize=${FOVEA_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  if(FOVEA_SANITIZE MATCHES undefined)  # memory faults show without these, which double a build's time
    add_compile_options(-fno-sanitize=null,alignment,object-size,vptr)
  endif()
  add_link_options(-fsanitize=${FOVEA_SANITIZE})
  # Clang has no macros for sanitizers. Code that they misread tests these.
  add_compile_definitions(FOVEA_SANITIZER)
  if(FOVEA_SANITIZE MATCHES thread)
    add_compile_definitions(FOVEA_THREAD_SANITIZER)
  endif()
endif()

# ccache must be told that precompiled headers are safe to share.
find_program(FOVEA_CCACHE ccache)
if(FOVEA_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER env CCACHE_SLOPPINESS=pch_defines,time_macros,include_file_mtime
      ${FOVEA_CCACHE})
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    add_compile_options("SHELL:-Xclang -fno-pch-timestamp")
  else()
    add_compile_options(-fpch-preprocess)
  endif()
endif()
