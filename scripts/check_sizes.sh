#!/usr/bin/env bash
# Fails if a file of mapping/ or pipeline/ has over 300 lines, or a function over 60: scripts/check_sizes.sh [FILE...]
# A function ends with a line of only "}", and begins at the last line before it with the same indentation.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
files=("$@")
[[ ${#files[@]} -gt 0 ]] || mapfile -t files < <(git ls-files 'src/fovea/mapping/*.[hc]*' 'src/fovea/pipeline/*.[hc]*')
awk -v max_file=300 -v max_function=60 '
  function report(text) { print FILENAME ":" text; failed = 1 }
  FNR == 1 { split("", start) }
  FNR == max_file + 1 { report(FNR ": the file has over " max_file " lines") }
  /^ *[^ #]/ {
    match($0, /^ */)
    if ($0 ~ /^ *}$/) {
      length_ = FNR - start[RLENGTH] + 1
      if (length_ > max_function) report(start[RLENGTH] ": the function has " length_ " lines, over " max_function)
    } else if ($0 !~ /^ *}/) {
      start[RLENGTH] = FNR
    }
  }
  END { exit failed }
' "${files[@]}" >&2
