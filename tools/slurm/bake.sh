#!/usr/bin/env bash
# A light field as jobs of Slurm, to the bytes of one bake: place, then an array of shards for the probes' maps, one for what is gathered, and merge.
#
# tools/slurm/bake.sh SCENE -o FIELD [--shards N] [--probes FILE] [--place OPTIONS] [--bake OPTIONS] [--sbatch OPTIONS] [--wait]
#   --shards   tasks of each array (default: 8); more than probes is of no use
#   --probes   probes that are placed already; no job places any
#   --place, --bake, --sbatch   words that `sconce place`, `sconce bake` and every sbatch get besides, such as "--count 96", "--gpus-per-task=1"
#   --wait     ends when the field is there; exits as its last job does
#
# Run it in a folder that all nodes share, of nodes with one build and one kind of device. Parts and logs are in FIELD.parts, which the last job
# removes. Slurm runs a task of a node that died again, and the shard goes on from what its part file has. SCONCE names the program (default: sconce).
set -euo pipefail

usage() { sed -n '4,9s/^# \{0,1\}//p' "${BASH_SOURCE[0]}" >&2; exit 2; }
scene='' field='' shards=8 probes='' wait='' place=() bake=() options=()
while [[ $# -gt 0 ]]; do
    case $1 in
        -o) field=${2:?"-o needs a file"}; shift ;;
        --shards) shards=${2:?"--shards needs a number"}; shift ;;
        --probes) probes=${2:?"--probes needs a file"}; shift ;;
        --place) read -ra place <<< "${2?"--place needs options"}"; shift ;;
        --bake) read -ra bake <<< "${2?"--bake needs options"}"; shift ;;
        --sbatch) read -ra options <<< "${2?"--sbatch needs options"}"; shift ;;
        --wait) wait=--wait ;;
        -*) echo "slurm/bake.sh: there is no option $1" >&2; usage ;;
        *) [[ -z $scene ]] || usage; scene=$1 ;;
    esac
    shift
done
[[ -n $scene && -n $field && $shards =~ ^[1-9][0-9]*$ ]] || usage
command -v sbatch > /dev/null || { echo "slurm/bake.sh: there is no sbatch; install Slurm's client, or run \`sconce bake\`" >&2; exit 2; }

parts=$field.parts
mkdir -p "$parts"
# submit NAME DEPENDENCY SBATCH-OPTION... -- WORD...: a job of one command; its number. Each word is quoted, but @TASK@ in it is the task's number.
submit()
{
    local name=$1 after=$2 own=() line
    shift 2
    while [[ $1 != -- ]]; do own+=("$1"); shift; done
    shift
    printf -v line '%q ' "$@"
    sbatch --parsable --requeue --kill-on-invalid-dep=yes --job-name="sconce-$name" --output="$parts/$name.%a.log" ${after:+--dependency=afterok:$after} \
        ${options[@]+"${options[@]}"} ${own[@]+"${own[@]}"} --wrap "exec ${line//@TASK@/\$SLURM_ARRAY_TASK_ID}"
}

sconce=${SCONCE:-sconce}
array=--array=0-$((shards - 1))
first=''
if [[ -z $probes ]]; then
    probes=$parts/probes.json
    first=$(submit place '' -- "$sconce" place "$scene" ${place[@]+"${place[@]}"} -q -o "$probes")
fi
maps=() light=()
for ((i = 0; i < shards; ++i)); do maps+=("$parts/maps.$i"); light+=("$parts/light.$i"); done
shard=("$sconce" bake "$scene" --probes "$probes" ${bake[@]+"${bake[@]}"} -q --shard "@TASK@/$shards")
seen=$(submit maps "$first" "$array" -- "${shard[@]}" -o "$parts/maps.@TASK@")
gathered=$(submit light "$seen" "$array" -- "${shard[@]}" --after "${maps[@]}" -o "$parts/light.@TASK@")
# Only the last job's end says that all is done; then nobody needs the parts. To wait for a job that never runs, since one before it failed, is no error.
merge=("$sconce" merge "${maps[@]}" "${light[@]}" -q -o "$field")
submit merge "$gathered" $wait -- bash -c "$(printf '%q ' "${merge[@]}") && rm -r $(printf '%q' "$parts")"
if [[ -n $wait && -d $parts ]]; then
    echo "slurm/bake.sh: a job failed; its log is in $parts, and the same command goes on from there" >&2
    exit 1
fi
