#!/usr/bin/env bash
# Maps a drive with every row of the paper's Table II and with the presets, and prints the tables of
# docs/results.md:  scripts/variants.sh DRIVE OUT_DIR [ROW...]
# What stands in OUT_DIR already is not made again.
set -euo pipefail
fovea="$(dirname "${BASH_SOURCE[0]}")/../build/release/fovea"
drive=$1 out=$2
shift 2
rows=("$@")
if [[ ${#rows[@]} -eq 0 ]]; then
  rows=(baseline-gicp E0 E1 E2 E3 baseline-icp E4 E5 E6 E7 baseline-plane E8 E9 E10 E11 paper default)
fi
mkdir -p "$out"

selection() { # ROW: the options that select it
  case $1 in
    default | paper) echo "--preset $1" ;;
    *) echo "--variant $1" ;;
  esac
}

score() { # SET PROTOCOL, of every row: SET is all (every frame mapped) or held (every 8th held out)
  local set=$1 protocol=$2 row base hold_out=
  [[ $set == held ]] && hold_out="--hold-out 8:4"
  for row in "${rows[@]}"; do
    base=$out/$row.$set
    # shellcheck disable=SC2046,SC2086
    [[ -s $base.map.json ]] || "$fovea" map "$drive" -o "$base.fovea" $(selection "$row") $hold_out \
      --force --quiet --report "$base.map.json"
    [[ -s $base.$protocol.json ]] || "$fovea" evaluate "$base.fovea" "$drive" \
      --protocol "$protocol" --json "$base.$protocol.json" >/dev/null
  done
}
score held held-out
score all in-sample
score all in-sample-nav
rm -f "$out"/*.fovea

table() { # PROTOCOL SET
  echo "| row | points | ME m | sd | TE | sd | median | within 20 | TE fitted gain | MTME | cover 5 cm | cover 20 cm | violations | sharpness | TE, uncoloured black |"
  echo "| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |"
  for row in "${rows[@]}"; do
    jq -r --arg row "$row" --slurpfile map "$out/$row.$2.map.json" '
      def f(n): . * pow(10; n) | round / pow(10; n);
      [$row, ($map[0].map.points / 1e6 | f(2) | tostring + " M"), (.me_mean | f(4)), (.me_std | f(4)),
       (.te_mean | f(2)), (.te_std | f(1)), (.te_median | f(1)), (.te_within_20 | f(3)),
       (.te_gain_mean | f(2)), (.mtme | f(3)), (.coverage_5cm | f(3)), (.coverage_20cm | f(3)),
       (.free_space_violations | f(4)), (.sharpness | f(2)), (.paper_like.te_mean | f(1))]
      | "| " + (map(tostring) | join(" | ")) + " |"' "$out/$row.$2.$1.json"
  done
}

echo "### Held out (every 8th frame: quality)"
echo
table held-out held
echo
echo "### In-sample, scans placed by the refined poses (the paper's way: not quality)"
echo
table in-sample all
echo
echo "### In-sample, scans placed by the navigation poses"
echo
table in-sample-nav all
echo
echo "### Time a frame (ms, median / 95 %), all frames mapped"
echo
echo "| row | frame | upsample | register | filter | frames/s | peak MB | registrations failed |"
echo "| --- | --- | --- | --- | --- | --- | --- | --- |"
for row in "${rows[@]}"; do
  jq -r --arg row "$row" '.map |
    def t(s): .latency_ms[s] | "\(.p50 | round) / \(.p95 | round)";
    [$row, t("frame"), t("upsample"), t("register"), t("filter"), (.fps * 10 | round / 10),
     (.peak_rss_mb | round), .registrations_failed]
    | "| " + (map(tostring) | join(" | ")) + " |"' "$out/$row.all.map.json"
done
