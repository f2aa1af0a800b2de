#!/usr/bin/env bash
# GCC compiles the library without machine flags, and each header without other headers before it: the
# source file of the same name includes it first; headers without one are compiled here.
# A header with Eigen's types must check their alignment.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

headers() { git ls-files 'include/fovea/*.h' 'src/fovea/*.h' | grep -v test_; }

checked=include/fovea/platform.h
while true; do # the headers that include one of those found before
  more=$( (echo "$checked" && headers | xargs grep -lF -f <(sed -E 's,^(src|include)/(.*),#include "\2",' <<<"$checked")) | sort -u)
  [[ $more != "$checked" ]] || break
  checked=$more
done
if headers | xargs grep -l '#include <Eigen' | sort | comm -23 - <(echo "$checked") | grep .; then
  echo "these headers include Eigen: they need fovea/platform.h, directly or through another header" >&2
  exit 1
fi

included_as() { sed -E 's,^(src|include)/,,' <<<"$1"; }
scripts/build.sh gcc
check_header() { # HEADER
  g++ -std=c++20 -fsyntax-only -Wall -Wextra -Wno-psabi -Iinclude -Isrc -isystem /usr/include/eigen3 \
    -DEIGEN_MAX_ALIGN_BYTES=32 -DEIGEN_MAX_STATIC_ALIGN_BYTES=32 -x c++ - <<<"#include \"$(included_as "$1")\""
}
export -f check_header included_as
headers | while read -r header; do
  source=${header%.h}.cpp
  [[ -e $source && $(grep -m1 '^#include' "$source") == "#include \"$(included_as "$header")\"" ]] || echo "$header"
done | xargs -P "$(nproc)" -n 1 bash -c 'check_header "$1"' check_header
