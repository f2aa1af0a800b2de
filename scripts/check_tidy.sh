#!/usr/bin/env bash
# clang-tidy over the sources:
#   scripts/check_tidy.sh                             the whole tree
#   scripts/check_tidy.sh FILE...
#   scripts/check_tidy.sh --since REF [--at-most N]   the files that differ from REF; of more than N files
#                                                     a sample, another one for each commit, whose
#                                                     findings are listed and are no failure
# For a header, clang-tidy reads the source file of the same name, or one that includes the header.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

since='' at_most='' files=() failures='*'
while [[ $# -gt 0 ]]; do
  case $1 in
    --since) since=$2 && shift 2 ;;
    --at-most) at_most=$2 && shift 2 ;;
    -*)
      echo "check_tidy: unknown option $1, see scripts/check_tidy.sh" >&2
      exit 2
      ;;
    *) files+=("$1") && shift ;;
  esac
done

product_sources() { git ls-files 'src/*.cpp' 'app/*.cpp' 'tools/*.cpp' 'python/*.cpp' | grep -v '_test\.cpp$'; }

source_of_header() { # HEADER
  local source=${1%.h}.cpp included=${1#src/}
  included=${included#include/}
  if [[ ! -e $source ]]; then
    source=$(product_sources | xargs grep -lF "#include \"$included\"" | head -n 1 || true)
  fi
  [[ -z $source ]] || echo "$source"
}

changed_sources() { # REF
  git diff --name-only --diff-filter=d "$1" -- include src app tools python | while read -r file; do
    case $file in
      *_test.cpp | *test_*.h) ;;
      *.cpp) echo "$file" ;;
      *.h) source_of_header "$file" ;;
    esac
  done | sort -u
}

if [[ -n $since ]]; then
  mapfile -t files < <(changed_sources "$since")
  echo "check_tidy: ${#files[@]} source files differ from $since"
  if [[ -n $at_most && ${#files[@]} -gt $at_most ]]; then
    mapfile -t files < <(printf '%s\n' "${files[@]}" | shuf -n "$at_most" --random-source=<(yes "$(git rev-parse HEAD)"))
    failures='-*'
    echo "check_tidy: lists the findings of a sample of $at_most; all of them: scripts/check_tidy.sh --since $since"
  fi
  [[ ${#files[@]} -gt 0 ]] || exit 0
elif [[ ${#files[@]} -eq 0 ]]; then
  mapfile -t files < <(product_sources)
fi
scripts/build.sh tidy >/dev/null
printf '%s\0' "${files[@]}" |
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-19 -p build/tidy --quiet --warnings-as-errors="$failures"
