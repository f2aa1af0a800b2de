#!/usr/bin/env bash
# Runs the tests here: run.sh FOLDER_OF_THE_ENVIRONMENT BUILD_FOLDER
set -euo pipefail
environment=$(realpath "$1")
build=$(realpath "$2")
cd "$(dirname "${BASH_SOURCE[0]}")"
# evo and matplotlib write their settings to the home folder.
export HOME=$environment/home PYTHONDONTWRITEBYTECODE=1 MPLBACKEND=Agg
mkdir -p "$HOME"
export FOVEA_INTEROP_NUMPY_2=$environment/numpy_2
PYTHONPATH=$build/python FOVEA_PROGRAM=$build/fovea "$environment/venv/bin/python" run_tests.py
