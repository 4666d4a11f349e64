#!/usr/bin/env bash
# What must not change when code is only moved: hashes of fields, hits, frames and references of four built-in scenes.
# tests/hashes.sh SCONCE [SCENE...]; SCONCE is the command's path, e.g. build/release/tools/sconce. A line each: scene, what, the first 16
# digits of its sha256; "failed" where the command did. Compare two builds on one machine and device: tests/hashes.sh OLD > a; tests/hashes.sh NEW > b;
# diff a b. No test: other devices and compilers round in other ways. Cost: some minutes on two cores without a GPU.
set -euo pipefail

[[ $# -ge 1 && -x $1 ]] || { sed -n '2,5s/^# //p' "$0" >&2; exit 2; }
sconce=$(realpath "$1")
shift
scenes=("$@")
[[ ${#scenes[@]} -eq 0 ]] && scenes=(cornell-glossy temple hall town)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# 20,000 rays from everywhere in the scenes' middle, the same every time.
python3 - > rays.csv <<'PYTHON'
import random
random.seed(7)
print("ox,oy,oz,dx,dy,dz")
for ray in range(20000):
    numbers = [random.uniform(-8, 8), random.uniform(0.1, 4), random.uniform(-8, 8)] + [random.gauss(0, 1) for axis in range(3)]
    print(",".join("%.6f" % number for number in numbers))
PYTHON

# hash WHAT FILE COMMAND...: runs the command, which writes the file, and prints the file's hash.
hash() {
    local what=$1 file=$2
    shift 2
    rm -f "$file"
    if "$sconce" "$@" -q > /dev/null 2> error.txt; then
        echo "$scene $what $(sha256sum < "$file" | cut -c1-16)"
    else
        echo "$scene $what failed: $(tail -1 error.txt)"
    fi
}

for scene in "${scenes[@]}"; do
    hash "probes" placed.json place "$scene" -o placed.json --count 8 --seed 1
    hash "field" ours.sconce bake "$scene" --probes placed.json -o ours.sconce --resolution 192 --bounces 2
    hash "octahedral field" placed.sconce bake "$scene" --probes placed.json -o placed.sconce --resolution 128 --bounces 0 --chart octahedral

    # The opponents trace on a uniform grid, wang's maps are made from cube faces.
    hash "grid" grid.json place "$scene" -o grid.json --method grid --grid 2x2x2
    hash "octahedral grid field" octahedral.sconce bake "$scene" --probes grid.json -o octahedral.sconce --resolution 128 --bounces 0 --chart octahedral
    hash "grid field" cube.sconce bake "$scene" --probes grid.json -o cube.sconce --resolution 128 --bounces 0

    hash "hits of ours" hits.csv trace ours.sconce --rays rays.csv -o hits.csv
    hash "hits of the CPU" hits.csv trace ours.sconce --rays rays.csv -o hits.csv --cpu
    for tracer in b0 b0plus b0plus-octree; do
        hash "hits of $tracer" hits.csv trace octahedral.sconce --rays rays.csv -o hits.csv --tracer "$tracer"
    done
    hash "hits of wang" hits.csv trace cube.sconce --rays rays.csv -o hits.csv --tracer wang

    frame=(render "$scene" --field ours.sconce -o frame.exr --size 160x90)
    hash "frame" frame.exr "${frame[@]}"
    hash "frame with traced diffuse light" frame.exr "${frame[@]}" --diffuse traced --temporal --frames 3 --samples 2
    hash "frame by patches" frame.exr "${frame[@]}" --diffuse patches --area-shadows field --trace-every 4
    hash "reference" frame.exr reference "$scene" -o frame.exr --size 80x45 --spp 8
done
