#!/usr/bin/env bash
# Where PyPI cannot be reached, `./test.sh --interop` prints one short notice and succeeds.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
unset PIP_FIND_LINKS
export PIP_INDEX_URL=http://127.0.0.1:9/simple PIP_CONFIG_FILE=/dev/null FOVEA_INTEROP_FOLDER=$folder
./test.sh --interop --no-install >"$folder/output.txt" 2>&1 || {
  echo "it fails:"
  cat "$folder/output.txt"
  exit 1
}
grep -qx 'interop: skipped, .*' "$folder/output.txt" && [[ $(wc -l <"$folder/output.txt") -eq 1 ]] || {
  echo "it prints more, or something else:"
  cat "$folder/output.txt"
  exit 1
}
