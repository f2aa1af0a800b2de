#!/usr/bin/env bash
# Installs the build into a prefix of its own, then builds and runs a project that finds it there, by GCC
# and by the library's compiler, without machine flags: run.sh CMAKE CLANG BUILD_DIR WORK_DIR
set -euo pipefail
cmake=$1 clang=$2 build=$3 work=$4
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
rm -rf "$work"
"$cmake" --install "$build" --prefix "$work/prefix" >/dev/null
for compiler in g++ "$clang"; do
  project=$work/$(basename "$compiler")
  "$cmake" -S "$here" -B "$project" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER="$compiler" \
    -DCMAKE_EXPORT_COMPILE_COMMANDS=ON -DCMAKE_PREFIX_PATH="$work/prefix" >/dev/null
  "$cmake" --build "$project"
  if grep -E -- '-m(arch|tune|avx)' "$project/compile_commands.json"; then
    echo "the package forces machine flags on its users" >&2
    exit 1
  fi
  "$project/uses_fovea"
done
"$work/prefix/bin/fovea" --version

# Only the public headers, and each by itself.
[[ $(find "$work/prefix/include" -type f | wc -l) -le 26 ]]
alignment="-DEIGEN_MAX_ALIGN_BYTES=32 -DEIGEN_MAX_STATIC_ALIGN_BYTES=32"
for header in "$work"/prefix/include/fovea/*.h; do
  # shellcheck disable=SC2086
  g++ -std=c++20 -fsyntax-only -Wall -Wextra -Werror $alignment -I"$work/prefix/include" -isystem /usr/include/eigen3 \
    -x c++ - <<<"#include <fovea/$(basename "$header")>"
done

# pkg-config gives the same flags.
export PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig:$work/prefix/lib/x86_64-linux-gnu/pkgconfig
# shellcheck disable=SC2046
g++ -std=c++20 "$here/main.cpp" $(pkg-config --cflags --libs fovea) -Wl,-rpath,"$(pkg-config --variable=libdir fovea)" \
  -o "$work/by_pkg_config"
"$work/by_pkg_config"

# Without the package's definitions the headers name the remedy.
if errors=$(g++ -std=c++20 -fsyntax-only -I"$work/prefix/include" -I/usr/include/eigen3 "$here/main.cpp" 2>&1); then
  echo "the headers accept another alignment of Eigen's objects" >&2
  exit 1
fi
grep -q 'link fovea::fovea in CMake, or compile all files with -DEIGEN_MAX_ALIGN_BYTES=32' <<<"$errors"
