#!/usr/bin/env bash
# guard_of_scene.sh SCONCE BASELINE FILE: checks a baseline whose source is FILE of the folder of real scenes; 77 where that is not there.
set -euo pipefail
sconce=$1 baseline=$2 file=$3
cd "${SCONCE_SCENES:-$SCONCE_SCENES_DEFAULT}" 2> /dev/null && [[ -f $file ]] || { echo "needs the scene $file, see SCONCE_SCENES"; exit 77; }
exec "$sconce" bench --check "$baseline"
