#!/usr/bin/env bash
# check_sizes.sh accepts a function of 60 lines and a file of 300, and rejects one line more of each without a reason.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
check=$(dirname "${BASH_SOURCE[0]}")/check_sizes.sh
function_of() { # LINES
  printf 'int f(int a,\n      int b) {\n'
  for ((i = 3; i < $1; ++i)); do echo '  a += b;'; done
  echo '}'
}
lines() { for ((i = 0; i < $1; ++i)); do echo '// text'; done; }
expect() { # accepted|rejected FILE
  local result=accepted
  "$check" "$2" 2>/dev/null || result=rejected
  [[ $result == "$1" ]] || { echo "$2 is $result, expected $1" >&2; exit 1; }
}
function_of 60 >"$folder/function_60.cpp"
function_of 61 >"$folder/function_61.cpp"
(echo 'namespace a {'; function_of 30; function_of 30; echo '}  // namespace a') >"$folder/two_functions.cpp"
(echo 'class A {'; function_of 61 | sed 's/^/  /'; echo '};') >"$folder/member_61.cpp"
lines 300 >"$folder/file_300.h"
lines 301 >"$folder/file_301.h"
(echo '// Over 300 lines: one table.'; lines 300) >"$folder/reason.h"
expect accepted "$folder/function_60.cpp"
expect rejected "$folder/function_61.cpp"
expect accepted "$folder/two_functions.cpp"
expect rejected "$folder/member_61.cpp"
expect accepted "$folder/file_300.h"
expect rejected "$folder/file_301.h"
expect accepted "$folder/reason.h"
