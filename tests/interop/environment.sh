#!/usr/bin/env bash
# Makes a virtual environment with the packages of requirements.txt: environment.sh FOLDER
# Exit code 77, with one line: the environment is not there, and PyPI cannot be reached.
# FOLDER/numpy_2 has NumPy 2, which only test_numpy.py uses. The packages stay in FOLDER: a second call with the same
# requirements needs no network.
set -euo pipefail
folder=$1
requirements=$(dirname "${BASH_SOURCE[0]}")/requirements.txt
python=/usr/bin/python3 # that of the module
numpy_2=numpy==2.4.6

skip() { # REASON
  echo "interop: skipped, $1"
  exit 77
}

pip() { # ARGUMENT...
  timeout 900 "$folder/venv/bin/pip" "$@" >"$folder/pip.log" 2>&1
}

pypi_is_reachable() {
  timeout 20 "$folder/venv/bin/pip" download --quiet --no-deps --retries 0 --timeout 5 --dest "$folder/wheels" \
    "$(grep -o -m 1 '^laspy==[0-9.]*' "$requirements")" >"$folder/probe.log" 2>&1
}

download() {
  echo "interop: downloading the packages of tests/interop/requirements.txt"
  pip download --only-binary :all: --no-deps --retries 2 --timeout 30 --dest "$folder/wheels" --requirement "$requirements" &&
    pip download --only-binary :all: --no-deps --retries 2 --timeout 30 --dest "$folder/wheels" "$numpy_2"
}

install() {
  pip install --no-index --find-links "$folder/wheels" --no-deps --requirement "$requirements" &&
    pip install --no-index --find-links "$folder/wheels" --no-deps --upgrade --target "$folder/numpy_2" "$numpy_2"
}

if cmp --silent "$requirements" "$folder/installed.txt"; then exit 0; fi
rm -rf "$folder/venv" "$folder/installed.txt"
mkdir -p "$folder/wheels"
"$python" -m venv "$folder/venv" >"$folder/pip.log" 2>&1 || skip "there is no python3-venv"
if ! install; then
  pypi_is_reachable || skip "PyPI cannot be reached"
  if ! download || ! install; then
    pypi_is_reachable || skip "PyPI cannot be reached"
    tail -n 20 "$folder/pip.log" >&2
    echo "interop: pip cannot install the packages, see above" >&2
    exit 1
  fi
fi
cp "$requirements" "$folder/installed.txt"
