#!/usr/bin/env bash
# Every fifth of a second: time in seconds, clock of the GPU in MHz as its driver says it, or nothing where none does. Until it is ended.
card=$(compgen -G '/sys/class/drm/card*/device/pp_dpm_sclk' | head -1) intel=$(compgen -G '/sys/class/drm/card*/gt_act_freq_mhz' | head -1)
while sleep 0.2; do
    if command -v nvidia-smi > /dev/null; then
        clock=$(nvidia-smi --query-gpu=clocks.sm --format=csv,noheader,nounits 2> /dev/null | head -1)
    elif [[ -n $card ]]; then
        clock=$(sed -n 's/^[0-9]*: *\([0-9]*\)Mhz \*$/\1/p' "$card")
    elif [[ -n $intel ]]; then
        clock=$(< "$intel")
    else
        exit 0
    fi
    [[ $clock =~ ^[0-9]+$ ]] && echo "$EPOCHREALTIME $clock"
done
