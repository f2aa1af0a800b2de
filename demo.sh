#!/usr/bin/env bash
# Sets up, builds, maps a drive, scores the map and exports it.
#   ./demo.sh [--no-install] [DRIVE]     results under out/
# Without DRIVE it simulates one first, 60 frames of a street, and scores the map against the truth, too.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

install_flag=
drive=
for argument in "$@"; do
  case $argument in
    --no-install) install_flag=--no-install ;;
    -h | --help)
      sed -n '2,4s/^# //p' "$0"
      exit 0
      ;;
    -*)
      echo "demo: unknown option $argument, usage: ./demo.sh [--no-install] [DRIVE]" >&2
      exit 2
      ;;
    *) drive=$argument ;;
  esac
done

scripts/setup.sh $install_flag build product viewer
scripts/build.sh program
fovea=build/release/fovea
mkdir -p out

truth=
cameras=()
if [[ -z $drive ]]; then
  drive=out/street
  truth=yes
  cameras=(--cameras 2,3)
  rm -rf "$drive"
  echo "== simulating a street: 60 frames, two cameras"
  "$fovea" simulate -o "$drive" --frames 60
fi
name=$(basename "$(cd "$drive" && pwd)")
map=out/$name.fovea

echo "== mapping $drive, every 8th frame held out"
"$fovea" map "$drive" -o "$map" "${cameras[@]}" --hold-out 8:4 --force --report "out/$name.map.json"
echo "== scores on the frames held out"
"$fovea" evaluate "$map" "$drive" --protocol held-out --json "out/$name.held-out.json"
if [[ -n $truth ]]; then
  echo "== scores against the truth"
  "$fovea" evaluate "$map" "$drive" --protocol truth --json "out/$name.truth.json"
fi
echo "== export"
"$fovea" export "$map" "out/$name.ply" --force
"$fovea" export "$map" "out/$name.poses.txt" --format kitti-poses --force
"$fovea" render "$map" -o "out/$name.png" --force
echo "== written: $map, out/$name.ply (open it in CloudCompare or MeshLab), out/$name.png (a picture of it),"
echo "            out/$name.poses.txt, out/$name.*.json"
