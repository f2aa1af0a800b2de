#!/usr/bin/env bash
# Checks that each type of namespace fovea has one definition. If two headers define types of the same name, the
# compiler says nothing, the linker keeps the functions of one, and the program writes past the other.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

types_of_headers() { # PATTERN...: each as NAME FILE, for the types at the outermost level of a namespace
  git ls-files "$@" |
    xargs awk '
      /^ *template/ { next }
      { sub(/FOVEA_API /, "") }
      match($0, /^(struct|class|enum|enum class) [A-Za-z_0-9]+ [^;]*\{/) {
        sub(/^(enum class|struct|class|enum) /, "")
        match($0, /^[A-Za-z_0-9]+/)
        print substr($0, 1, RLENGTH), FILENAME
      }'
}

failed=0
check() { # PATTERN... of the headers of a namespace
  local name
  while read -r name; do
    echo "$name is defined in several headers: $(types_of_headers "$@" | sed -n "s/^$name //p" | tr '\n' ' ')" >&2
    failed=1
  done < <(types_of_headers "$@" | cut -d' ' -f1 | sort | uniq -d)
}
check 'include/fovea/*.h' 'src/fovea/*.h' 'app/*.h'
check 'python/*.h'
exit $failed
