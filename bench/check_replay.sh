#!/usr/bin/env bash
# A small simulated drive, played three times, is mapped as one of three times its length:
# bench/check_replay.sh REPLAY_DRIVE FOVEA
set -euo pipefail
replay=$1 fovea=$2
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
"$fovea" simulate -o "$scratch/street" --frames 12 --quiet --set camera.numbers=[2] --set camera.width=310 \
  --set camera.height=94 --set camera.focal=180 --set camera.cx=152 --set camera.cy=43
drive=$(echo "$scratch"/street/*/*_sync)
"$replay" "$drive" --times 3 -o "$scratch/replay" >/dev/null
replayed=$(echo "$scratch"/replay/*/*_sync)
[[ $(find "$replayed" -type f -size +100k | wc -l) == 0 ]] || { echo "a picture or scan was copied"; exit 1; }
# Poses by navigation: where the replay puts the vehicle.
"$fovea" map "$replayed" -o "$scratch/thrice.fovea" --poses navigation --quiet
"$fovea" export "$scratch/thrice.fovea" "$scratch/thrice.txt" --quiet --format kitti-poses
# Every run moves as the first one does, and begins a step beyond the one before. (At its ends poses lie between records
# of two runs, whose times jitter.)
awk 'function step(i) { return sqrt((x[i] - x[i-1])^2 + (y[i] - y[i-1])^2 + (z[i] - z[i-1])^2) }
  { x[NR] = $4; y[NR] = $8; z[NR] = $12 }
  END {
    if (NR != 36) { print "36 poses expected, not " NR; exit 1 }
    for (i = 2; i <= 36; ++i) {
      same = (i - 1) % 12 == 0 ? 12 : (i - 1) % 12 + 1
      most = (i - 1) % 12 < 2 || (i - 1) % 12 == 11 ? 0.1 : 0.001
      if ((step(i) - step(same))^2 > most^2) { print "step " i ": " step(i) " m, not " step(same); exit 1 }
    }
  }' "$scratch/thrice.txt"
