#!/usr/bin/env bash
# Checks the layers of ARCHITECTURE.md: a module includes only modules of lower layers and itself. Its tests may also
# include modules of the same layer. Reads #include lines.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

declare -A layer=([core]=0 [geometry]=1 [drive]=2 [mapping]=2 [map]=2 [world]=2 [recordings]=3 [city]=3 [pipeline]=3
  [rendering]=3 [simulation]=3 [bridge]=4 [evaluation]=4 [exporting]=4 [merging]=4 [localization]=4 [server]=5 [api]=6)
# The module that implements a public header.
declare -A public=([drive]=drive [deskew]=drive [map]=map [mapper]=api [live]=api [localize]=localization
  [evaluate]=api [export]=api)
for header in errors time platform image color point_cloud; do public[$header]=core; done
for header in rigid_motion sweep_motion camera trajectory; do public[$header]=geometry; done
for header in ground upsample registration foveal_region ray_filter texture surface_samples; do
  public[$header]=mapping
done
# The simulator is the independent oracle: it shares only mathematics and the writers of drives with the product.
oracle='^((simulation|world|geometry|core) |drive fovea/drive/writers/)'
failed=0
report() {
  echo "$1" >&2
  failed=1
}

module_of() { # PATH below src/fovea/ or include/fovea/
  local name=${1%.h}
  case $1 in
    drive/recordings/*) echo recordings ;;
    drive/bridge/*) echo bridge ;;
    */*) echo "${1%%/*}" ;;
    *) echo "${public[$name]:-$name}" ;;
  esac
}

while IFS=: read -r file line include; do
  header=${include#*\"}
  header=${header%%\"*}
  from=$(module_of "${file#src/fovea/}")
  to=$(module_of "${header#fovea/}")
  is_test=$([[ $file == *_test.cpp ]] && echo 1 || echo 0)
  if [[ -z ${layer[$from]:-} || -z ${layer[$to]:-} ]]; then
    report "$file:$line: no layer is known for $from or $to (scripts/check_layers.sh)"
  elif [[ $from != "$to" && ${layer[$to]} -gt $((layer[$from] - 1 + is_test)) ]]; then
    report "$file:$line: $from/ (layer ${layer[$from]}) must not include $to/ (layer ${layer[$to]})"
  elif [[ $from == simulation && $is_test == 0 && ! "$to $header" =~ $oracle ]]; then
    report "$file:$line: simulation/ must not include $header"
  fi
done < <(grep -rnE '^ *# *include +"fovea/' src/fovea)
if grep -rnE '^ *# *include +("fovea/[a-z_]+/|<)' include/fovea | grep -vE '<(Eigen/[A-Za-z]+|[a-z_]+)>'; then
  report "a public header includes the standard library, Eigen and other public headers only"
fi
if grep -rnE '^ *# *include +"(app|python|tools)/' src/fovea; then
  report "src/fovea must not include app/, python/ or tools/"
fi
if grep -rnE '^ *# *include +"app/' python || grep -rnE '^ *# *include +"(python|bench)/' app tools; then
  report "app/ and python/ must not include each other"
fi
if grep -rnE '^ *# *include +"app/' tools | grep -v '"app/html_report/'; then
  report "tools/ must not include app/ but for its html_report/"
fi
# Only app/print.h writes to the terminal: text from files could control it.
if grep -nE 'fmt::print|std::cout|std::cerr|printf\(|fputs\(|\bputs\(|fwrite\(' app/*.cpp app/*/*.cpp |
  grep -vE '^app/(print|main|progress_bar)\.cpp:'; then
  report "app/ prints through app/print.h"
fi
exit $failed
