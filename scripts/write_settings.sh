#!/usr/bin/env bash
# Writes the files that are made of the settings' rows: config/default.toml and docs/settings.md.
# Build the program first.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
fovea=${1:-build/release/fovea}
"$fovea" settings list > config/default.toml
"$fovea" settings docs > docs/settings.md
