#!/usr/bin/env bash
# Installs what is missing of the parts of scripts/packages.txt, and the npm packages of viewer/ (part
# viewer) and tests/web (part tests), exact versions, into node_modules in these folders:
#   scripts/setup.sh [--no-install] [PART...]     without PART: build product viewer, all that the program needs
# --no-install only says what is missing, and fails if anything is.
set -euo pipefail
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)

parts=()
may_install=true
for argument in "$@"; do
  case $argument in
    build | product | viewer | python | tests | packages) parts+=("$argument") ;;
    --no-install) may_install=false ;;
    *)
      echo "setup: unknown part or option $argument, see scripts/packages.txt" >&2
      exit 2
      ;;
  esac
done
[[ ${#parts[@]} -gt 0 ]] || parts=(build product viewer)
has_part() { [[ " ${parts[*]} " == *" $1 "* ]]; }

packages_of_parts() {
  awk -v parts=" ${parts[*]} " '
    /^\[.*\]$/ { wanted = index(parts, " " substr($0, 2, length($0) - 2) " ") }
    /^[a-z0-9]/ && wanted { print $1 }' "$here/packages.txt"
}

# Some packages are provided by others: npm by other builds of nodejs.
missing_packages() {
  local provided package
  provided=$(dpkg-query -W -f='${db:Status-Status} ${Package}, ${Provides}\n' |
    sed -n 's/^installed //p' | tr ',' '\n' | awk 'NF {print $1}')
  packages_of_parts | while read -r package; do
    grep -qxF "$package" <<<"$provided" || echo "$package"
  done
}

install_packages() { # PACKAGE...
  local as_root=() log
  if [[ $(id -u) -ne 0 ]]; then
    if ! command -v sudo >/dev/null; then
      echo "setup: missing packages: $*; run as root, or install sudo" >&2
      return 1
    fi
    as_root=(sudo)
  fi
  echo "setup: installing $*"
  log=$(mktemp)
  apt_install() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
      apt-get install -y --no-install-recommends "$@" >"$log" 2>&1
  }
  # A new machine may have no package lists, an old one stale ones.
  if ! apt_install "$@"; then
    "${as_root[@]}" apt-get update >>"$log" 2>&1 || true
    if ! apt_install "$@"; then
      tail -n 20 "$log" >&2
      echo "setup: apt-get could not install them, see above" >&2
      return 1
    fi
  fi
  rm -f "$log"
}

# What is installed is what the lock file says.
npm_packages_installed() { # FOLDER
  cmp -s "$1/package-lock.json" "$1/node_modules/.installed-lock.json"
}

install_npm_packages() { # FOLDER
  local log
  echo "setup: installing the packages of ${1#"$here/../"}"
  log=$(mktemp)
  # Not `npm ci`: it refuses lock files without the optional packages of all other platforms.
  if ! npm install --no-save --prefix "$1" --no-audit --no-fund --ignore-scripts >"$log" 2>&1; then
    tail -n 20 "$log" >&2
    echo "setup: npm could not install them, see above" >&2
    return 1
  fi
  cp "$1/package-lock.json" "$1/node_modules/.installed-lock.json"
  rm -f "$log"
}

mapfile -t missing < <(missing_packages)
if [[ ${#missing[@]} -gt 0 ]]; then
  if ! $may_install; then
    echo "setup: missing packages: ${missing[*]}" >&2
    echo "setup: install them with: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  install_packages "${missing[@]}"
fi
npm_folders=()
if has_part viewer; then npm_folders+=("$here/../viewer"); fi
if has_part tests; then npm_folders+=("$here/../tests/web"); fi
for folder in "${npm_folders[@]}"; do
  if npm_packages_installed "$folder"; then continue; fi
  if ! $may_install; then
    echo "setup: npm's packages of ${folder#"$here/../"} are missing; install them with: scripts/setup.sh ${parts[*]}" >&2
    exit 1
  fi
  install_npm_packages "$folder"
done
