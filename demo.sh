#!/usr/bin/env bash
# Sets up, builds, maps a drive, scores the map and exports it.
#   ./demo.sh [--no-install] [DRIVE]     results under out/
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"

install_flag=
drive=
for argument in "$@"; do
  case $argument in
    --no-install) install_flag=--no-install ;;
    -h | --help)
      sed -n '2,3s/^# //p' "$0"
      exit 0
      ;;
    -*)
      echo "demo: unknown option $argument, usage: ./demo.sh [--no-install] [DRIVE]" >&2
      exit 2
      ;;
    *) drive=$argument ;;
  esac
done

if [[ -z $drive ]]; then
  drive=${FOVEA_KITTI_SAMPLE:-../shared/data/kitti/2011_09_26/2011_09_26_drive_0009_sync}
  if [[ ! -d $drive ]]; then
    echo "demo: no drive given and no sample drive at $drive, usage: ./demo.sh DRIVE" >&2
    echo "demo: DRIVE is a KITTI raw drive folder (2011_09_26/2011_09_26_drive_0009_sync) or an" >&2
    echo "demo: odometry sequence folder (sequences/00)" >&2
    exit 2
  fi
fi

scripts/setup.sh $install_flag
scripts/build.sh release fovea_app
fovea=build/release/fovea
name=$(basename "$(cd "$drive" && pwd)")
mkdir -p out
map=out/$name.fovea

echo "== mapping $drive, every 8th frame held out"
"$fovea" map "$drive" -o "$map" --hold-out 8:4 --force --report "out/$name.map.json"
echo "== scores on the frames held out"
"$fovea" evaluate "$map" "$drive" --protocol held-out --json "out/$name.held-out.json"
echo "== export"
"$fovea" export "$map" "out/$name.ply" --force
"$fovea" export "$map" "out/$name.poses.txt" --format kitti-poses --force
echo "== written: $map, out/$name.ply (open it in CloudCompare or MeshLab), out/$name.poses.txt,"
echo "            out/$name.map.json, out/$name.held-out.json"
