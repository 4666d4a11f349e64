#!/usr/bin/env python3
"""What a real GPU's compiler makes of every compute pass, without the GPU: registers, subgroups in flight, instructions, spills.

pass_guard.py PROGRAM BUILD GUARD [--write]

RADV compiles for a GPU that isn't there (RADV_FORCE_FAMILY). PROGRAM is sconce_pass_statistics, BUILD the build's folder, GUARD the file of what
was found before. Fails where a pass takes more registers, over 3 % more instructions, spills more, or isn't in the file; another version of the driver
makes other code, and is skipped. (The octree's ranking has arrays of its own, which count as spilled.) --write keeps what is found now.
"""
import itertools
import json
import os
import pathlib
import subprocess
import sys

FAMILY = "NAVI21"
BALLOTS = {"trace_rays_refilled_comp"}  # ask their subgroup: RADV gives them the 64 lanes that it reports, whatever is wished
SUBGROUPS = {"32": "cswave32", "64": "cs64"}  # lanes, and what RADV_PERFTEST has to say
MORE_INSTRUCTIONS = 1.03
SKIPPED = 77
TRACE = {"trace_glossy_comp", "trace_rays_comp"}
# What a field is, as kFieldFlagsId says it, and the passes that are compiled for it; none: all.
FORMS = {
    "": ("0=4", set()),  # kByTexels: words come through texel buffers
    ", picture": ("0=4,32=1", {"trace_glossy_comp"}),  # and kScreenId
    ", compact": ("0=516", TRACE | {"surface_light_comp", "gather_light_comp"}),  # and kMapsInBlocks
}


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def radv():
    for folder in ("/usr/share/vulkan/icd.d", "/usr/local/share/vulkan/icd.d", "/etc/vulkan/icd.d"):
        for file in sorted(pathlib.Path(folder).glob("radeon_icd*.json")):
            return str(file)
    return skip("no RADV on this machine; mesa-vulkan-drivers has it")


def found_now(program, build):
    files = sorted(str(file) for file in pathlib.Path(build, "shaders").rglob("*_comp.spv"))
    if not files:
        sys.exit(f"no passes under {build}/shaders: build first")
    found, driver = {}, ""
    for (lanes, wish), (form, (flags, only)) in itertools.product(SUBGROUPS.items(), FORMS.items()):
        chosen = [file for file in files if not only or pathlib.Path(file).stem in only]
        environment = os.environ | {"VK_ICD_FILENAMES": radv(), "VK_DRIVER_FILES": radv(), "RADV_FORCE_FAMILY": FAMILY, "RADV_PERFTEST": wish}
        environment.pop("SCONCE_VALIDATION", None)  # nothing runs
        done = subprocess.run([program, *chosen, *(word for flag in flags.split(",") for word in ("--constant", flag))], env=environment, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            sys.exit(f"{pathlib.Path(program).name} gave {done.returncode}: {done.stderr}")
        answer = json.loads(done.stdout)
        driver = f"{answer['device']}, {answer['driver']}"
        for one in answer["passes"]:
            statistics = one["statistics"]
            if lanes == "32" and one["pass"] in BALLOTS:
                continue
            if str(statistics["subgroup_size"]) != lanes:
                sys.exit(f"{one['pass']} was compiled for {statistics['subgroup_size']} lanes, not {lanes}")
            found.setdefault(one["pass"] + form, {})[lanes] = {
                "registers": statistics["VGPRs"],
                "spilled": statistics["Spilled VGPRs"] + statistics["Spilled SGPRs"] + statistics["Scratch size"],
                "instructions": statistics["Instructions"],
                "bytes": statistics["Code size"],
                "subgroups": statistics["Subgroups per SIMD"],
            }
    return {"driver": driver, "passes": found}


def faults(kept, found):
    for name in sorted(kept["passes"].keys() - found["passes"].keys()):
        yield f"{name} is in the file and no pass any more"
    for name, by_lanes in sorted(found["passes"].items()):
        for lanes, now in by_lanes.items():
            before = kept["passes"].get(name, {}).get(lanes)
            if before is None:
                yield f"{name} is not in the file"
                continue
            if now["spilled"] > before["spilled"]:
                yield f"{name} spills {now['spilled']} at {lanes} lanes, {before['spilled']} before"
            if now["registers"] > before["registers"]:
                yield f"{name} takes {now['registers']} registers at {lanes} lanes, {before['registers']} before"
            if now["instructions"] > MORE_INSTRUCTIONS * before["instructions"]:
                yield f"{name} has {now['instructions']} instructions at {lanes} lanes, {before['instructions']} before"


def main():
    program, build, guard = sys.argv[1:4]
    found = found_now(program, build)
    if not TRACE <= found["passes"].keys():
        sys.exit(f"the passes that trace are missing: {sorted(found['passes'])}")
    if "--write" in sys.argv:
        rows = ",\n".join(f" {json.dumps(name)}: {json.dumps(found['passes'][name])}" for name in sorted(found["passes"]))
        pathlib.Path(guard).write_text(f'{{"driver": {json.dumps(found["driver"])},\n"passes": {{\n{rows}\n}}}}\n', encoding="utf-8")
        return
    kept = json.loads(pathlib.Path(guard).read_text(encoding="utf-8"))
    if kept["driver"] != found["driver"]:
        skip(f"the file is of {kept['driver']}, this machine has {found['driver']}; --write makes it anew")
    wrong = list(faults(kept, found))
    if wrong:
        sys.exit("\n".join(wrong) + f"\nWhere that is worth it: {' '.join(sys.argv)} --write")
    print(f"{len(found['passes'])} passes as before, {kept['driver']}")


if __name__ == "__main__":
    main()
