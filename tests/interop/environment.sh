#!/usr/bin/env bash
# Makes a virtual environment with the packages of requirements.txt: environment.sh FOLDER
# Exit code 77, with one line: the environment is not there, and PyPI cannot be reached.
# The packages stay in FOLDER. A second call with the same requirements needs no network.
set -euo pipefail
folder=$1
requirements=$(dirname "${BASH_SOURCE[0]}")/requirements.txt
python=/usr/bin/python3 # that of the module
log=$folder/pip.log

skip() { # REASON
  echo "interop: skipped, $1"
  exit 77
}

pypi_is_reachable() {
  timeout 20 "$folder/venv/bin/pip" download --quiet --no-deps --no-cache-dir --retries 0 --timeout 5 \
    --dest "$folder/probe" "$(grep -o -m 1 '^laspy==[0-9.]*' "$requirements")" >"$log" 2>&1
}

if cmp --silent "$requirements" "$folder/installed.txt"; then exit 0; fi
rm -rf "$folder/venv" "$folder/probe" "$folder/installed.txt"
mkdir -p "$folder"
"$python" -m venv "$folder/venv" >"$log" 2>&1 || skip "there is no python3-venv"
pypi_is_reachable || skip "PyPI cannot be reached"
echo "interop: installing the packages of tests/interop/requirements.txt"
if ! timeout 900 "$folder/venv/bin/pip" install --quiet --only-binary :all: --no-deps --retries 2 --timeout 30 \
  --cache-dir "$folder/cache" --requirement "$requirements" >"$folder/install.log" 2>&1; then
  pypi_is_reachable || skip "PyPI cannot be reached"
  tail -n 20 "$folder/install.log" >&2
  echo "interop: pip cannot install the packages, see above" >&2
  exit 1
fi
cp "$requirements" "$folder/installed.txt"
