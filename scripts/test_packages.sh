#!/usr/bin/env bash
# Installs the packages that scripts/build_packages.sh made, each in a bare Debian 12, and uses them:
#   scripts/test_packages.sh OUT_DIR
# Needs root, debootstrap and a mirror of Debian; the wheel also needs PyPI. A missing one is a notice, and the test
# that needs it is left out. FOVEA_PACKAGE_CACHE is the folder of the bare system and of downloads
# (default: /tmp/fovea_package_cache).
set -euo pipefail
[[ $# -eq 1 && $1 != -* ]] || { sed -n '2,6s/^# //p' "$0" && exit 2; }
out=$(cd "$1" && pwd)
here=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
cache=${FOVEA_PACKAGE_CACHE:-/tmp/fovea_package_cache}
passed=0 failed=0 skipped=0

leave_out() { # REASON
  echo "test_packages: left out: $*"
  ((skipped += 1))
}

mirror() {
  apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Label: Debian' 'Codename: bookworm' |
    head -n 1
}

# The bare system, as an archive: each test unpacks its own.
make_base() {
  local base=$cache/bookworm.tar
  [[ ! -f $base ]] || return 0
  mkdir -p "$cache/archives"
  rm -rf "$cache/base"
  debootstrap --variant=minbase --include=ca-certificates bookworm "$cache/base" "$(mirror)" \
    >"$cache/debootstrap.log" 2>&1 || return 1
  tar -C "$cache/base" --one-file-system -cf "$base.new" .
  mv "$base.new" "$base"
  rm -rf "$cache/base"
}

# In a mount namespace of its own: nothing stays mounted.
run_in() { # ROOT COMMAND...
  local root=$1
  shift
  unshare --mount --pid --fork bash -c '
    set -e
    root=$1 archives=$2
    shift 2
    mount -t proc proc "$root/proc"
    mount --rbind /dev "$root/dev"
    mount --bind "$archives" "$root/var/cache/apt/archives"
    exec env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root PIP_CERT=/etc/ssl/certs/ca-certificates.crt \
      PIP_CACHE_DIR=/var/cache/apt/archives/pip PIP_INDEX_URL="${PIP_INDEX_URL:-}" \
      http_proxy="${http_proxy:-}" https_proxy="${https_proxy:-}" chroot "$root" "$@"' \
    run_in "$root" "$cache/archives" "$@"
}

test_package() { # NAME FILE
  local name=$1 file=$2 root begin=$SECONDS code=0
  root=$(mktemp -d "$cache/root.XXXXXX")
  tar -C "$root" -xf "$cache/bookworm.tar"
  cp -L /etc/resolv.conf "$root/etc/"
  cp -L /etc/ssl/certs/ca-certificates.crt "$root/etc/ssl/certs/"
  # Packages that were downloaded before stay in the cache.
  echo 'Binary::apt::APT::Keep-Downloaded-Packages "true";' >"$root/etc/apt/apt.conf.d/keep"
  mkdir "$root/packages"
  cp "$file" "$here/tests/packages/use_$name.sh" "$root/packages/"
  echo "== $name: $(basename "$file")"
  { run_in "$root" apt-get update -qq && prepare "$name" "$root" &&
    run_in "$root" bash "/packages/use_$name.sh" "$version"; } || code=$?
  rm -rf --one-file-system "$root"
  case $code in
    0) ((passed += 1)) && echo "== $name: passed, $((SECONDS - begin)) s" ;;
    77) leave_out "the wheel needs PyPI, which is unreachable" ;;
    *) ((failed += 1)) && echo "== $name: FAILED, $((SECONDS - begin)) s" ;;
  esac
}

prepare() { # NAME ROOT
  [[ $1 == deb ]] || run_in "$2" apt-get install -y -qq --no-install-recommends python3-venv >"$cache/apt.log" 2>&1
}

version=$(basename "$out"/fovea-*.tar.gz .tar.gz)
version=${version#fovea-}
deb=$(ls "$out"/fovea_*.deb)
wheel=$(ls "$out"/fovea-*.whl 2>/dev/null || true)
(cd "$out" && sha256sum --quiet -c SHA256SUMS)
if [[ $(id -u) -ne 0 ]]; then
  leave_out "needs root"
elif ! command -v debootstrap >/dev/null; then
  leave_out "needs debootstrap, install it with: apt-get install debootstrap"
elif ! make_base; then
  leave_out "the mirror of Debian is unreachable, see $cache/debootstrap.log"
else
  test_package deb "$deb"
  if [[ -n $wheel ]]; then test_package wheel "$wheel"; else leave_out "there is no wheel"; fi
fi
echo "$passed passed, $failed failed, $skipped skipped"
[[ $failed -eq 0 ]]
