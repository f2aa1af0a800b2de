# How everything is compiled: standard, warnings, target machine, sanitizers, ccache.
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
# One flag for libraries and programs alike, so that both share one precompiled header. Without
# semantic interposition the compiler may inline what a shared library could otherwise replace.
add_compile_options(-fPIC -fno-semantic-interposition)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Products are added up in one instruction wherever that can be, as GCC does.
  add_compile_options(-ffp-contract=fast)
endif()
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()

add_library(fovea_compile_options INTERFACE)
target_compile_options(fovea_compile_options INTERFACE -Wall -Wextra -Wpedantic -Wshadow
                       -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor -Woverloaded-virtual)
if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
  # Conditions that are joined without a branch, as nobody could foresee it, are no mistake.
  target_compile_options(fovea_compile_options INTERFACE -Wno-bitwise-instead-of-logical)
endif()
if(FOVEA_WARNINGS_AS_ERRORS)
  target_compile_options(fovea_compile_options INTERFACE -Werror)
endif()
if(FOVEA_SANITIZE)
  add_compile_options(-fsanitize=${FOVEA_SANITIZE} -fno-omit-frame-pointer
                      -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${FOVEA_SANITIZE})
  if(FOVEA_SANITIZE MATCHES thread)
    # Clang defines no macro for it. Code that the thread sanitizer misreads tests this one.
    add_compile_definitions(FOVEA_THREAD_SANITIZER)
  endif()
  if(FOVEA_SANITIZE MATCHES undefined AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # Half of the compilation, for what address sanitizer (null) and the processor (aligned vectors) stop
    # at by themselves. The fuzzers, whose readers point into bytes from outside, have both (clang).
    add_compile_options(-fno-sanitize=null,alignment)
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

if(FOVEA_X86_64_V3 AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  set(FOVEA_MACHINE_OPTIONS -march=x86-64-v3)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "Clang")
    # Instructions in an order that suits these processors; they run on any other x86-64-v3 as well.
    set(FOVEA_TUNE znver3 CACHE STRING "Processor whose speed clang compiles for (-mtune)")
    list(APPEND FOVEA_MACHINE_OPTIONS -mtune=${FOVEA_TUNE})
  endif()
endif()
