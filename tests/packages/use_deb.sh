#!/usr/bin/env bash
# Runs as root in a bare Debian 12 with the .deb in /packages: installs it, uses all that it contains, removes it.
set -euo pipefail
cd /tmp
export LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive
version=$1

say() { echo "-- $*"; }

# The page and the description of the map, as the browser gets them. A map that grows is there after a while.
fetch_page() { # URL
  python3 - "$1" <<'END'
import json, sys, time, urllib.request
url = sys.argv[1].rstrip("/")
def read(path):
    return urllib.request.urlopen(f"{url}/{path}", timeout=60).read()
assert b"<script" in read(""), "no page"
for _ in range(240):
    shown = json.loads(read("map.json"))
    if shown["tileset"]:
        break
    time.sleep(0.5)
assert shown["points"] > 10000, shown
json.loads(read(shown["tileset"]))
print(f"the page shows a map of {shown['points']} points")
END
}

view_and_fetch() { # COMMAND...: a command that prints the address of its page
  local url="" i
  setsid "$@" >view.log 2>&1 &
  local viewer=$!
  for ((i = 0; i < 240; i++)); do
    url=$(grep -oE 'http://[0-9.:]+' view.log | head -n 1) && break
    kill -0 $viewer 2>/dev/null || break
    sleep 0.5
  done
  [[ -n $url ]] || { cat view.log && return 1; }
  fetch_page "$url"
  kill -INT $viewer
  wait $viewer || [[ $? -eq 130 ]]
}

say "first command: apt-get install ./fovea.deb"
apt-get install -y -qq --no-install-recommends /packages/fovea_*.deb >install.log 2>&1 || { cat install.log && exit 1; }
[[ $(fovea --version) == "fovea $version" ]]
say "a drive"
fovea simulate -o street --format generic --frames 12 --quiet
say "second command: fovea map --live"
view_and_fetch fovea map street -o street.fovea --hold-out 8:4 --live
say "fovea view, fovea evaluate"
view_and_fetch fovea view street.fovea --drive street --no-browser --port 0
fovea evaluate street.fovea street >evaluate.log
say "import fovea"
python3 -c "
import fovea
assert fovea.__version__ == '$version', fovea.__version__
points = fovea.Map('street.fovea').points()
assert points.position.shape[0] > 10000
from fovea.city.arguments import find_program
assert find_program() == '/usr/bin/fovea', find_program()"
say "a C++ program with the installed headers"
apt-get install -y -qq --no-install-recommends g++ pkg-config >install.log 2>&1 || { cat install.log && exit 1; }
# shellcheck disable=SC2046
g++ -std=c++20 /usr/share/doc/fovea/examples/register_scans.cpp $(pkg-config --cflags --libs fovea) -o register_scans
./register_scans street 0 1
say "removal"
apt-get remove -y -qq fovea >install.log 2>&1 || { cat install.log && exit 1; }
left=$(find /usr /etc /var/lib/fovea -iname '*fovea*' 2>/dev/null || true)
[[ -z $left ]] || { echo "the package leaves behind: $left" && exit 1; }
