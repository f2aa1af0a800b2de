#!/usr/bin/env bash
# Sets up, builds and runs the tests.
#   ./test.sh [--no-install]             the test suite, with the checks of style and layers
#   ./test.sh --sanitize [address|thread] [--no-install]
#                                        the unit tests under address + undefined behaviour and under
#                                        thread sanitizers (or one of them)
#   ./test.sh --fuzz [SECONDS] [--no-install]
#                                        the fuzzers of the readers (fuzz/), each for so long (600)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

install_flag=
sanitizers=()
sanitize=false
fuzz=false
fuzz_seconds=600
for argument in "$@"; do
  case $argument in
    --no-install) install_flag=--no-install ;;
    --sanitize) sanitize=true ;;
    address | thread) sanitizers+=("$argument") ;;
    --fuzz) fuzz=true ;;
    -h | --help)
      sed -n '2,8s/^# //p' "$0"
      exit 0
      ;;
    *)
      if ! $fuzz || [[ ! $argument =~ ^[1-9][0-9]*$ ]]; then
        echo "test: unknown option $argument, see ./test.sh --help" >&2
        exit 2
      fi
      fuzz_seconds=$argument
      ;;
  esac
done
scripts/setup.sh --tests $install_flag

run_tests() { # PRESET [CTEST OPTION...]
  local preset=$1
  shift
  ctest --test-dir "build/$preset" --output-on-failure -j "$(nproc)" "$@"
}

if $fuzz; then
  scripts/build.sh fuzz fuzzers
  FOVEA_FUZZ_SECONDS=$fuzz_seconds run_tests fuzz
  exit 0
fi

if ! $sanitize; then
  scripts/check_layers.sh
  scripts/check_format.sh
  scripts/check_sizes.sh
  scripts/build.sh release
  run_tests release
  exit 0
fi

[[ ${#sanitizers[@]} -gt 0 ]] || sanitizers=(address thread)
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
for sanitizer in "${sanitizers[@]}"; do
  preset=$([[ $sanitizer == address ]] && echo asan || echo tsan)
  scripts/build.sh "$preset"
  run_tests "$preset"
done
