#!/usr/bin/env bash
# Sets up, builds and runs the tests.
#   ./test.sh [--no-install]             the test suite, with the checks of style and layers
#   ./test.sh --sanitize [address|thread] [--no-install]
#                                        the library's tests under the address + undefined behavior
#                                        sanitizers, and the tests of the modules with threads under
#                                        the thread sanitizer (or one of them)
#   ./test.sh --fuzz [SECONDS] [--no-install]
#                                        the fuzzers of the readers (fuzz/), each for so long (600)
#   ./test.sh --interop [--no-install]   our files against other programs, from PyPI (docs/interoperability.md)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

install_flag=
sanitizers=()
sanitize=false
fuzz=false
interop=false
fuzz_seconds=600
for argument in "$@"; do
  case $argument in
    --no-install) install_flag=--no-install ;;
    --sanitize) sanitize=true ;;
    address | thread) sanitizers+=("$argument") ;;
    --fuzz) fuzz=true ;;
    --interop) interop=true ;;
    -h | --help)
      sed -n '2,10s/^# //p' "$0"
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
scripts/setup.sh $install_flag build product viewer python tests

run_tests() { # FOLDER OF build/ [CTEST OPTION...]
  local folder=$1
  shift
  ctest --test-dir "build/$folder" --output-on-failure -j "$(nproc)" "$@"
}

if $fuzz; then
  scripts/build.sh fuzz
  FOVEA_FUZZ_SECONDS=$fuzz_seconds run_tests asan -L '^fuzz$'
  exit 0
fi

if $interop; then
  folder=${FOVEA_INTEROP_FOLDER:-build/interop}
  code=0
  tests/interop/environment.sh "$folder" || code=$?
  [[ $code -ne 77 ]] || exit 0 # skipped
  [[ $code -eq 0 ]] || exit "$code"
  scripts/build.sh release
  tests/interop/run.sh "$folder" build/release
  exit 0
fi

if ! $sanitize; then
  scripts/check_layers.sh
  scripts/check_format.sh
  scripts/check_sizes.sh
  scripts/check_types.sh
  scripts/build.sh release
  run_tests release
  exit 0
fi

[[ ${#sanitizers[@]} -gt 0 ]] || sanitizers=(address thread)
# Under a sanitizer each of these takes over half a minute, most on figures. The release runs them, too.
long_tests='^(RegistrationKitti\.AitkenAcceleration|LocalMap\.SparseRingsInAnOpenPlace|RecordingPause\..*Without'
long_tests+='|TrackingLoss\.|InitialVelocity\.|MapDriveResume\.ADriveThatBeginsAtSpeed|Warnings\.|LidarMount\.ADriveOf'
long_tests+='|Evaluate\.(Blocks|TheReport|AGoodMapOfTheWallHas|TellsIts)|MeshWriters\.(TheSame|Larger|PointsOf)'
long_tests+='|PaperMapper\.Registration|RollingShutter\.EachRow|KittiEvaluate\.|ExtrinsicEstimate\.|Calibrate(Command)?\.'
long_tests+='|CalibrationCheck\.TheRemedy)|^(Localize|EvaluateTruth)$'
export ASAN_OPTIONS=detect_leaks=1:strict_string_checks=1
export UBSAN_OPTIONS=print_stacktrace=1
for sanitizer in "${sanitizers[@]}"; do
  if [[ $sanitizer == address ]]; then
    scripts/build.sh asan
    run_tests asan -LE '^fuzz$' -E "$long_tests"
  else
    scripts/build.sh tsan thread_tests
    run_tests tsan -L threads -E "$long_tests"
  fi
done
