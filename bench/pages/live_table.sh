#!/usr/bin/env bash
# Lights that move: a field that is relit by another sun against a fresh, static bake under that sun, both against the path tracer. Prints the rows
# of bench/results/live_light.json, and writes pictures under each sun, ours, the truth and the error, to $OUT/SCENE.png.
# live_table.sh SCENE=COUNT X,Y,Z... with a scene's name or file and the ways that the suns' light travels. Environment: SCONCE=the command, built
# when not given, SIZE=WxH of the pictures [320x180], SPP=paths a pixel [256], RESOLUTION=texels [256], LINKS=live links a texel [16],
# EXPOSURE=factor of the pictures [1], SKY=R,G,B of all pictures and
# bakes, which a scene without light of its own needs beside a sun, OUT=folder [out/live].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
entry=$1 out=${OUT:-out/live} size=${SIZE:-320x180} spp=${SPP:-256} resolution=${RESOLUTION:-256} links=${LINKS:-16} exposure=${EXPOSURE:-1}
shift
scene=${entry%%=*} count=${entry#*=} name=$(basename "${entry%%=*}" | sed 's/\..*//')
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"
at=$out/$name
sky=(${SKY:+--sky "$SKY"})
compare() { "$sconce" compare "$1" "$2" --layer "$3" --same-surface --metric relmse,flip,mean --json; }

[[ -f $at.probes.json ]] || "$sconce" place "$scene" --count "$count" -o "$at.probes.json" --quiet > /dev/null
[[ -f $at.$links.sconce ]] ||
    "$sconce" bake "$scene" "${sky[@]}" --probes "$at.probes.json" --resolution "$resolution" --live-links "$links" -o "$at.$links.sconce" --json --quiet > "$at.$links.bake.json"
pictures=() number=0
for sun; do
    number=$((number + 1))
    view=$at.$number
    [[ -f $view.ref.exr ]] || "$sconce" reference "$scene" "${sky[@]}" --sun="$sun" --size "$size" --spp "$spp" --pixel-centre -o "$view.ref.exr" --quiet > /dev/null
    [[ -f $view.fresh.exr ]] || {
        "$sconce" bake "$scene" "${sky[@]}" --probes "$at.probes.json" --resolution "$resolution" --sun="$sun" -o "$at.fresh.sconce" --json --quiet > "$view.fresh.bake.json"
        "$sconce" render "$scene" "${sky[@]}" --field "$at.fresh.sconce" --sun="$sun" --size "$size" -o "$view.fresh.exr" --quiet > /dev/null
        rm "$at.fresh.sconce"
    }
    "$sconce" render "$scene" "${sky[@]}" --field "$at.$links.sconce" --sun="$sun" --size "$size" -o "$view.relit.exr" --json --quiet > "$view.relit.json"
    for way in relit fresh; do
        for layer in diffuse_indirect glossy_indirect beauty; do compare "$view.$way.exr" "$view.ref.exr" $layer > "$view.$way.$layer.json"; done
    done
    "$sconce" compare "$view.relit.exr" "$view.ref.exr" --layer beauty --same-surface --exposure "$exposure" --side-by-side "$view.png" --quiet > /dev/null
    pictures+=("$view.png")
    python3 - "$at" "$view" "$links" "$sun" << 'P'
import json, sys
at, view, links, sun = sys.argv[1:]
load = lambda file: json.load(open(f"{file}.json"))
bake, name = load(f"{at}.{links}.bake"), at.split("/")[-1]
row = {"label": f"{name}, sun {sun.replace(',', ' ')}"}
ratio = {}
for layer, called in (("diffuse_indirect", "diffuse"), ("glossy_indirect", "glossy"), ("beauty", "picture")):
    relit, fresh = load(f"{view}.relit.{layer}"), load(f"{view}.fresh.{layer}")
    for way, of in (("relit", relit), ("fresh", fresh)):
        row |= {f"{way}_{called}_relmse": f"{of['relmse']:.4f}", f"{way}_{called}_flip": f"{of['flip']:.3f}", f"{way}_{called}_mean": f"{of['mean']:.3f}"}
    row[f"{called}_ratio"] = f"{relit['relmse'] / fresh['relmse']:.2f}"
row["bake_s"], row["fresh_bake_s"] = f"{bake['seconds']:.0f}", f"{load(f'{view}.fresh.bake')['seconds']:.0f}"
row["live_device_kib"] = f"{load(f'{view}.relit')['live_device_bytes'] / bake['probes'] / 1024:.0f}"
row["live_kib"] = f"{bake['bytes']['live'] / bake['probes'] / 1024:.0f}"
for key, ms in load(f"{view}.relit")["live_light_ms"].items(): row[f"ms_{key.split()[-1]}"] = f"{ms:.0f}"
print(f'  "{name}_{view.split(".")[-1]}": {json.dumps(row)},', flush=True)
P
done
bench/pages/sheet.py "$at.png" 1 "${pictures[@]}"
