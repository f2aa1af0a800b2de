#!/usr/bin/env bash
# Simulates a street with every LiDAR, mount, sweep and camera timing. Maps each drive with the default preset and
# prints a table of the scores against the truth:
#   scripts/lidars.sh OUT_DIR [FRAMES] [REGEX]
# REGEX chooses drives by their names. A drive, map or score that is in OUT_DIR already is not made again.
set -euo pipefail
fovea="$(dirname "${BASH_SOURCE[0]}")/../build/release/fovea"
out=$1 frames=${2:-40} chosen=${3:-.}
camera=(camera.numbers=[2] camera.cx=304.5 camera.cy=86.2 camera.width=620 camera.height=188 camera.focal=360)
# Name, then the keys that differ.
drives=(
  "hdl64"
  "hdl32 lidar.model=hdl32"
  "vlp16 lidar.model=vlp16"
  "os1-64 lidar.model=os1-64"
  "os1-128 lidar.model=os1-128"
  "pandar64 lidar.model=pandar64"
  "xt32 lidar.model=xt32"
  "livox-avia lidar.model=livox-avia"
  "livox-hap lidar.model=livox-hap"
  "upside-down lidar.model=hdl32 lidar.roll=180"
  "rolled-20 lidar.model=hdl32 lidar.roll=20"
  "pitched-15 lidar.model=hdl32 lidar.pitch=15"
  "yawed-90 lidar.model=hdl32 lidar.yaw=90"
  "yawed-180 lidar.model=hdl32 lidar.yaw=180"
  "height-1-m lidar.model=hdl32 lidar.height=1"
  "height-3-m lidar.model=hdl32 lidar.height=3"
  "counterclockwise lidar.model=hdl32 lidar.direction=counterclockwise"
  "from-ahead lidar.model=hdl32 lidar.start_azimuth=0"
  "stamped-at-start lidar.model=hdl32 lidar.stamp_phase=0"
  "stamped-at-end lidar.model=hdl32 lidar.stamp_phase=1"
  "no-point-times lidar.model=hdl32 lidar.point_times=false"
  "no-times-backwards lidar.model=hdl32 lidar.point_times=false lidar.direction=counterclockwise lidar.stamp_phase=1"
  "hdl32-5-hz lidar.model=hdl32 lidar.period=0.2"
  "hdl32-20-hz lidar.model=hdl32 lidar.period=0.05"
  "vlp16-5-hz lidar.model=vlp16 lidar.period=0.2"
  "vlp16-20-hz lidar.model=vlp16 lidar.period=0.05"
  "vlp16-upside-down lidar.model=vlp16 lidar.roll=180"
  "camera-30-hz lidar.model=hdl32 camera.rate=30 camera.phase=0.007"
  "camera-7-hz lidar.model=hdl32 camera.rate=7"
  "rolling-shutter lidar.model=hdl32 camera.rolling_shutter=0.02"
)
mkdir -p "$out"

echo "| drive | pose, cm | accuracy, mm | 95 %, mm | precision 5 cm | completeness 5 cm | colors within 20 |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
for drive in "${drives[@]}"; do
  read -r name keys <<<"$drive"
  [[ $name =~ $chosen ]] || continue
  base=$out/$name
  settings=()
  for key in "${camera[@]}" $keys; do settings+=(--set "$key"); done
  [[ -d $base ]] ||
    "$fovea" simulate -o "$base" --format generic --frames "$frames" --quiet "${settings[@]}"
  [[ -s $base.fovea ]] || "$fovea" map "$base" -o "$base.fovea" --force --quiet
  [[ -s $base.json ]] || "$fovea" evaluate "$base.fovea" "$base" --truth --json "$base.json" >/dev/null
  jq -r --arg name "$name" '
    def f(n): if . == null then "-" else . * pow(10; n) | round / pow(10; n) end;
    [$name, (.pose_aligned_m.mean * 100 | f(2)), (.accuracy_mean * 1000 | f(1)),
     (.accuracy_p95 * 1000 | f(1)), (.precision_5cm | f(3)), (.completeness_5cm | f(3)),
     (.color_view.within_20 | f(3))]
    | "| " + (map(tostring) | join(" | ")) + " |"' "$base.json"
done
