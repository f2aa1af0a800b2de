#!/usr/bin/env bash
# Checks the layers of ARCHITECTURE.md: a module includes only modules of lower layers and itself. Its tests may also
# include modules of the same layer. Reads #include lines.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

declare -A layer=([core]=0 [geometry]=1 [drive]=2 [mapping]=2 [map]=2 [world]=2 [recordings]=3 [city]=3 [pipeline]=3
  [rendering]=3 [simulation]=3 [bridge]=4 [evaluation]=4 [exporting]=4 [merging]=4 [localization]=4 [server]=5)
# The simulator is the independent oracle: it shares only mathematics and the writers of drives with the product.
oracle='^fovea/(simulation|world|geometry|core|drive/writers)/'
failed=0
report() {
  echo "$1" >&2
  failed=1
}

module_of() { # PATH below src/fovea/
  case $1 in
    drive/recordings/*) echo recordings ;;
    drive/bridge/*) echo bridge ;;
    *) echo "${1%%/*}" ;;
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
  elif [[ $from == simulation && $is_test == 0 && ! $header =~ $oracle ]]; then
    report "$file:$line: simulation/ must not include $header"
  fi
done < <(grep -rnE '^ *# *include +"fovea/' src/fovea)
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
