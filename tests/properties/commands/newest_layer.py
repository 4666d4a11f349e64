#!/usr/bin/env python3
"""What a validation layer of today says: that of Chromium's package, which is years newer than the distribution's own.

newest_layer.py COMMAND

Bakes a small field with every part that has passes of its own and draws frames of it. Fails with the layer's words, if it has any; skipped where
Chromium isn't installed.
"""
import json
import os
import pathlib
import subprocess
import sys
import tempfile

SKIPPED = 77
PLACES = ("/usr/lib/chromium", "/usr/lib/chromium-browser", "/opt/google/chrome")


def main():
    command = sys.argv[1]
    layers = [pathlib.Path(place, "libVkLayer_khronos_validation.so") for place in PLACES]
    layer = next((file for file in layers if file.exists()), None)
    if layer is None:
        print(f"skipped: no {' nor '.join(map(str, layers))}")
        sys.exit(SKIPPED)
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        manifest = {"name": "VK_LAYER_KHRONOS_validation", "type": "GLOBAL", "library_path": str(layer), "api_version": "1.3.239", "implementation_version": "1",
                    "description": "Khronos validation",
                    "instance_extensions": [{"name": "VK_EXT_debug_utils", "spec_version": "1"}, {"name": "VK_EXT_validation_features", "spec_version": "5"}]}
        (folder / "layer.json").write_text(json.dumps({"file_format_version": "1.2.0", "layer": manifest}), encoding="utf-8")
        environment = os.environ | {"VK_LAYER_PATH": made, "SCONCE_VALIDATION": "1"}

        def run(*arguments):
            done = subprocess.run([command, *map(str, arguments), "-q"], env=environment, capture_output=True, text=True, check=False)
            said = [line for line in done.stderr.splitlines() if line.startswith("validation:")]
            if done.returncode != 0 or said:
                sys.exit(f"{' '.join(map(str, arguments))} gave {done.returncode}:\n" + ("\n".join(said) or done.stderr))

        probes, field, seen = folder / "p.json", folder / "f.sconce", folder / "seen.exr"
        probes.write_text(json.dumps({"probes": [{"position": place} for place in ([0, 1.5, 0.5], [-0.8, 0.5, 0.6])]}), encoding="utf-8")
        baked = ("--probes", probes, "--resolution", 64, "--no-journal")
        # Light through the field's maps: several bounces by one pipeline, each through another light field.
        run("bake", "cornell", *baked, "--surface-texels", 0, "-o", field)
        run("bake", "cornell-glossy", *baked, "--live-links", 8, "-o", field)
        run("render", "cornell-glossy", "--field", field, "--size", "48x32", "--effects", "all", "--temporal", "--screen-trace", "--trace-every", 4, "--frames", 2, "-o", seen)
        run("render", "cornell-glossy", "--field", field, "--size", "48x32", "--diffuse", "traced", "-o", seen)
        run("relight", field, "--sun", "0.3,-1,0.2", "-o", folder / "lit.sconce")


if __name__ == "__main__":
    main()
