#!/usr/bin/env bash
# Simulates 16 drives through one town, 2.5 km together. Their routes cross and repeat, and each drive has its own day:
#   scripts/town.sh OUT_DIR [FOVEA [NUMBER...]]
# FOVEA is the program. The numbers choose drives. The drives are OUT_DIR/drive_01 to OUT_DIR/drive_16; the script does
# not simulate a drive that is there already.
set -euo pipefail
out=$1 fovea=${2:-"$(dirname "${BASH_SOURCE[0]}")/../build/release/fovea"}
chosen=("${@:3}")
[[ ${#chosen[@]} -gt 0 ]] || mapfile -t chosen < <(seq 16)
frames=170
camera=(camera.numbers=[2] camera.width=414 camera.height=125 camera.focal=240.5 camera.cx=203.2 camera.cy=57.6)
# Azimuth and elevation of the sun, begin on the route, traffic, route.
drives=(
  "95 22 0 false 1,1 3,1 3,3 1,3 1,1"
  "110 31 100 false 1,1 3,1 3,3 1,3 1,1"
  "125 39 0 true 1,1 1,3 3,3 3,1 1,1"
  "140 46 0 false 0,2 4,2"
  "155 51 60 false 4,2 0,2"
  "170 54 0 true 2,0 2,4"
  "185 55 0 false 2,4 2,0"
  "200 53 0 false 0,1 2,1 2,3 4,3"
  "215 49 80 true 4,3 2,3 2,1 0,1"
  "230 43 0 false 1,1 2,1 2,2 1,2 1,1"
  "245 35 40 false 2,2 2,3 3,3 3,2 2,2"
  "260 27 0 true 0,0 2,0 2,2 4,2"
  "100 40 0 false 1,0 1,4"
  "150 28 0 false 3,4 3,0"
  "205 36 70 true 0,3 3,3 3,0"
  "250 18 150 false 1,1 3,1 3,3 1,3 1,1"
)
mkdir -p "$out"
for number in "${chosen[@]}"; do
  read -r azimuth elevation begin traffic route <<<"${drives[number - 1]}"
  drive=$(printf '%s/drive_%02d' "$out" "$number")
  [[ -d $drive ]] && continue
  settings=()
  for key in "${camera[@]}" light.sun_azimuth="$azimuth" light.sun_elevation="$elevation" drive.pass="$number" \
    "town.route=$route" town.begin="$begin" town.traffic="$traffic"; do settings+=(--set "$key"); done
  "$fovea" simulate -o "$drive" --scene town --format generic --frames "$frames" --quiet "${settings[@]}"
done
