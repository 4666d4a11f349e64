#!/usr/bin/env bash
# Installs what is missing, builds, and measures what accuracy costs: bench/run.sh [--full] [SCENE...] [options of `sconce bench`].
# Without scenes: cornell-glossy with maps of 192 texels, about 20 minutes on 2 cores. --full: every built-in scene and every scene of the
# folder SCONCE_SCENES [../shared/scenes] at full resolution, for hours; what is measured already is kept, so it can be interrupted.
# Results: out/bench/{report/index.html,results.json,results.csv}, or where -o says.
set -euo pipefail
start=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."
root=$PWD

tools/install_packages.sh
tools/build.sh release sconce_command

arguments=("$@")
if [[ ${1:-} == --full ]]; then
    mapfile -t files < <(find "${SCONCE_SCENES:-$root/../shared/scenes}" \( -name '*.gltf' -o -name '*.glb' \) -not -path '*/gltf_oddities/*' 2> /dev/null | sort)
    arguments=(cornell-glossy temple hall town "${files[@]}" "${@:2}")
elif [[ $# -eq 0 || $1 == -* ]]; then
    arguments=(cornell-glossy "$@")
    case " $* " in *" --resolution"[\ =]*) ;; *) arguments+=(--resolution 192) ;; esac
fi
case " ${arguments[*]} " in *" -o "* | *" --output "*) ;; *) arguments+=(-o "$root/out/bench") ;; esac
cd "$start"
exec "$root/build/release/tools/sconce" bench "${arguments[@]}"
