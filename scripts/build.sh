#!/usr/bin/env bash
# Configures and builds one build preset of CMakePresets.json: scripts/build.sh PRESET [TARGET...]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
preset=$1
shift
configure=$preset
[[ $preset != fuzz ]] || configure=asan # one build has both
log=$(mktemp)
trap 'rm -f "$log"' EXIT
run_cmake() {
  if ! cmake --preset "$configure" >"$log" 2>&1; then
    cat "$log" >&2
    exit 1
  fi
}
run_cmake
# With another compiler than before, CMake drops the preset's other variables.
if grep -q 'have changed variables that require your cache to be deleted' "$log"; then run_cmake; fi
cmake --build --preset "$preset" ${1:+--target "$@"}
