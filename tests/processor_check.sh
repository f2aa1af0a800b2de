#!/usr/bin/env bash
# The program on emulated processors: processor_check.sh QEMU PROGRAM. One without AVX2 gets one line.
set -euo pipefail
qemu=$1 program=$2
scratch=$(mktemp -d)
trap 'rm -r "$scratch"' EXIT
code=0
"$qemu" -cpu Nehalem "$program" --version >"$scratch/out" 2>"$scratch/errors" || code=$?
expected="fovea: error: the processor lacks AVX, this machine, use a processor with x86-64-v3 (from 2013 on) or build Fovea \
with -DFOVEA_X86_64_V3=OFF"
if [[ $code -ne 1 || -s $scratch/out || $(<"$scratch/errors") != "$expected" ]]; then
  echo "on an old processor: exit code $code" >&2
  cat "$scratch/out" "$scratch/errors" >&2
  exit 1
fi
"$qemu" -cpu max "$program" --version
