#!/usr/bin/env bash
# Where the held-out texture error comes from (docs/accuracy.md): a simulated street drive is driven
# again and again, each time without one cause of errors, and mapped with the default preset.
#   scripts/error_budget.sh OUT_DIR [FRAMES]
# What stands in OUT_DIR already is not made again.
set -euo pipefail
fovea="$(dirname "${BASH_SOURCE[0]}")/../build/release/fovea"
out=$1 frames=${2:-48}
mkdir -p "$out"

simulate() { # NAME SCENE [KEY=VALUE...]
  local folder=$out/$1 scene=$2 settings=(--set "camera.numbers=[2]")
  shift 2
  for setting in "$@"; do settings+=(--set "$setting"); done
  [[ -d $folder ]] || "$fovea" simulate -o "$folder" --scene "$scene" --seed 3 --frames "$frames" --quiet "${settings[@]}"
}

score() { # ROW DRIVE [MAP OPTION...]
  local row=$1 drive=$out/$2 base=$out/row-$1
  shift 2
  [[ -s $base.json ]] && return
  "$fovea" map "$drive" -o "$base.fovea" --hold-out 8:4 --force --quiet "$@"
  "$fovea" evaluate "$base.fovea" "$drive" --json "$base.held.json" >/dev/null
  "$fovea" evaluate "$base.fovea" "$drive" --truth --json "$base.truth.json" >/dev/null
  jq -n --slurpfile held "$base.held.json" --slurpfile truth "$base.truth.json" \
    '{held: ($held[0] | del(.frames)), truth: $truth[0]}' >"$base.json"
  rm "$base.fovea" "$base.held.json" "$base.truth.json"
}

row() { # TITLE ROW REFERENCE_ROW
  jq -r --arg title "$1" --slurpfile reference "$out/row-$3.json" '
    def f(n): . * pow(10; n) | round / pow(10; n);
    [$title, (.held.te_mean | f(2)), (($reference[0].held.te_mean - .held.te_mean) | f(2)),
     (.held.split.te_sampling | f(2)), (.held.split.te_same_place | f(2)), (.held.te_gain_mean | f(2)),
     (.held.visible.te_mean | f(2)), (.held.me_mean * 1000 | f(1)), (.held.coverage_5cm | f(3)),
     (.truth.pose_aligned_m.rmse * 1000 | f(1))]
    | "| " + (map(tostring) | join(" | ")) + " |"' "$out/row-$2.json"
}

set_row() { # TITLE ROW PATH_OF_FIGURES LEFT_OUT
  jq -r --arg title "$1" '
    def f(n): . * pow(10; n) | round / pow(10; n);
    '"$3"' as $set
    | [$title, $set.points, ($set.te_mean | f(2)), ($set.te_within_20 | f(3)), ($set.me_mean * 1000 | f(1)),
       ($set.coverage_5cm | f(3)), '"$4"']
    | "| " + (map(tostring) | join(" | ")) + " |"' "$out/row-$2.json"
}

no_noise=(lidar.range_noise=0 lidar.range_resolution=0)
exact_navigation=(navigation.position_noise=0 navigation.position_walk=0 navigation.position_bias=0
  navigation.angle_noise=0 navigation.angle_walk=0 navigation.jump_rate=0)

simulate street street
simulate rotated street camera.rotation_error_y=0.1
simulate late street camera.trigger_delay=0.005
simulate exact-navigation street "${exact_navigation[@]}"
simulate range street "${no_noise[@]}"
simulate exposure street camera.exposure_variation=0 camera.vignetting=0
simulate pixel-noise street camera.noise=0
simulate matte street light.reflections=false
simulate perfect street "${exact_navigation[@]}" "${no_noise[@]}" camera.exposure_variation=0 camera.vignetting=0 \
  camera.noise=0 light.reflections=false
simulate traffic traffic

score street street
score given street --poses navigation
score uncompensated street --set motion.compensate=false
score true-poses exact-navigation --poses navigation
for drive in rotated late exact-navigation range exposure pixel-noise matte perfect traffic; do score "$drive" "$drive"; done
for drive in rotated late; do score "$drive-calibrated" "$drive" --calibrate; done
score perfect-true-poses perfect --poses navigation
score traffic-kept traffic --set dynamic.remove=false

echo "| street, default preset | TE | less by | te_sampling | te_same_place | TE, fitted gains | TE, visible | ME mm | cover 5 cm | poses, mm |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
row "as KITTI's sensors see it" street street
row "pose: exact navigation, registered" exact-navigation street
row "pose: exact navigation, not registered" true-poses street
row "LiDAR: ranges without noise" range street
row "exposure: constant, no vignetting" exposure street
row "image: no pixel noise" pixel-noise street
row "view dependence: nothing mirrors" matte street
row "all of these at once" perfect street
row "all, and true poses: sampling, resampling, occlusion remain" perfect-true-poses street
echo
echo "| a fault put in | TE | less by | te_sampling | te_same_place | TE, fitted gains | TE, visible | ME mm | cover 5 cm | poses, mm |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
row "pose: navigation alone" given street
row "timing: the sweep as measured" uncompensated street
row "timing: images 5 ms late" late street
row "... with --calibrate" late-calibrated street
row "calibration: 0.1 degrees about the vertical" rotated street
row "... with --calibrate" rotated-calibrated street
row "moving things: traffic" traffic traffic
row "... kept in the map" traffic-kept traffic
echo
echo "| traffic | points scored | TE | within 20 | ME mm | cover 5 cm | map points left out |"
echo "| --- | --- | --- | --- | --- | --- | --- |"
left_out='"\(.held.without_moving.map_points_left_out) of \(.held.map_points)"'
set_row "with what moved" traffic .held '""'
set_row "without" traffic .held.without_moving "$left_out"
set_row "kept in the map, with what moved" traffic-kept .held '""'
set_row "kept in the map, without" traffic-kept .held.without_moving "$left_out"
