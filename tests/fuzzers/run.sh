#!/usr/bin/env bash
# Looks for inputs that make a reader fail: tests/fuzzers/run.sh [TARGET...], RUNS=1000000 inputs each, seeded; starts from corpora/ and from
# what build/fuzz/found has of earlier runs. Stops at a crash, at an error of a sanitizer, at 10 s or 1 GB for one input, which is then in
# build/fuzz/failed: mend it, and keep it in corpora/.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

tools/install_packages.sh tests/fuzzers/packages.txt
tools/build.sh fuzz sconce_fuzzers
targets=("$@")
[[ ${#targets[@]} -eq 0 ]] && targets=(exr field gltf image journal lights probes rays settings)
memory=$([[ -w /dev/shm ]] && echo /dev/shm || echo "${TMPDIR:-/tmp}") # a file an input
mkdir -p build/fuzz/failed
for target in "${targets[@]}"; do
    found=build/fuzz/found/$target
    dictionary=tests/fuzzers/$target.dict
    mkdir -p "$found"
    log=build/fuzz/$target.log
    TMPDIR=$memory ASAN_OPTIONS=detect_odr_violation=0 "build/fuzz/tests/fuzzers/sconce_fuzz_$target" "$found" "tests/fuzzers/corpora/$target" \
        -runs="${RUNS:-1000000}" -seed="${SEED:-1}" -max_len="${MAX_LEN:-16384}" -timeout=10 -rss_limit_mb=2048 -malloc_limit_mb=1024 \
        -artifact_prefix="build/fuzz/failed/$target-" -print_final_stats=1 $([[ -f $dictionary ]] && echo "-dict=$dictionary") > "$log" 2>&1 ||
        { tail -n 40 "$log" >&2; exit 1; }
    awk -v target="$target" '/^stat::number_of_executed_units/ {runs = $2} /^stat::average_exec_per_sec/ {rate = $2} /^stat::peak_rss_mb/ {peak = $2}
        / cov: / {for (i = 1; i < NF; ++i) if ($i == "cov:") edges = $(i + 1)}
        END {printf "%-9s %d inputs, %d a second, %d edges, %d MB at most, no failure\n", target, runs, rate, edges, peak}' "$log"
done
