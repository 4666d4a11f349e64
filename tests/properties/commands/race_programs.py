#!/usr/bin/env python3
"""The programs that race tracers, from end to end on one small light field.

race_programs.py SCONCE RAY_ACCURACY REPLAY TESSELLATION

Rays recorded by sconce_ray_accuracy and traced again by sconce_replay have the same answers; a scene cut finer has nearly the same.
"""
import json
import pathlib
import subprocess
import sys
import tempfile


def run(program, *arguments, code=0):
    done = subprocess.run([program, *map(str, arguments)], capture_output=True, text=True, check=False)
    if done.returncode != code:
        sys.exit(f"{pathlib.Path(program).name} {' '.join(map(str, arguments))} gave {done.returncode}, not {code}:\n{done.stdout}{done.stderr}")
    return done


def expect(fact, text):
    if not fact:
        sys.exit(text)


def untimed(rows):
    """What doesn't depend on the machine's speed."""
    return [{name: value for name, value in row.items() if not isinstance(value, dict) or "mrays_per_s" not in value} for row in rows]


def main():
    sconce, ray_accuracy, replay, tessellation = sys.argv[1:]
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        probes, field, rays = folder / "p.json", folder / "f.sconce", folder / "r.rays"
        run(sconce, "place", "cornell", "-o", probes, "--count", 4, "-q")
        run(sconce, "bake", "cornell", "--probes", probes, "-o", field, "--resolution", 128, "--bounces", 0, "-q")

        fields = ["--field", field, "--field", f"ours/ranked:1={field}", "--cpu", "--json"]
        first = json.loads(run(ray_accuracy, "cornell", *fields, "--rays", 2000, "--record", rays).stdout)
        again = json.loads(run(replay, rays, *fields).stdout)
        expect(len(first) == 2, f"two tracers raced, {len(first)} answered")
        expect(untimed(first) == untimed(again), f"replayed rays have other answers:\n{json.dumps(first, indent=1)}\n{json.dumps(again, indent=1)}")
        expect(first[0]["right_1"] > 0.95, f"ours is wrong: {first[0]}")
        other = json.loads(run(ray_accuracy, "cornell", *fields, "--rays", 2000, "--seed", 2).stdout)
        expect(untimed(other) != untimed(first), "another seed gives the same rays")
        timed = json.loads(run(replay, rays, "--field", field, "--runs", 2, "--timed", 500, "--json").stdout)
        expect(untimed(timed) != timed, f"timed runs have no times: {timed}")

        run(replay, folder / "none.rays", "--field", field, code=5)
        refused = run(replay, rays, "--field", f"theirs={field}", code=2).stderr
        expect("theirs" in refused, f"a tracer that isn't there is not named: {refused}")

        cut = run(tessellation, "cornell", "--probes", probes, "-o", folder, "--triangles", 100, 1000, "--resolution", 64, "--rays", 500)
        expect("1000" in cut.stdout, cut.stdout)


if __name__ == "__main__":
    main()
