#!/usr/bin/env bash
# A whole drive under the thread sanitizer: threads.sh PROGRAM WORK_DIR. A report of the sanitizer makes a
# command fail. Embree builds its trees with TBB, which the sanitizer misreads, so one thread simulates.
set -euo pipefail
fovea=$1 work=$2
rm -rf "$work"
mkdir -p "$work"
"$fovea" simulate -o "$work/drive" --frames 6 --threads 1 --quiet --set lidar.columns=400 --set "camera.numbers=[2]"
"$fovea" map "$work/drive" -o "$work/map.fovea" --threads 4 --quiet
"$fovea" info "$work/map.fovea"
