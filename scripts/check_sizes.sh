#!/usr/bin/env bash
# Fails if a file of the product has over 300 lines, or a function of mapping/ or pipeline/ over 60:
#   scripts/check_sizes.sh [FILE...]
# A longer file gives its reason in one of its first ten lines: "// Over 300 lines: REASON".
# A function ends with a line of only "}", and begins at the last line before it with the same indentation.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
files=("$@")
[[ ${#files[@]} -gt 0 ]] || mapfile -t files < <(git ls-files {include,src,app,tools,python}/'*'{.h,.cpp,.py} | grep -v '_test\.cpp$')
awk -v max_file=300 -v max_function=60 -v all_functions=$# '
  function report(text) { print FILENAME ":" text; failed = 1 }
  FNR == 1 { split("", start); has_reason = 0 }
  FNR <= 10 && /^\/\/ Over 300 lines: / { has_reason = 1 }
  FNR == max_file + 1 && !has_reason {
    report(FNR ": the file has over " max_file " lines")
  }
  /^ *[^ #]/ && (all_functions || FILENAME ~ /src\/fovea\/(mapping|pipeline)\//) {
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
