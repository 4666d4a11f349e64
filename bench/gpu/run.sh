#!/usr/bin/env bash
# Measures Sconce on this machine's GPU: run.sh [FILE, default gpu.json beside it], in at most ten minutes. Needs a Vulkan driver and the C library.
# First whether it is right here: no word of the validation layer, answers of the processor's and of the machine that packed the kit, pictures.
# Then times, at the clock that stands beside them. Exit 1 where something is wrong or missing; the file says what.
# Environment: VK_DRIVER_FILES where the loader finds no driver; SCONCE_GPU_SECONDS most seconds of one part [150]; SCONCE_GPU_SIZE of frames
# [1920x1080], SCONCE_GPU_LARGE of a larger one [3840x2160]; SCONCE_GPU_FRAMES timed [50]; SCONCE_GPU_WARM seconds before times are taken [2];
# SCONCE_GPU_LIST rays of a timed list [2097152]; SCONCE_GPU_PARTS a regular expression of the parts to measure [all].
set -uo pipefail
export LC_ALL=C # figures with a point
file=$(realpath -m "${1:-$(dirname "${BASH_SOURCE[0]}")/gpu.json}")
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 1
if [[ ! -d bin ]]; then # as it was unpacked: the rest is in an archive of its own
    LD_LIBRARY_PATH=$PWD ./xz -dc kit.tar.xz | tar xf - -C .. || exit 1
    exec ./run.sh "$file"
fi
most=${SCONCE_GPU_SECONDS:-150} size=${SCONCE_GPU_SIZE:-1920x1080} large=${SCONCE_GPU_LARGE:-3840x2160} frames=${SCONCE_GPU_FRAMES:-50} warm=${SCONCE_GPU_WARM:-2}
list=${SCONCE_GPU_LIST:-2097152}
export LD_LIBRARY_PATH=$PWD/lib VK_LAYER_PATH=$PWD/lib VK_ADD_LAYER_PATH=$PWD/lib
work=$(mktemp -d) judged=$(< expected/judged) wrong=()
./sample_clock.sh > "$work/clocks" 2> /dev/null &
clock=$!
trap 'kill $clock 2> /dev/null; rm -rf "$work"' EXIT

text() { tr -d '\000-\010\013\014\016-\037' < "$1" | sed -e 's/\\/\\\\/g' -e 's/"/\\"/g' -e 's/\t/ /g' | sed -e ':a' -e 'N' -e '$!ba' -e 's/\r*\n/\\n/g' | tail -c 2000; }

# part NAME COMMAND...: what it prints, JSON, under its name, with its seconds and the clock meanwhile; what it says where it fails. With may_lack=1 a
# device that has too little memory, or lacks an extension, is no fault.
part() {
    local name=$1 begin=$EPOCHREALTIME status=0
    shift
    [[ $name =~ ${SCONCE_GPU_PARTS:-} ]] || return
    echo "$name" >&2
    timeout "$most" bash -c '"$@"' part "$@" > "$work/out" 2> "$work/err" || status=$?
    local end=$EPOCHREALTIME
    local clocks
    clocks=$(awk -v b="$begin" -v e="$end" '$1 >= b && $1 <= e {print $2}' "$work/clocks" | sort -n | awk '{v[NR] = $1} END {if (NR) printf "[%d, %d, %d]", v[1], v[int((NR + 1) / 2)], v[NR]; else printf "null"}')
    {
        [[ -s $work/parts ]] && echo ","
        printf '"%s": {"seconds": %s, "clock_mhz": %s, "exit": %d, "result": ' "$name" "$(awk -v b="$begin" -v e="$end" 'BEGIN {printf "%.2f", e - b}')" "$clocks" $status
        if [[ $status -eq 0 && -s $work/out ]]; then cat "$work/out"; else echo null; fi
        [[ $status -eq 0 && ! -s $work/err ]] || printf ', "said": "%s"' "$(text "$work/err")"
        echo "}"
    } >> "$work/parts"
    if [[ $status -eq 4 && -n ${may_lack:-} ]]; then
        echo "  not on this device: $(tail -c 300 "$work/err")" >&2
    elif [[ $status -ne 0 ]]; then
        echo "  failed with exit $status: $(tail -c 300 "$work/err")" >&2
        wrong+=("$name")
    fi
    return $status
}
scene_of() { case $1 in Sponza) echo scenes/sponza/Sponza.gltf ;; modern_hall) echo scenes/modern_hall/modern_hall.glb ;; *) echo "$1" ;; esac; }
camera_of() { [[ $1 != modern_hall ]] || echo "--eye 5.59993,1.5,3.76821 --target 4.69671,1.50938,3.34018 --fov 75"; }

