#!/usr/bin/env python3
"""A kit for a GPU (bench/gpu/run.sh), small and made by hand, runs from its first part to its last on this machine's device.

kit_test.py SOURCES COMMAND REPLAY RAY_ACCURACY PASS_STATISTICS BUILD

What it measures is read back by `sconce bench --gpu`'s reader elsewhere; here every part has its result, and one that is wrong makes the run fail.
"""
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

LAYERS = "/usr/share/vulkan/explicit_layer.d/VkLayer_khronos_validation.json"
FREE = {"frame_4k_cornell-glossy", "passes"}  # a device may have too little memory for the one, no statistics for the other


def run(*arguments, **more):
    done = subprocess.run([str(one) for one in arguments], capture_output=True, text=True, check=False, **more)
    if done.returncode != 0:
        sys.exit(f"{' '.join(map(str, arguments))} gave {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-2000:]}")
    return done.stdout


def make_kit(kit, sources, command, replay, ray_accuracy, pass_statistics, build):
    for name in ("bin", "lib", "passes", "fields", "rays", "scenes", "expected"):
        (kit / name).mkdir(parents=True)
    for program in (command, replay, pass_statistics):
        (kit / "bin" / pathlib.Path(program).name).symlink_to(pathlib.Path(program).resolve())
    shutil.copy(LAYERS, kit / "lib")
    for name in ("trace_rays_comp", "trace_glossy_comp"):
        shutil.copy(pathlib.Path(build, "shaders/spirv", name + ".spv"), kit / "passes")
    shutil.copy(pathlib.Path(build, "shaders/opponents/spirv/trace_rays_b0plus.spv"), kit / "passes")
    for script in ("run.sh", "sample_clock.sh"):
        shutil.copy(pathlib.Path(sources, "bench/gpu", script), kit)
    probes, field = kit / "fields/cornell-glossy.probes.json", kit / "fields/cornell-glossy.sconce"
    probes.write_text(json.dumps({"probes": [{"position": place} for place in ([0, 1.5, 0.5], [-0.8, 0.5, 0.6])]}), encoding="utf-8")
    run(command, "bake", "cornell-glossy", "--probes", probes, "--resolution", 64, "-o", field, "-q", "--no-journal")
    shares = run(ray_accuracy, "cornell-glossy", "--camera", 0, "--rays", 2000, "--field", field, "--record", kit / "rays/cornell-glossy.rays", "--json")
    (kit / "expected/cornell-glossy.json").write_text(shares, encoding="utf-8")
    for effects in ("auto", "all"):
        run(command, "render", "cornell-glossy", "--field", field, "--size", "320x320", "--effects", effects, "-o", kit / f"expected/{effects}.exr", "--aov", "beauty", "-q")
    (kit / "expected/judged").write_text("cornell-glossy\n", encoding="utf-8")


def measure(kit, parts=""):
    environment = os.environ | {"SCONCE_GPU_SIZE": "48x32", "SCONCE_GPU_LARGE": "64x48", "SCONCE_GPU_FRAMES": "1", "SCONCE_GPU_WARM": "0", "SCONCE_GPU_LIST": "4000", "SCONCE_GPU_SECONDS": "3000", "SCONCE_GPU_PARTS": parts}
    environment.pop("SCONCE_VALIDATION", None)  # the kit turns the layer on where it belongs
    done = subprocess.run([str(kit / "run.sh"), str(kit / "gpu.json")], env=environment, capture_output=True, text=True, check=False)
    return done, json.loads((kit / "gpu.json").read_text(encoding="utf-8"))


def main():
    with tempfile.TemporaryDirectory() as made:
        kit = pathlib.Path(made, "kit")
        make_kit(kit, *sys.argv[1:])
        done, measured = measure(kit)
        if done.returncode != 0 or measured["wrong"]:
            sys.exit(f"the kit found {measured['wrong']} wrong, exit {done.returncode}:\n{done.stderr}")
        lacking = {name for name, part in measured["parts"].items() if part["result"] is None}
        if len(measured["parts"]) < 17 or lacking - FREE:
            sys.exit(f"parts {sorted(measured['parts'])}, without a result: {sorted(lacking)}")
        # Other shares or another picture than were packed are faults, and said to be.
        shares = kit / "expected/cornell-glossy.json"
        shares.write_text(shares.read_text(encoding="utf-8").replace('"leak": 0', '"leak": 1'), encoding="utf-8")
        run(sys.argv[2], "render", "cornell-glossy", "--field", kit / "fields/cornell-glossy.sconce", "--size", "320x320", "--seed", 7, "--no-denoise", "-o", kit / "expected/auto.exr", "--aov",
            "beauty", "-q")
        done, measured = measure(kit, "^(picture|rays)")
        if done.returncode != 1 or measured["wrong"] != ["rays_cornell-glossy", "picture_auto"]:
            sys.exit(f"with other shares and another picture packed the kit found {measured['wrong']} wrong, exit {done.returncode}")


if __name__ == "__main__":
    main()
