#!/usr/bin/env bash
# Configures and builds a preset: tools/build.sh PRESET [TARGET...]. Quiet unless it fails; the whole log is build/PRESET.log.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

preset=$1
shift
log=build/$preset.log
mkdir -p build
targets=()
[[ $# -gt 0 ]] && targets=(--target "$@")

echo "Building ($preset; log: $log) ..." >&2
if ! { cmake --preset "$preset" && cmake --build --preset "$preset" "${targets[@]}"; } > "$log" 2>&1; then
    grep -n -m 20 -E 'FAILED|[Ee]rror' "$log" >&2 || true
    echo "--- the last lines of $log" >&2
    tail -n 40 "$log" >&2
    exit 1
fi
