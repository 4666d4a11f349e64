#!/usr/bin/env bash
# All methods at their best over eight views, in one run a view: writes bench/results/scene_methods.json and scene_targets.json. What is measured already by
# the same build is not measured again, so an interrupted run goes on; about two and a half hours on 2 idle cores, and nothing else may run beside it.
# methods_table.sh [VIEW]... of cornell, mcguire, modern_hall, hall, sponza, temple, town, zdm2; without any all, and the files are written.
# Environment: SCONCE=the command, built when not given, RESOLUTION=texels of ours [192], SPP=paths a pixel of a reference's batches [1024; Sponza, whose methods differ by less, 8192], OUT=folder,
# whose measurements are kept [out/methods].
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} out=${OUT:-out/methods}
[[ -n ${SCONCE:-} ]] || tools/build.sh release sconce_command >&2
sconce=${SCONCE:-build/release/tools/sconce}
mkdir -p "$out"

arguments_of() {
    case $1 in
        cornell) echo cornell-glossy ;;
        mcguire) echo "$scenes/cornell_mcguire/cornell_glossy.glb --eye 0,1,3.2 --target 0,1,0 --fov 40 --probes 8" ;;
        modern_hall) echo "$scenes/modern_hall/modern_hall.glb" ;;
        sponza) echo "$scenes/sponza/Sponza.gltf" ;;
        zdm2) echo "$scenes/map_zdm2/zdm2.glb --sun 0.4,-1,0.3 --sky 0.6,0.8,1.0 --eye=-25.8236,6.66473,7.10483 --target=-24.8655,6.69911,7.36739 --fov 75" ;;
        hall | temple | town) echo "$1" ;;
        *) echo "methods_table.sh: there is no view '$1'; see its head" >&2 && return 2 ;;
    esac
}

views=("$@")
[[ ${#views[@]} -gt 0 ]] || views=(cornell mcguire modern_hall hall sponza temple town zdm2)
for view in "${views[@]}"; do
    line=$(arguments_of "$view")
    read -ra arguments <<< "$line"
    paths=1024
    [[ $view != sponza ]] || paths=8192
    "$sconce" bench "${arguments[@]}" --methods-only --resolution "${RESOLUTION:-192}" --spp "${SPP:-$paths}" --quiet -o "$out/$view" > /dev/null
    echo "$view: measured" >&2
done
[[ $# -eq 0 ]] || exit 0
files=("${views[@]/#/$out/}")
python3 bench/pages/bench_rows.py methods "${files[@]/%//results.json}"
