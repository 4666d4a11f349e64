#!/usr/bin/env python3
"""The programs that race tracers, from end to end on one small light field.

race_programs.py RAY_ACCURACY REPLAY TESSELLATION LIGHT_RESPONSE PRIMARY_RAYS FIELD_PATHS FLY_THROUGH SOAK EDGES_AND_POINTS CACHED_FRAMES COMMAND

sconce_tessellation cuts and bakes a scene; rays of it that sconce_ray_accuracy records have the same answers from sconce_replay.
sconce_light_response switches the lamp of a live field. sconce_primary_rays looks into one from two places, sconce_field_paths scatters light through one. sconce_fly_through flies
through one with room for two of its three probes; sconce_soak draws many frames of it, and of one whose light moves.
sconce_edges_and_points and sconce_cached_frames draw it from fewer rays than pixels.
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
    ray_accuracy, replay, tessellation, light_response, primary_rays, field_paths, fly_through, soak, edges_and_points, cached_frames, command = sys.argv[1:]
    with tempfile.TemporaryDirectory() as made:
        folder = pathlib.Path(made)
        probes, rays = folder / "p.json", folder / "r.rays"
        places = ([0, 1.5, 0.5], [-0.8, 0.5, 0.6], [0.8, 0.5, -0.4])
        probes.write_text(json.dumps({"probes": [{"position": place} for place in places]}), encoding="utf-8")

        cut = run(tessellation, "cornell", "--probes", probes, "-o", folder, "--triangles", 100, "--resolution", 64, "--rays", 500)
        baked = list(folder.glob("*.sconce"))
        expect(len(baked) == 1 and 100 <= int(baked[0].stem) <= 101, f"cut to 100 triangles, it made {baked}")
        expect(baked[0].stem + "," in cut.stdout, f"no row of {baked[0].stem} triangles:\n{cut.stdout}")
        field = baked[0]

        fields = ["--field", field, "--field", f"ours/ranked:1={field}", "--cpu", "--json"]
        first = json.loads(run(ray_accuracy, "cornell", *fields, "--rays", 2000, "--record", rays).stdout)
        again = json.loads(run(replay, rays, *fields).stdout)
        expect(len(first) == 2, f"two tracers raced, {len(first)} answered")
        expect(untimed(first) == untimed(again), f"replayed rays have other answers:\n{json.dumps(first, indent=1)}\n{json.dumps(again, indent=1)}")
        expect(first[0]["right_1"] > 0.85, f"ours is wrong: {first[0]}")
        frame = json.loads(run(ray_accuracy, "cornell", "--field", field, "--json", "--rays", 2000, "--camera", 0).stdout)
        expect(frame[0]["right_1"] > 0.85 and frame[0]["distance_reads"] != first[0]["distance_reads"], f"rays of one camera are wrong, or those of all: {frame}")
        refused = run(ray_accuracy, "cornell", "--field", field, "--camera", 99, code=2)
        expect("--camera is 99" in refused.stderr, f"a camera that isn't there: {refused.stderr}")
        timed = json.loads(run(replay, rays, "--field", field, "--runs", 2, "--timed", 500, "--json").stdout)
        expect(untimed(timed) != timed, f"timed runs have no times: {timed}")

        cold = json.loads(run(replay, rays, "--field", field, "--runs", 2, "--timed", 500, "--cold", 8, "--warm-up", 0.01, "--json").stdout)
        expect(untimed(cold) == untimed(timed) and "coherent_ms" in cold[0], f"cold caches change answers, or have no times: {cold}")

        looks = json.loads(run(primary_rays, "cornell", "--field", field, "--views", 2, "--width", 64, "--height", 36, "--runs", 1).stdout)
        nearest, farthest = (view["to_probe"] for view in looks["views"])
        expect(0 < nearest < farthest < 2, f"views are {nearest} and {farthest} m from a probe")
        for kind in ("one_eye", "two_eyes", "two_eyes_through_lenses"):
            mean = looks["methods"][0][kind]["mean"]
            shares = [mean[part] for part in ("right_1", "too_near", "too_far", "unknown")]
            expect(abs(sum(shares) - 1) < 1e-9 and shares[0] > 0.7 and mean["right_02"] < shares[0], f"{kind}: {mean}")

        small = ["--resolution", 64, "--surface-texels", 26, "--surface-rays", 16]
        direct, truth = folder / "direct.sconce", folder / "truth.exr"
        run(command, "bake", "cornell", "--probes", probes, *small, "--bounces", 0, "--live-links", 8, "-o", direct)
        run(command, "reference", "cornell", "--size", "48x36", "--spp", 256, "--bounces", 1, "--pixel-centre", "--parts", "-o", truth)
        walk = ["cornell", "--reference", truth, "--paths", 32]
        walked = json.loads(run(field_paths, *walk, "--field", direct, "--rays", 2, "-o", folder / "walked.exr").stdout)
        one, two = walked["rays"]
        expect(0 < two["rays"] < one["rays"] <= 32 * 48 * 36 and min(one["right_1"], two["right_1"]) > 0.78, f"rays of paths are wrong: {walked}")
        expect(abs(walked["path_tracer"]["diffuse_indirect"]["mean"] - 1) < 0.04, f"paths by triangles are not the reference's: {walked}")
        expect(abs(walked["ours"]["diffuse_indirect"]["mean"] - 1) < 0.06, f"paths of two rays have other light than one bounce: {walked}")
        short = json.loads(run(field_paths, *walk, "--field", direct).stdout)["ours"]["diffuse_indirect"]["mean"]
        expect(short < walked["ours"]["diffuse_indirect"]["mean"] - 0.1, f"a second ray adds nothing: {short}, {walked}")
        expect("no albedo" in run(field_paths, *walk, "--field", field, "--rays", 2, code=2).stderr, "a field without albedo is walked through")
        expect("--camera is 99" in run(field_paths, *walk, "--field", direct, "--camera", 99, code=2).stderr, "a camera that isn't there")

        lit = folder / "lit.sconce"
        run(command, "bake", "cornell-glossy", "--probes", probes, *small, "-o", lit)
        flown = json.loads(run(fly_through, "cornell-glossy", "--field", lit, "--resident", 2, "--frames", 12, "--width", 32, "--height", 24).stdout)
        expect(len(flown["frames"]) == 12 and flown["most_resident"] == 2 <= flown["read"], f"two probes of three: {flown}")
        expect(flown["cut"]["first_error"] > flown["error"]["median"], f"maps that come change nothing: {flown}")
        expect(flown["light"]["least"] > 0.3 and flown["error"]["median"] < 0.5, f"frames without light: {flown}")

        sparse = json.loads(run(edges_and_points, "cornell-glossy", "--field", lit, "--every", "16,64", "--width", 96, "--height", 72, "-o", folder / "sparse").stdout)
        expect(abs(sum(sparse["pixels"].values()) - 1) < 1e-9 and 0.8 < sparse["pixels"]["empty"] < 0.99, f"kinds of pixels: {sparse['pixels']}")
        expect(sparse["frame"]["relmse"] == 0 and sparse["frame"]["smoothed_relmse"] < 0.6 * sparse["frame"]["smooth_relmse"], f"edges smooth nothing: {sparse['frame']}")
        for every in ("every_16", "every_64"):
            ways = sparse[every]
            expect(all(ways[way]["relmse"] < ways["distance"]["relmse"] for way in ("likeness", "edges", "both")), f"edges keep nothing apart: {ways}")
            expect(0.01 < ways["edges"]["samples"] < 0.25 and (folder / f"sparse.{every[6:]}.both.png").exists(), f"{every}: {ways['edges']}")
        expect("camera 99" in run(edges_and_points, "cornell-glossy", "--field", lit, "--camera", 99, code=2).stderr, "a camera that isn't there")
        kept = json.loads(run(cached_frames, "cornell-glossy", "--field", lit, "--frames", 70, "--speed", 0.5, "--width", 48, "--height", 36).stdout)
        sharp, kept = kept["reflections"], kept["ways"]
        expect(len(kept["cache"]["frames"]) == 70 and kept["cache"]["error"] < kept["frameless"]["error"], f"points that move with the camera gain nothing: {kept}")
        expect(all(abs(way["mean"] - 1) < 0.1 for way in kept.values()), f"a way loses light: {kept}")
        expect(0 < sharp["corrected"]["rays"] <= 1 / 16 and sharp["prefiltered"]["rays"] == 0 < sharp["every"]["rays"], f"rays of reflections: {sharp}")
        expect(sharp["every"]["error"] < sharp["prefiltered"]["error"], f"rays are no better than prefiltered radiance: {sharp}")
        expect("no light groups" in run(cached_frames, "cornell-glossy", "--field", lit, "--switch", "lamp", code=2).stderr, "a group that isn't there")

        lights, live = folder / "l.json", folder / "live.sconce"
        lights.write_text('{"lights":[{"type":"point","position":[0,1.5,0],"intensity":[1,1,1]}]}', encoding="utf-8")
        run(command, "bake", "cornell", "--lights", lights, "--probes", probes, "--live-links", 8, *small, "-o", live)
        for scene, *what in (["cornell-glossy", "--field", lit, "--resident", 2], ["cornell", "--field", live]):
            soaked = json.loads(run(soak, scene, *what, "--frames", 120, "--side", 16).stdout)
            expect(soaked["first_frame_again"] is not False and soaked["memory_flat"], f"{what}: {soaked}")
        lines = run(light_response, live, "--frames", 20, "--share", 1, "--share", 0.3).stdout.splitlines()
        rows = [[float(cell) for cell in line.split(";")] for line in lines[1:21]]
        ours, some, blended = ([row[column] for row in rows] for column in (1, 3, 5))
        expect(ours[3] > 0.95, f"at full budget the lamp is not there after four frames: {ours}")
        expect(ours[0] > some[0] and some[-1] > 0.95, f"one probe a frame: {some}")
        expect(blended == sorted(blended) and blended[-1] < 0.5, f"blended light comes slowly: {blended}")
        run(light_response, field, code=3)

        run(replay, folder / "none.rays", "--field", field, code=5)
        refused = run(replay, rays, "--field", f"theirs={field}", code=2).stderr
        expect("theirs" in refused, f"a tracer that isn't there is not named: {refused}")


if __name__ == "__main__":
    main()
