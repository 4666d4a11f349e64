#!/usr/bin/env bash
# Packs what a machine with a GPU and its driver, and nothing else, needs to be measured: bench/gpu/bundle.sh [FILE, default out/gpu/sconce-gpu-kit.tar]
# Programs with their libraries, passes, scenes, light fields with faces of 128 texels, rays with their truth, and pictures and shares that this
# machine's device has made of them. There: tar xf sconce-gpu-kit.tar && sconce-gpu-kit/run.sh
# Environment: SCONCE_SCENES [../shared/scenes], where sponza and modern_hall are taken from; without them the kit has the built-in scenes alone.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
scenes=${SCONCE_SCENES:-../shared/scenes} file=${1:-out/gpu/sconce-gpu-kit.tar}
for tool in xz:xz-utils strip:binutils; do
    command -v "${tool%:*}" > /dev/null || { echo "bench/gpu/bundle.sh needs ${tool%:*}; install ${tool#*:}" >&2; exit 2; }
done
most=$((60 * 1000 * 1000)) # bytes of the kit
made=out/gpu/made kit=out/gpu/sconce-gpu-kit
tools/build.sh release sconce_command sconce_replay sconce_ray_accuracy sconce_pass_statistics >&2
build=build/release
ninja -C "$build" -t cleandead > /dev/null # passes that are no longer in the tree
sconce=$build/tools/sconce accuracy=$build/bench/race/sconce_ray_accuracy replay=$build/bench/race/sconce_replay
rm -rf "$kit"
mkdir -p "$made" "$kit"/{bin,lib,passes,fields,rays,scenes,expected}

# Programs, their libraries but the C library's own, which the driver shares, and the validation layer.
for program in "$sconce" "$replay" "$build/bench/gpu/sconce_pass_statistics"; do strip -o "$kit/bin/$(basename "$program")" "$program"; done
layer=$(find /usr/lib/*-linux-gnu /usr/local/lib -name libVkLayer_khronos_validation.so | head -1) # the one of the package, not of a browser
cp "$layer" "$kit/lib/"
sed 's#"library_path": *"[^"]*"#"library_path": "./libVkLayer_khronos_validation.so"#' /usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json > "$kit/lib/VkLayer_khronos_validation.json"
ldd "$kit"/bin/* "$layer" | awk '/=> \//{print $3}' | sort -u | grep -vE '/(libc|libm|libdl|libpthread|librt)\.so' | xargs -I{} cp -L {} "$kit/lib/"
find "$build/shaders" -name '*.spv' -exec cp -t "$kit/passes" {} +

# field NAME SCENE COUNT: probes and light field with faces of 128 texels; kept for the next time
field() {
    local at=$made/$1
    [[ -f $at.sconce ]] && return
    "$sconce" place "$2" --count "$3" -o "$at.probes.json" --quiet > /dev/null
    "$sconce" bake "$2" --probes "$at.probes.json" --resolution 256 -o "$at.sconce" --quiet > /dev/null
}
field cornell-glossy cornell-glossy 8
cp "$made/cornell-glossy.sconce" "$kit/fields/"
"$sconce" place town --count 24 -o "$kit/fields/town.probes.json" --quiet > /dev/null # baked there
judged=cornell-glossy judged_scene=cornell-glossy
if [[ -f $scenes/sponza/Sponza.gltf ]]; then
    cp -r "$scenes"/{sponza,modern_hall} "$kit/scenes/"
    field Sponza "$scenes/sponza/Sponza.gltf" 32
    cp "$made/Sponza.sconce" "$kit/fields/"
    "$sconce" place "$scenes/modern_hall/modern_hall.glb" --count 24 -o "$kit/fields/modern_hall.probes.json" --quiet > /dev/null
    judged=Sponza judged_scene=$scenes/sponza/Sponza.gltf
fi
cp "$made/$judged.probes.json" "$kit/fields/"
# Rays of one camera's picture, which is what a frame traces, and what tracers make of them here: a GPU has to agree.
"$accuracy" "$judged_scene" --camera 0 --rays 100000 --record "$kit/rays/$judged.rays" --field ours="$made/$judged.sconce" --json > "$kit/expected/$judged.json"
[[ $judged == cornell-glossy ]] || "$accuracy" cornell-glossy --camera 0 --rays 20000 --record "$kit/rays/cornell-glossy.rays" --field ours="$made/cornell-glossy.sconce" --json > "$kit/expected/cornell-glossy.json"
for effects in auto all; do
    "$sconce" render cornell-glossy --field "$made/cornell-glossy.sconce" --size 320x320 --effects $effects -o "$kit/expected/$effects.exr" --aov beauty --quiet > /dev/null
done
echo "$judged" > "$kit/expected/judged"
cp bench/gpu/run.sh bench/gpu/sample_clock.sh "$kit/"

# An outer archive that tar alone unpacks, an inner one with the xz that unpacks it.
outer=out/gpu/outer/sconce-gpu-kit
rm -rf out/gpu/outer
mkdir -p "$outer" "$(dirname "$file")"
tar cf - -C out/gpu sconce-gpu-kit | xz -T0 -7 > "$outer/kit.tar.xz"
cp bench/gpu/run.sh "$outer/"
cp -L "$(command -v xz)" "$outer/xz"
ldd "$(command -v xz)" | awk '/liblzma/{print $3}' | xargs -I{} cp -L {} "$outer/"
tar cf "$file" -C out/gpu/outer sconce-gpu-kit
bytes=$(stat -c %s "$file")
((bytes <= most)) || { echo "$file takes $bytes bytes, more than the $most that a kit may: fewer probes or rays, see bench/gpu/bundle.sh" >&2; exit 1; }
echo "$file, $bytes bytes"
