#!/usr/bin/env bash
# Runs one fuzzer: fuzz/run.sh NAME PROGRAM [FUZZER OPTION...]
# It begins with the inputs of fuzz/corpus/NAME and those that earlier runs found (build/fuzz/corpus), and
# goes on for FOVEA_FUZZ_SECONDS (600). What breaks a reader is kept in build/fuzz/findings.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
name=$1 program=$2
shift 2
found=build/fuzz/corpus/$name findings=build/fuzz/findings
mkdir -p "$found" "$findings"

# Files of readers that need a name: in memory where the system has such a place.
shared_memory=/dev/shm
[[ -w $shared_memory ]] || shared_memory=${TMPDIR:-/tmp}
TMPDIR=$(mktemp -d -p "$shared_memory" fovea_fuzz_XXXXXX)
export TMPDIR
trap 'rm -rf "$TMPDIR"' EXIT

options=(-max_total_time="${FOVEA_FUZZ_SECONDS:-600}" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024
  -print_final_stats=1 -artifact_prefix="$findings/$name-")
[[ ! -e fuzz/dictionaries/$name.dict ]] || options+=(-dict="fuzz/dictionaries/$name.dict")
if ! "$program" "${options[@]}" "$@" "$found" "fuzz/corpus/$name"; then
  echo "fuzz: $name has a finding, its input is kept as $findings/$name-*; see CONTRIBUTING.md" >&2
  exit 1
fi
