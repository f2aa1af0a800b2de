#!/usr/bin/env bash
# The house's floors (ARCHITECTURE.md): a folder includes only lower floors and, on its own floor, only
# itself; the stages in mapping/ know neither each other's callers nor the store. Reads #include lines.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

declare -A floor=([base]=0 [geometry]=1 [sensor]=2 [mapping]=2 [map]=2 [world]=2 [recording]=2 [pipeline]=3 [evaluation]=3 [rosbag]=3
  [simulation]=3 [exporting]=3 [merging]=4 [localization]=4 [rendering]=4 [server]=4)
failed=0
while IFS=: read -r file line include; do
  from=${file#src/fovea/}
  from=${from%%/*}
  to=${include#*\"fovea/}
  to=${to%%/*}
  if [[ -z ${floor[$from]:-} || -z ${floor[$to]:-} ]]; then
    echo "$file:$line: no floor is known for $from or $to (scripts/check_layers.sh)" >&2
    failed=1
  elif [[ $from != "$to" && ${floor[$to]} -ge ${floor[$from]} ]]; then
    echo "$file:$line: $from/ (floor ${floor[$from]}) must not include $to/ (floor ${floor[$to]})" >&2
    failed=1
  elif [[ $from == simulation && $file != *_test.cpp && ! $to =~ ^(simulation|recording|world|geometry|base)$ ]]; then
    # What the product is judged by shares nothing with it but mathematics; its tests may read back.
    echo "$file:$line: simulation/ must not include $to/" >&2
    failed=1
  fi
done < <(grep -rnE '^ *# *include +"fovea/' src/fovea)
if grep -rnE '^ *# *include +"(app|python)/' src/fovea; then
  echo "src/fovea must include neither app/ nor python/" >&2
  failed=1
fi
if grep -rnE '^ *# *include +"app/' python || grep -rnE '^ *# *include +"python/' app; then
  echo "app/ and python/ must not include each other" >&2
  failed=1
fi
# Text from files must not steer the terminal: app/print.h is the only way to it.
if grep -nE 'fmt::print|std::cout|std::cerr|printf\(|fputs\(|\bputs\(|fwrite\(' app/*.cpp app/*/*.cpp |
  grep -vE '^app/(print|main|progress_bar)\.cpp:'; then
  echo "app/ prints through app/print.h" >&2
  failed=1
fi
exit $failed