# The layer's words make a part fail.
validated() {
    SCONCE_VALIDATION=1 "$@" 2> "$work/layer" || { cat "$work/layer" >&2; return 1; }
    ! grep '^validation:' "$work/layer" >&2
}
# A picture as the packing machine has made it, but for rounding.
like_expected() {
    bin/sconce render cornell-glossy --field fields/cornell-glossy.sconce --size 320x320 --effects "$1" -o "$work/$1.exr" --aov beauty --quiet > /dev/null || return
    bin/sconce compare "$work/$1.exr" "expected/$1.exr" --metric relmse --fail-above relmse=1e-4 --json
}
# The shares of answers that are right, wrong and unresolved.
shares() { awk -F'[:,]' '/"(right_1|right_02|false|leak|unresolved)"/ {print $2}' "$1"; }
# Answers on the GPU, on the processor and where the kit was packed: more than one ray in a thousand that differs is a fault.
like_expected_rays() {
    bin/sconce_replay "rays/$1.rays" --field ours="fields/$1.sconce" --cpu --json > "$work/replay" || return
    cat "$work/replay"
    paste <(shares "$work/replay") <(shares "expected/$1.json") | awk '{apart = $1 - $2; if (apart * apart > 1e-6) wrong = 1} END {exit wrong || NR != 5}' ||
        { echo "shares of answers are not those of the machine that packed the kit, within a thousandth" >&2; return 1; }
    awk -F'[:,]' '/"rays"/ {rays = $2} /"cpu_differs"/ {differs = $2} END {exit !(differs * 1000 <= rays)}' "$work/replay" ||
        { echo "more than a thousandth of the rays has other answers than the processor gives" >&2; return 1; }
}

export work
export -f validated like_expected shares like_expected_rays

part doctor bin/sconce doctor --json
part validation validated bin/sconce render cornell-glossy --field fields/cornell-glossy.sconce --size 320x320 --effects all -o "$work/v.exr" --json --quiet
for rays in rays/*.rays; do
    name=$(basename "${rays%.rays}")
    part "rays_$name" like_expected_rays "$name"
done
part picture_auto like_expected auto
part picture_all like_expected all

octahedral=$work/octahedral.sconce
part bake_octahedral bin/sconce bake "$(scene_of "$judged")" --probes "fields/$judged.probes.json" --resolution 320 --chart octahedral --bounces 0 -o "$octahedral" --no-journal --json --quiet
# Lists that fill a large card several times over, each lane with several rays as the device has it, and with one.
# The maps of W' are octahedral, of as many texels a side as the faces that they are made of, to a power of two: 256, nearly ours' memory.
wang=$work/wang.sconce
part bake_wang bin/sconce bake "$(scene_of "$judged")" --probes "fields/$judged.probes.json" --resolution 512 --surface-texels 0 --bounces 0 -o "$wang" --no-journal --json --quiet
race=("rays/$judged.rays" --field ours="fields/$judged.sconce" --field b0plus-octree="$octahedral" --field wang="$wang" --timed "$list" --warm-up "$warm" --json)
part race bin/sconce_replay "${race[@]}" --runs 25
part race_plain env SCONCE_RAYS_A_LANE=1 bin/sconce_replay "${race[@]}" --runs 25
part race_cold bin/sconce_replay "${race[@]}" --runs 10 --cold 256
part bake_compact bin/sconce bake "$(scene_of "$judged")" --probes "fields/$judged.probes.json" --resolution 256 --compact --bounces 0 -o "$work/compact.sconce" --no-journal --json --quiet
part race_compact bin/sconce_replay "rays/$judged.rays" --field ours="fields/$judged.sconce" --field ours="$work/compact.sconce" --timed "$list" --runs 15 --warm-up "$warm" --json

# frames NAME SCENE FIELD OPTIONS...: milliseconds of each pass
frames() {
    local name=$1 scene=$2 field=$3
    shift 3
    # shellcheck disable=SC2046 # several words
    part "$name" bin/sconce render "$(scene_of "$scene")" $(camera_of "$scene") --field "$field" --size "$size" --frames "$frames" --warm-up "$warm" -o "$work/f.exr" --aov beauty "$@" --json --quiet
}
glossy=(--effects glossy --rays-below 2 --roughness 0.15)
frames "frame_$judged" "$judged" "fields/$judged.sconce"
frames "frame_all_$judged" "$judged" "fields/$judged.sconce" --effects all
frames "glossy_$judged" "$judged" "fields/$judged.sconce" "${glossy[@]}"
frames "glossy_b0plus_$judged" "$judged" "$octahedral" "${glossy[@]}" --tracer b0plus-octree
may_lack=1 size=$large frames "frame_4k_$judged" "$judged" "fields/$judged.sconce"
[[ $judged == cornell-glossy ]] || frames frame_cornell-glossy cornell-glossy fields/cornell-glossy.sconce
for scene in town modern_hall; do
    [[ -f fields/$scene.probes.json ]] || continue
    part "bake_$scene" bin/sconce bake "$(scene_of $scene)" --probes "fields/$scene.probes.json" --resolution 256 -o "$work/$scene.sconce" --no-journal --json --quiet &&
        frames "frame_$scene" "$scene" "$work/$scene.sconce"
done
may_lack=1 part passes bin/sconce_pass_statistics passes/*_comp.spv passes/trace_*_b0plus.spv --constant 0=4

{
    printf '{"kit": "%s",\n"size": "%s", "frames": %s, "warm_seconds": %s, "processor": "%s", "cores": %s,\n"wrong": [' "$(bin/sconce --version)" "$size" "$frames" "$warm" "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -1)" "$(nproc)"
    printf '"%s"\n' "${wrong[@]}" | grep -v '^""$' | paste -sd, -
    printf '],\n"parts": {\n'
    cat "$work/parts"
    printf '}}\n'
} > "$file"
echo "$file" >&2
[[ ${#wrong[@]} -eq 0 ]] || { echo "wrong: ${wrong[*]}" >&2; exit 1; }
