#!/usr/bin/env bash
# Two runs of `fovea_bench --json` side by side:
#   bench/compare.sh OLD.json NEW.json
# Medians in ms, old over new (above 1: the new one is faster), and each run's ratio to the peer.
set -euo pipefail
echo "| benchmark | old ms | new ms | old / new | peer / old | peer / new |"
echo "| --- | --- | --- | --- | --- | --- |"
jq -rn --slurpfile old "$1" --slurpfile new "$2" '
  def f: if . == null then "-" else . * 100 | round / 100 | tostring end;
  ($old[0].benchmarks | map({(.name): .}) | add) as $before
  | $new[0].benchmarks[]
  | $before[.name] as $b
  | "| \(.name | sub("/manual_time$"; "")) | \($b.median_ms | f) | \(.median_ms | f) | \(
      if $b then $b.median_ms / .median_ms else null end | f) | \($b.ratio | f) | \(.ratio | f) |"'
