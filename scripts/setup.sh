#!/usr/bin/env bash
# Installs the Debian packages of scripts/packages.txt that are missing. Source or run it:
#   scripts/setup.sh [--no-install]
# --no-install only says what is missing, and fails if anything is.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

mapfile -t wanted < <(sed -e 's/#.*//' "$here/packages.txt" | awk 'NF {print $1}')
missing=()
for package in "${wanted[@]}"; do
  status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
  [[ $status == installed ]] || missing+=("$package")
done
[[ ${#missing[@]} -eq 0 ]] && exit 0

if [[ ${1:-} == --no-install ]]; then
  echo "setup: missing packages: ${missing[*]}" >&2
  echo "setup: install them with: apt-get install ${missing[*]}" >&2
  exit 1
fi
if [[ $(id -u) -eq 0 ]]; then
  as_root=()
elif command -v sudo >/dev/null; then
  as_root=(sudo)
else
  echo "setup: missing packages: ${missing[*]}; run as root, or install sudo" >&2
  exit 1
fi
echo "setup: installing ${missing[*]}"
log=$(mktemp)
install() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y --no-install-recommends "${missing[@]}" >"$log" 2>&1
}
# A new machine may have no package lists, an old one stale ones.
if ! install; then
  "${as_root[@]}" apt-get update >>"$log" 2>&1 || true
  if ! install; then
    tail -n 20 "$log" >&2
    echo "setup: apt-get could not install them, see above" >&2
    exit 1
  fi
fi
rm -f "$log"
