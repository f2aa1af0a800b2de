#!/usr/bin/env bash
# Builds the reference of the C++ API as web pages, by Doxygen; a warning is an error:
#   scripts/build_reference.sh FOLDER
set -euo pipefail
output=$(realpath -m "${1:?give the folder for the pages}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
mkdir -p "$output"
FOVEA_REFERENCE=$output doxygen docs/Doxyfile
