#!/usr/bin/env bash
# GCC compiles the library, without machine flags, and each installed header by itself. A header with
# Eigen's types must check their alignment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
scripts/build.sh gcc

scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
export scratch
check_header() { # HEADER
  local dependencies=$scratch/${1//\//_}.d
  g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wno-psabi -Isrc -isystem /usr/include/eigen3 -DEIGEN_MAX_ALIGN_BYTES=32 \
    -DEIGEN_MAX_STATIC_ALIGN_BYTES=32 -MD -MF "$dependencies" -x c++ - <<<"#include \"${1#src/}\"" || return 1
  if grep -q 'Eigen/src/Core/util/Memory.h' "$dependencies" && ! grep -q 'eigen_alignment.h' "$dependencies"; then
    echo "$1: includes Eigen without eigen_alignment.h" >&2
    return 1
  fi
}
export -f check_header
git ls-files 'src/fovea/*.h' | grep -v test_ | xargs -P "$(nproc)" -n 1 bash -c 'check_header "$1" || exit 1' check_header
