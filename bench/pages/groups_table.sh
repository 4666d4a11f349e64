#!/usr/bin/env bash
# Light groups: a field whose lights are switched against a fresh bake of the scene in that light, both against the path tracer. Prints the rows of
# bench/results/light_groups.json, and writes pictures of some states, ours, the truth and the error, to $OUT/strip.png.
# groups_table.sh [SCENE=COUNT [hall=24]]. Environment: SCONCE=the command, built when not given, SIZE=WxH of the pictures [320x180], SPP=paths a
# pixel [512], RESOLUTION=texels [256], EXPOSURE=factor of the pictures [1], OUT=folder [out/groups].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
entry=${1:-hall=24} out=${OUT:-out/groups} size=${SIZE:-320x180} spp=${SPP:-512} resolution=${RESOLUTION:-256} exposure=${EXPOSURE:-1}
scene=${entry%%=*} count=${entry#*=}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
at=$out/$scene
case $scene in # the groups, and what is switched off in each state
    hall) groups=(--group "warm=warm panel" --group "cool=cool lamp" --group "amber=amber lamp") states=(none warm cool amber warm,cool warm,amber cool,amber) shown=(none warm cool,amber) ;;
    *) groups=(--group sun --group sky --group lamps=emitters) states=(none sun sky lamps sun,sky sun,lamps sky,lamps) shown=(none lamps sun sun,sky) ;;
esac
compare() { "$sconce" compare "$1" "$2" --layer "$3" --same-surface --metric relmse,flip,mean --json; }

"$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
"$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --bounces 8 "${groups[@]}" -o "$at.sconce" --json --quiet > "$at.bake.json"
for state in "${states[@]}"; do
    dims=(--dim "${states[1]}=1")
    [[ $state == none ]] || dims=()
    for group in ${state//,/ }; do [[ $group == none ]] || dims+=(--dim "$group=0"); done
    view=$at.${state//,/_}
    [[ -f $view.ref.exr ]] || "$sconce" reference "$scene" "${groups[@]}" "${dims[@]}" --size "$size" --spp "$spp" --bounces 8 --pixel-centre -o "$view.ref.exr" --quiet > /dev/null
    "$sconce" render "$scene" --field "$at.sconce" "${dims[@]}" --size "$size" -o "$view.switched.exr" --json --quiet > "$view.switched.json"
    "$sconce" bake "$scene" --probes "$at.probes.json" --resolution "$resolution" --bounces 8 "${groups[@]}" "${dims[@]}" -o "$at.fresh.sconce" --json --quiet > "$view.fresh.bake.json"
    "$sconce" render "$scene" --field "$at.fresh.sconce" "${groups[@]}" "${dims[@]}" --size "$size" -o "$view.fresh.exr" --quiet > /dev/null
    for way in switched fresh; do
        compare "$view.$way.exr" "$view.ref.exr" diffuse_indirect > "$view.$way.diffuse.json"
        compare "$view.$way.exr" "$view.ref.exr" beauty > "$view.$way.beauty.json"
    done
    "$sconce" compare "$view.switched.exr" "$view.ref.exr" --layer beauty --same-surface --exposure "$exposure" --side-by-side "$view.png" --quiet > /dev/null
    python3 - "$at" "$view" "$state" << 'P'
import json, sys
at, view, state = sys.argv[1:]
load = lambda file: json.load(open(f"{file}.json"))
bake = load(f"{at}.bake")
row = {"label": f"{at.split('/')[-1]}: all on" if state == "none" else f"{at.split('/')[-1]}: {state.replace(',', ' and ')} off"}
for way in ("switched", "fresh"):
    diffuse, beauty = load(f"{view}.{way}.diffuse"), load(f"{view}.{way}.beauty")
    row |= {f"{way}_relmse": f"{diffuse['relmse']:.4f}", f"{way}_flip": f"{diffuse['flip']:.3f}", f"{way}_mean": f"{diffuse['mean']:.3f}", f"{way}_picture_flip": f"{beauty['flip']:.3f}"}
row["relmse_ratio"] = f"{load(f'{view}.switched.diffuse')['relmse'] / load(f'{view}.fresh.diffuse')['relmse']:.2f}"
row["mix_ms"] = f"{load(f'{view}.switched')['light_groups_ms']:.0f}"
row["bake_s"], row["fresh_bake_s"] = f"{bake['seconds']:.0f}", f"{load(f'{view}.fresh.bake')['seconds']:.0f}"
groups = len(bake["light_groups"])
row["kib_group"] = f"{bake['bytes']['light_groups'] / groups / bake['probes'] / 1024:.0f}"
print(f'  "{at.split("/")[-1]}_{state.replace(",", "_")}": {json.dumps(row)},')
P
done
pictures=()
for state in "${shown[@]}"; do pictures+=("$at.${state//,/_}.png"); done
bench/pages/sheet.py "$out/strip.png" 1 "${pictures[@]}"
