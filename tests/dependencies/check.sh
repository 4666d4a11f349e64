#!/usr/bin/env bash
# check.sh PROGRAM COMPILER INCLUDE:INCLUDE:... SOURCE...: fails when the program or a header of the sources is a heavy library's.
set -euo pipefail

program=$1
compiler=$2
IFS=: read -r -a folders <<< "$3"
shift 3
heavy='openvdb|embree|tbb|tiny_?gltf'
failed=0

# Direct needs, as written into the file; then everything they need in turn, without the graphics driver that the loader opens later.
if readelf -d "$program" | grep -iE "NEEDED.*($heavy)"; then
    echo "$program is linked to a heavy library"
    failed=1
fi
if ldd "$program" | grep -iE "^[[:space:]]*[^ ]*($heavy)"; then
    echo "$program reaches a heavy library"
    failed=1
fi

includes=()
for folder in "${folders[@]}"; do [[ -n $folder ]] && includes+=("-I$folder"); done
for source in "$@"; do
    if ! headers=$("$compiler" -std=c++20 -M -MG "${includes[@]}" "$source"); then
        echo "cannot list the headers of $source"
        failed=1
    elif tr ' ' '\n' <<< "$headers" | grep -iE "($heavy)[^/]*(/|\\.h)"; then
        echo "$source includes a heavy library"
        failed=1
    fi
done
echo "checked 1 program and $# sources"
exit "$failed"
