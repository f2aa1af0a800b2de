#!/usr/bin/env bash
# Simulates every scene, maps it with the default preset and prints a table of its scores:
#   scripts/scenes.sh OUT_DIR [FRAMES]
# What stands in OUT_DIR already is not made again.
set -euo pipefail
fovea="$(dirname "${BASH_SOURCE[0]}")/../build/release/fovea"
out=$1 frames=${2:-60}
scenes=(street traffic crossing canyon plaza stress)
mkdir -p "$out"

for scene in "${scenes[@]}"; do
  base=$out/$scene
  [[ -d $base ]] || "$fovea" simulate -o "$base" --scene "$scene" --frames "$frames" --quiet
  [[ -s $base.map.json ]] || "$fovea" map "$base" -o "$base.fovea" --cameras 2,3 --hold-out 8:4 --force \
    --quiet --report "$base.map.json"
  for protocol in held-out truth; do
    [[ -s $base.$protocol.json ]] ||
      "$fovea" evaluate "$base.fovea" "$base" --protocol "$protocol" --json "$base.$protocol.json" >/dev/null
  done
done

echo "| scene | points | ME m | TE | cover 5 cm | violations | pose, aligned cm | drift over 10 m | accuracy mm | 95 % mm | completeness 5 cm | F 2 cm | F 5 cm | colour, perfect image | with gains | ghosts |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
for scene in "${scenes[@]}"; do
  jq -r --arg scene "$scene" --slurpfile held "$out/$scene.held-out.json" '
    def f(n): . * pow(10; n) | round / pow(10; n);
    $held[0] as $h
    | [$scene, (.map_points / 1e6 | f(2) | tostring + " M"), ($h.me_mean | f(4)), ($h.te_mean | f(1)),
       ($h.coverage_5cm | f(3)), ($h.free_space_violations | f(4)), (.pose_aligned_m.mean * 100 | f(1)),
       (.pose_drift_10m_percent.mean | f(2) | tostring + " %"), (.accuracy_mean * 1000 | f(1)),
       (.accuracy_p95 * 1000 | f(1)), (.completeness_5cm | f(3)), (.f_score_2cm | f(3)), (.f_score_5cm | f(3)),
       (.color_view.mean | f(1)), (.color_view.gain_mean | f(1)), (.ghost_share * 100 | f(2) | tostring + " %")]
    | "| " + (map(tostring) | join(" | ")) + " |"' "$out/$scene.truth.json"
done
