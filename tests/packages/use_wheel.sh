#!/usr/bin/env bash
# Runs as root in a bare Debian 12 with python3-venv and the wheel in /packages: installs and uses it in two virtual
# environments, with the newest NumPy and with NumPy 1. The exit code is 77 if PyPI is unreachable.
set -euo pipefail
cd /tmp
export LC_ALL=C.UTF-8
version=$1
python3 -m venv new
new/bin/pip download --quiet --retries 0 --timeout 15 --no-deps --dest downloads numpy || exit 77
echo "-- first command: pip install fovea.whl"
new/bin/pip install --quiet --disable-pip-version-check /packages/fovea-*.whl
[[ $(new/bin/fovea --version) == "fovea $version" ]]
new/bin/fovea simulate -o street --format generic --frames 12 --quiet
echo "-- second command: fovea.map_drive"
new/bin/python -c "import fovea; fovea.map_drive('street', 'street.fovea')"
new/bin/fovea info street.fovea >info.log
use="
import fovea, numpy, os
from fovea.city.arguments import find_program
assert fovea.__version__ == '$version', fovea.__version__
points = fovea.Map('street.fovea').points(where='views >= 2')
assert points.position.shape[0] > 1000
print('numpy', numpy.__version__, 'points', points.position.shape[0], flush=True)
os.execv(find_program(), ['fovea', '--version'])"
new/bin/python -c "$use"
echo "-- the same with NumPy 1"
python3 -m venv old
old/bin/pip install --quiet --disable-pip-version-check /packages/fovea-*.whl 'numpy<2'
old/bin/python -c "$use"
