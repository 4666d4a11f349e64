#!/usr/bin/env bash
# What placed probes see, beside plain greedy cover and the grid that sees most, and how long placing takes, on samples that no placement used.
# Writes bench/results/placement_coverage.json; a quarter of an hour on 2 cores.
# Environment: TABLE=sconce_placement_table, built when not given, SCONCE_SCENES [../shared/scenes], OUT=folder [out/coverage].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/coverage}
[[ -n ${TABLE:-} ]] || tools/build.sh release sconce_placement_table >&2
table=${TABLE:-build/release/tests/placement/sconce_placement_table}
mkdir -p "$out"
# a scene's name, its file, and counts of probes, each with the share of ray hits that is asked
while read -r name file counts; do
    [[ ! -f $scenes/$file ]] || file=$scenes/$file
    for entry in $counts; do
        count=${entry%%=*}
        "$table" "$file" "$count" --rows bound,yardstick,grid,gradient < /dev/null > "$out/$name.$count.txt"
        python3 bench/pages/bench_rows.py covered "$out/$name.$count.txt" "$name" "$count" "${entry#*=}"
    done
done << 'SCENES' | tee "$out/rows.txt"
cornell_original cornell_mcguire/cornell_original.glb 7=99.99
modern_hall modern_hall/modern_hall.glb 16=99.96 50=
temple temple 16=99.9
gas_station gas_station/GasStation.gltf 54=99.6
map_alphacorp map_alphacorp/alphacorp.glb 54=99.6 128=99.85
map_zdm2 map_zdm2/zdm2.glb 54=98.5 128=99.4
san_miguel san_miguel/san_miguel.glb 128=98 256=99
sponza sponza/Sponza.gltf 32=99.6 54=99.8
SCENES
python3 bench/pages/bench_rows.py coverage "$out/rows.txt"
