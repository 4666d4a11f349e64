#!/usr/bin/env python3
"""Makes the pages' result files of what `sconce bench` and `sconce_ray_accuracy` measured.

    bench/pages/methods_table.sh                                bench/results/scene_methods.json and scene_targets.json, a scene of each run
    python3 bench/pages/bench_rows.py knobs RESULTS.json        bench/results/knobs.json: one scene's knobs
    bench/pages/leaks_sheet.sh                                  bench/results/walls.json
    bench/pages/ray_table.sh                                    bench/results/sponza_rays.json and tracer_targets.json
    bench/pages/resolution_table.sh                             bench/results/probes_and_resolution.json
    bench/pages/order_table.sh                                  bench/results/probe_orders.json
    bench/pages/compact_table.sh                                bench/results/compact.json
    bench/pages/response_table.sh                               bench/results/light_response.json
    bench/pages/effects_table.sh                                bench/results/effects.json and effects_passes.json
    bench/pages/bounces_table.sh                                bench/results/bounces.json
    bench/pages/primary_table.sh                                bench/results/primary_rays.json
    bench/pages/paths_table.sh                                  bench/results/field_paths.json
    bench/pages/day_sheet.sh                                    bench/results/day.json
    bench/pages/gallery.sh                                      bench/results/gallery.json
    bench/pages/effects_sheet.sh                                bench/results/each_effect.json
    bench/pages/stream_table.sh                                 bench/results/streaming.json
    bench/pages/sparse_table.sh                                 bench/results/edges_and_points.json and cached_frames.json
    bench/pages/moving_table.sh                                 bench/results/moving_shapes.json
    python3 bench/pages/bench_rows.py gpu GPU.json               bench/results/gpu_frames.json and gpu_rays.json, of what bench/gpu/run.sh wrote; notes may follow
    python3 bench/pages/bench_rows.py surfaces ROWS.txt          bench/results/surface_light.json, of what surface_table.sh printed
    bench/pages/placement_table.sh                              bench/results/placement_steps.json
    bench/pages/coverage_table.sh                               bench/results/placement_coverage.json
    bench/pages/placement_pictures.sh                           bench/results/placement_pictures.json
    bench/pages/scene_table.sh                                  bench/results/scene_pipeline.json

The commit that is named is the checked-out one: run it where the bench's program was built. A scene that several runs hold is the last one's.
"""
import json
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
NAMES = {"ours": "Sconce", "ours-grid": "Sconce's tracer, grid", "b0": "B0", "b0plus": "B0+", "b0plus-octree": "B0+, our lists", "wang": "W', our lists",
         "ddgi": "DDGI", "ddgi-placed": "DDGI, our probes", "sh-grid": "SH grid", "ddgi bytes": "DDGI, equal bytes", "sh-grid bytes": "SH grid, equal bytes", "path tracer": "path tracer", "path tracer filtered": "path tracer, filtered"}
# Label, asked: from the analysis (what is held equal, error, cost, ratio), or of the default points, at equal probes (a figure).
TARGETS = [
    ("equal glossy relMSE: frame time", "0.25", ("glossy.relmse", "frame_ms", "time")),
    ("as few wrong rays, 1 %: trace time", "0.25", ("wrong_rays", "trace_ms", "trace")),
    ("equal probes: wrong rays, 1 %", "0.25", "wrong"),
    ("equal probes: wrong rays, 0.2 %", "0.25", "wrong_02"),
    ("equal probes: glossy relMSE", "0.5", "glossy_relmse"),
    ("equal probes: diffuse relMSE", "0.5", "diffuse_relmse"),
    ("equal glossy relMSE: memory", "0.5", ("glossy.relmse", "bytes", "memory")),
]
NAMED = {"cornell_glossy.glb": "cornell_mcguire glossy", "zdm2.glb": "map_zdm2"}  # files whose names say too little
SHORT = {"ours-grid": "own", "b0plus-octree": "lists", "wang": "W'", "ddgi-placed": "DDGI, own probes"}  # in targets
PATHS = ("path tracer", "path tracer filtered")
HOST = ("G-buffer", "direct light", "compose")  # passes that a renderer has anyway


def slug(text):
    return re.sub(r"[^a-z0-9]+", "_", text.lower()).strip("_")


def of(point, path, scale=1.0, digits=4):
    """A figure of a point as text; empty where it has none."""
    for key in path.split("."):
        point = point.get(key) if isinstance(point, dict) else None
    return "" if point is None else f"{scale * point:.{digits}f}"


def megabytes(point):
    """Volumes have a few KB."""
    text = of(point, "bytes.total", 1e-6, 3)
    return text if not text or float(text) < 1.0 else of(point, "bytes.total", 1e-6, 1)


def figures(point):
    rays = point.get("rays", {})
    wrong = {f"wrong_{end}": {"x": 1.0 - rays[f"right_{end}"]} if rays else {} for end in ("1", "02")}
    row = {"probes": str(point.get("probes", "")), "wrong": of(wrong["wrong_1"], "x", 100, 2), "wrong_02": of(wrong["wrong_02"], "x", 100, 2),
           "unresolved": of(point, "rays.unresolved", 100, 2), "reads": of(point, "rays.reads_mean", 1, 1), "trace_ms": of(point, "trace_ms.median", 1, 1),
           "frame_ms": of(point, "frame_ms.median", 1, 0), "mb": megabytes(point), "bake_s": of(point, "bake_s", 1, 0)}
    for term in ("beauty", "diffuse", "glossy"):
        error = point.get("error", {}).get(term, {})
        # What can't be told from none is given as what is unsure of it: an upper bound, which is no part of any ratio.
        bound = "<" if error.get("relmse") is not None and error["relmse"] <= error.get("relmse_unsure", 0.0) else ""
        row |= {f"{term}_relmse": bound + of(point, f"error.{term}.relmse"), f"{term}_unsure": of(point, f"error.{term}.relmse_unsure", 1, 5),
                f"{term}_flip": of(point, f"error.{term}.flip", 1, 3), f"{term}_mean": of(point, f"error.{term}.mean", 1, 3)}
    if point.get("wrong"):
        row["wrong_picture"] = point["wrong"]
    return row


def grid_shape(scene, point):
    """As 6x3x3; empty where its probes are no grid."""
    return "x".join(str(count) for count in scene.get("probe_sets", {}).get(point.get("probe_set"), {}).get("grid", []))


def label(point):
    name = NAMES[point["method"]]
    return name if point["knob"] == "default" else f"{name}, {point['value']} {point['knob']}"


def scenes_of(files):
    scenes, commands = {}, []
    for file in files:
        results = json.loads(Path(file).read_text())
        commands += [" ".join(["sconce", *re.sub(r" (-o \S+|--quiet)", "", command).split()[1:]]) for command in results["commands"] if command not in commands]
        for scene in results["scenes"]:
            if scene.get("points"):
                scenes[NAMED.get(scene["source"], scene["name"])] = scene
    return scenes, commands


def references(name, scene):
    reference = scene["reference"]
    unsure = max((point["error"][term]["relmse_unsure"] for point in scene["points"] if "error" in point for term in ("diffuse",) if term in point["error"]
                  and point["method"] == "ours"), default=0.0)
    return f"{name}: {reference['spp']} paths, {reference['bounces']} bounces, of our diffuse relMSE unsure {unsure:.5f}"


def commit():
    return subprocess.run(["git", "rev-parse", "--short=12", "HEAD"], cwd=ROOT, capture_output=True, text=True, check=True).stdout.strip()


def write(name, what, commands, notes, rows, machine="Mesa's software Vulkan, llvmpipe, LLVM 15, 2 cores"):
    lines = ",\n".join(f"  {json.dumps(key)}: {json.dumps(row)}" for key, row in rows.items())
    head = {"what": what, "command": "; ".join(commands), "commit": commit(), "machine": machine, "notes": notes}
    text = json.dumps(head, indent=1)[:-2] + ',\n "rows": {\n' + lines + "\n }\n}\n"
    json.loads(text)
    (ROOT / "bench/results" / name).write_text(text)


def number(text, point, figure):
    """A figure of a point as it was measured, not as it is printed; None where there is none, or only a bound."""
    if not text or text.startswith("<"):
        return None
    term, _, kind = figure.rpartition("_")
    return point["error"][term]["relmse"] if kind == "relmse" else float(text)


def hardest(scene, compared, but):
    """(ratio ours / theirs, method) of the opponent that leaves us worst, those of `but` left out; the ratio is None where no setting of ours is as good."""
    if isinstance(compared, str):
        points = {point["method"]: (figures(point)[compared], point) for point in scene["points"] if point["knob"] == "default"}
        ours = number(*points["ours"], compared)
        found = [(ours / theirs, method) for method, theirs in ((method, number(*entry, compared)) for method, entry in points.items())
                 if method not in ("ours", *PATHS, *but) and ours is not None and theirs]
        return max(found, default=(None, None))
    error, cost, ratio = compared
    entries = [entry for entry in scene["analysis"]["equal"]
               if entry["what"] == "error" and entry["error_key"] == error and entry["cost_key"] == cost and entry["method"] not in (*PATHS, *but)]
    out = [entry["method"] for entry in entries if entry["ours"] is None]
    found = [(entry["ratio"][ratio], entry["method"]) for entry in entries if entry["ours"] and entry["ratio"].get(ratio) is not None]
    return (None, out[0]) if out else max(found, default=(None, None))


def targets(scenes, others):
    before = json.loads((ROOT / "bench/results/scene_targets.json").read_text())["rows"] if others else {}
    rows = {}
    for text, asked, compared in TARGETS:
        for end, but in (("", ()), ("; others' tracers", ("ours-grid",))):
            rows[slug(text + end)] = row = {"label": text + end, "asked": asked}
            for name, scene in scenes.items():
                ratio, method = hardest(scene, compared, but)
                row[slug(name)] = "" if method is None else f"{'out of reach' if ratio is None else f'{ratio:.2f}'} ({SHORT.get(method, NAMES[method])})"
            row |= {key: before[slug(text + end)][key] for key in others}
    return rows


def least_to_most(values):
    least, most = (f"{x:.0f}" if x >= 9.95 else f"{x:.2g}" for x in (min(values), max(values)))
    return least if least == most else f"{least} to {most}"


def better(rows, scene, paths):
    """Of a path tracer's picture through our filters and without them the one whose diffuse light is less wrong."""
    filtered, plain = (rows[f"{scene}__{key}{'' if paths == 1 else f'_{paths}'}"] for key in ("path_tracer_filtered", "path_tracer"))
    return min(filtered, plain, key=lambda row: float(row["diffuse_relmse"].lstrip("<")))


def summary(rows, scenes):
    """Over the scenes, the least and the most of what a method's figures are times ours, and KiB a probe."""
    found = {}
    for name in scenes:
        for paths in (1, 16):
            rows[f"{slug(name)}__path_tracer_better_{paths}"] = better(rows, slug(name), paths) | {"label": f"path tracer, {paths} paths, filtered where that helps"}
    for method in ("ours_grid", "b0plus", "b0plus_octree", "ddgi", "ddgi_placed", "sh_grid", "ddgi_bytes", "sh_grid_bytes", "path_tracer_64", "path_tracer_better_1", "path_tracer_better_16"):
        for figure in ("wrong", "wrong_02", "diffuse_relmse", "beauty_flip", "frame_ms"):
            pairs = [(rows[f"{slug(name)}__{method}"][figure], rows[f"{slug(name)}__ours"][figure]) for name in scenes
                     if f"{slug(name)}__{method}" in rows]  # a volume of equal bytes may need more probes than there may be
            times = [float(theirs) / float(ours) for theirs, ours in pairs if theirs and ours and "<" not in theirs + ours]
            if times:
                found[f"{method}_{figure}"] = least_to_most(times)
    for method in ("ours", "ddgi"):
        own = [rows[f"{slug(name)}__{method}"] for name in scenes]
        found[f"{method}_kib"] = least_to_most([1e6 / 1024 * float(row["mb"]) / int(row["probes"]) for row in own])
    return {"all": {"label": "theirs over ours, over the scenes"} | found}


def named(points):
    """Points, of which a volume's with most probes are named `_bytes`."""
    most = lambda point: all(int(other["value"]) <= int(point["value"]) for other in points if (other["method"], other["knob"]) == (point["method"], "probes"))
    return [point | {"knob": "default", "method": point["method"] + " bytes"}
            if point["method"] in ("ddgi", "ddgi-placed", "sh-grid") and point["knob"] == "probes" and most(point) else point for point in points]


def look_up(point):
    """How far look-ups are moved, metres along the normal x times as far towards the viewer; empty where they aren't."""
    return f"{point['look_up']['bias']:.2g} x{point['look_up']['view']:.2g}" if "look_up" in point else ""


def kept(name, scenes):
    """Of a table that has views besides those that were measured now: its rows, the views' names by slug, and the notes about them, which begin with their names."""
    old = json.loads((ROOT / "bench/results" / name).read_text()) if (ROOT / "bench/results" / name).exists() else {"rows": {}, "commit": ""}
    names = {key.split("__")[0]: row["scene"] for key, row in old["rows"].items() if "scene" in row and row["scene"] not in scenes}
    return old["rows"], names, [note for note in old.get("notes", []) if note.split(":")[0] in names.values()]


def methods(files):
    scenes, _ = scenes_of(files)
    before, others, of_before = kept("scene_methods.json", scenes)
    rows = {key: row for key, row in before.items() if key.split("__")[0] in others}
    for name, scene in scenes.items():
        for point in named(scene["points"]):
            if point["knob"] == "default" or (point["knob"] == "paths" and point["value"] in ("1", "4", "16", "64")):
                key = slug(point["method"]) + ("" if point["knob"] == "default" else f"_{point['value']}")
                rows[f"{slug(name)}__{key}"] = {"scene": name, "label": label(point)} | figures(point)
                rows[f"{slug(name)}__{key}"] |= {"grid_shape": grid_shape(scene, point), "bias": look_up(point)}
    rows |= summary(rows, [*scenes, *others.values()])
    notes = ["relMSE by parts of the reference's paths, so without its noise; FLIP with it; rays wrong within 1 and 0.2 % of the diagonal, in %",
             "..._unsure: the standard error of relMSE by the reference's noise",
             "times are CPU time of all threads divided by the cores; nothing else running, where a view's note says no other"]
    notes += [f"{references(name, scene)}; of {commit()}" for name, scene in scenes.items()] + of_before
    command = ["bench/pages/methods_table.sh"]
    write("scene_methods.json", "Every method at its default, all of a view in one run", command, notes, rows)
    write("scene_targets.json", "Targets: ours over the hardest opponent, which is named", command, ["a ratio above the asked one is a missed target"],
          targets(scenes, others))


def over(value, base):
    try:
        return f"{float(value) / float(base):.2g}"
    except (ValueError, ZeroDivisionError):
        return ""


PRICED = ("wrong", "wrong_02", "reads", "trace_ms", "frame_ms", "mb", "glossy_relmse", "diffuse_relmse", "beauty_flip", "bake_s")


def knobs(files):
    """A row a value, and a row a knob, whose cells list its values', one where all are alike."""
    listed = lambda texts: texts[0] if len(set(texts)) == 1 else ", ".join(texts)
    scenes, commands = scenes_of(files)
    name, scene = next(iter(scenes.items()))
    ours = [point for point in scene["points"] if point["method"] == "ours" and "error" in point]
    priced = lambda point: {key: value for key, value in figures(point).items() if key in PRICED}
    first = next(point for point in ours if point["knob"] == "default")
    default = priced(first)
    rows, lists = {"default": {"label": "default"} | default | {"diffuse_unsure": figures(first)["diffuse_unsure"]}}, {}
    for point in ours:
        if point["knob"] != "default":
            own = priced(point)
            row = {"label": f"{point['knob']} {point['value']}", "value": point["value"]} | own
            row |= {f"{key}_times": over(value, default[key]) for key, value in own.items()}
            rows[f"{slug(point['knob'])}_{slug(point['value'])}"] = row
            lists.setdefault(point["knob"], []).append(row)
    for knob, values in lists.items():
        rows[slug(knob)] = {"label": knob} | {key: listed([row[key] for row in values]) for key in values[0] if key != "label"}
    write("knobs.json", f"Our knobs on {name}, each alone against the default", commands,
          ["`_times`: over the default's; a knob's row lists its values', one where all are alike", references(name, scene)], rows)


KNOBS = {"opinion": "no second opinion (`opinion:0`)", "farBounds": "far bounds read (`farBounds:1`)", "ranked:2": "two ranked probes (`ranked:2`)",
         "ranked:1": "one (`ranked:1`)"}


def traced(entry, yardstick):
    """A tracer's row of a race; times over the yardstick's."""
    percent = lambda key: f"{100 * entry[key]:.2f}" if key in entry else "100" if key in ("right_1", "right_02") else ""
    reads = entry.get("distance_reads", {})
    row = {key: percent(key) for key in ("right_1", "right_02", "right_1_unsure", "right_02_unsure", "assumed_right_1", "assumed_right_02", "false",
                                             "leak", "unresolved")}
    row |= {"reads_mean": of(entry, "distance_reads.mean", 1, 1), "reads_95": str(reads.get("p95", "")), "reads_max": str(reads.get("max", "")),
            "index_reads": of(entry, "index_reads_mean", 1, 1), "probes": str(entry.get("probes", "")), "mib_traced": of(entry, "trace_mib", 1, 2),
            "mib_with_radiance": f"{entry['trace_mib'] + entry['radiance_mib']:.2f}" if "trace_mib" in entry else ""}
    for order, runs in (("order", "coherent_ms"), ("shuffled", "incoherent_ms")):
        row |= {f"ratio_{order}": f"{entry[runs]['median'] / yardstick[runs]['median']:.2f}", f"ms_{order}": of(entry, f"{runs}.median", 1, 0)}
    return row


def tracer_targets(rows):
    """Sponza's figures beside what was asked of them, all at least or all at most."""
    ours, embree = rows["ours"], rows["embree"]
    rate = lambda order: f"{float(embree[f'ms_{order}']) / float(ours[f'ms_{order}']):.2f}"
    asked = [("right within 1 % / 0.2 %, at least", (97.5, 97), (ours["right_1"], ours["right_02"]), True), ("unresolved %, at most", (1.2,), (ours["unresolved"],), False),
             ("false hits %, at most", (0.4,), (ours["false"],), False), ("leaks %, at most", (0.6,), (ours["leak"],), False),
             ("distance reads, mean / 95th, at most", (24, 55), (ours["reads_mean"], ours["reads_95"]), False),
             ("MiB a probe, traced / with radiance, at most", (1.1, 2.1), (ours["mib_traced"], ours["mib_with_radiance"]), False),
             ("time over that of B0+ on the same probes, in order / shuffled, at most", (0.30, 0.25), (ours["ratio_order"], ours["ratio_shuffled"]), False),
             ("rays a second over Embree's, in order / shuffled, at least", (0.8, 0.8), (rate("order"), rate("shuffled")), True)]
    found = {}
    for text, bounds, values, least in asked:
        reached = all(float(value) >= bound if least else float(value) <= bound for bound, value in zip(bounds, values))
        found[slug(text)] = {"label": text, "asked": " / ".join(f"{bound:g}" for bound in bounds), "found": " / ".join(values), "reached": "yes" if reached else "no"}
    write("tracer_targets.json", "What was asked of the tracer on Sponza", ["bench/pages/ray_table.sh"], [], found)


def rays(arguments):
    notes = ["200,000 glossy rays (GGX alpha 0.1 to 0.3) from 64 viewpoints: the cameras and points of the reachable space; truth by Embree",
             "right: within that share of the scene's diagonal of the truth; shares in %, unsure: standard errors by viewpoint; assumed_right: were an"
             " unresolved ray a hit where the tracer lost sight (McGuire et al. 2017, section 4)",
             "cube faces of 208 and octahedral maps of 512 texels: equal memory; W' 512; grids in the better of two poses, plain and --fit-grid",
             "ratio: trace time of 50,000 rays over that of B0+ with the same probes and lists, in picture order and shuffled; nothing else running"]
    entries = json.loads(Path(arguments[0]).read_text())
    first = lambda tracer, field: next(entry for entry in entries if entry["tracer"] == tracer and entry.get("field", "").endswith(field))
    yardstick = first("b0plus-octree", ".oct.sconce")
    grid = max((first("b0plus", f".{pose}.sconce") for pose in ("fit", "plain")), key=lambda entry: entry["right_1"])
    named = {"ours": (first("ours", ".ours.sconce"), "Sconce"), "b0plus_octree": (yardstick, "B0+, same probes and lists"),
             "b0plus_grid": (grid, f"B0+, grid of {grid['probes']}"), "wang": (first("wang", ".wang.sconce"), "W', same probes and lists"),
             "embree": (next(entry for entry in entries if entry["tracer"] == "embree"), "Embree, both cores")}
    named |= {slug(knob): (entry, text) for entry in entries for knob, text in KNOBS.items() if knob in entry["tracer"]}
    rows = {key: {"label": text} | traced(entry, yardstick) for key, (entry, text) in named.items()}
    write("sponza_rays.json", "Tracers on Sponza, 54 probes, at equal memory", ["bench/pages/ray_table.sh"], notes, rows)
    tracer_targets(rows)


def resolution(arguments):
    """@param arguments  a race's results, of fields PROBES_TEXELS.sconce, first the one that times are relative to"""
    fields = [entry for entry in json.loads(Path(arguments[0]).read_text()) if "field" in entry]
    rows = {}
    for entry in sorted(fields, key=lambda entry: (entry["field"] != fields[0]["field"] and not entry["field"].endswith("_256.sconce"), entry["probes"], entry["field"])):
        probes, texels = Path(entry["field"]).stem.split("_")
        row = traced(entry, fields[0])
        rows[f"{probes}_{texels}"] = {"probes": probes, "resolution": texels} | {
            key: row[key] for key in ("right_1", "right_02", "right_1_unsure", "false", "leak", "unresolved", "reads_mean", "reads_95", "index_reads")} | {
            "mib_traced": f"{entry['trace_mib'] * entry['probes']:.0f}", "time_order": row["ratio_order"], "time_shuffled": row["ratio_shuffled"]}
    write("probes_and_resolution.json", "What accuracy costs: probes and resolution; Sponza, placed probes, cube faces", ["bench/pages/resolution_table.sh"],
          ["100,000 glossy rays (GGX alpha 0.1 to 0.3), truth by Embree; right within 1 % and 0.2 % of the diagonal, shares in %",
           "time: trace of 50,000 rays over that of 54 probes at 256 in the same run, in picture order and shuffled; mib_traced: of all probes"], rows)


ORDERS = {"0": "as ranked", "1": "most parallel (Donow 2016)", "2": "most parallel, signed (Donow 2016)", "3": "nearest to the line"}


def orders(arguments):
    """@param arguments  SCENE=a race's results, of fields of one scene"""
    rows = {}
    for scene, file in (argument.split("=", 1) for argument in arguments):
        entries = {entry["tracer"].rpartition("order:")[2]: entry for entry in json.loads(Path(file).read_text()) if "order:" in entry["tracer"]}
        wrong = lambda entry, right: 1 - entry[right]
        for order, entry in entries.items():
            first = entries["0"]
            rows[slug(f"{scene} {order}")] = {
                "label": f"{scene}, {entry['probes']} probes: {ORDERS[order]}", "right_1": f"{100 * entry['right_1']:.2f}", "right_02": f"{100 * entry['right_02']:.2f}",
                "unresolved": f"{100 * entry['unresolved']:.2f}", "reads": of(entry, "distance_reads.mean", 1, 1), "index_reads": of(entry, "index_reads_mean", 1, 1),
                "handoffs": of(entry, "handoffs_mean", 1, 2), "wrong_times": f"{wrong(entry, 'right_1') / wrong(first, 'right_1'):.2f}",
                "wrong_02_times": f"{wrong(entry, 'right_02') / wrong(first, 'right_02'):.2f}", "reads_times": f"{entry['distance_reads']['mean'] / first['distance_reads']['mean']:.2f}", "handoffs_times": f"{entry['handoffs_mean'] / first['handoffs_mean']:.2f}"}
    for order in ORDERS:
        own = [row for key, row in rows.items() if key.endswith(f"_{order}") and not key.startswith("all_")]
        rows[f"all_{order}"] = {"label": ORDERS[order]} | {key: least_and_most([row[key] for row in own]) for key in own[0] if key != "label"}
    write("probe_orders.json", "Orders in which a ray asks a voxel's probes", ["bench/pages/order_table.sh"],
          ["the same fields, faces of 128, glossy rays (GGX alpha 0.1 to 0.3), truth by Embree; right: within 1 % and 0.2 % of the diagonal, %; reads, hand-offs: means of a ray; times: over those of probes as ranked",
           "after an order's first probe the others follow by it, too; Donow 2016 takes them in turn by 3 modulo 8, of a grid's corners (section 5.5)"], rows)


def compact(arguments):
    """@param arguments  SCENE=where compact_table.sh left what it measured, without the ends of names"""
    rows = {}
    for scene, at in (argument.split("=", 1) for argument in arguments):
        load = lambda end: json.loads(Path(f"{at}.{end}.json").read_text())
        info, error = ({form: load(f"{form}.{end}") for form in ("texels", "blocks")} for end in ("info", "compare"))
        rays = dict(zip(("texels", "blocks"), load("race")))
        probes = info["texels"]["probes"]
        kib = {form: info[form]["bytes"]["total"] / probes / 1024 for form in info}
        turns = [{form: load(f"{form}.{turn}.render")["passes_ms"]["glossy trace"] for form in info} for turn in range(1, 6)]
        trace = {form: statistics.median(turn[form] for turn in turns) for form in info}
        times = statistics.median(turn["blocks"] / turn["texels"] for turn in turns)
        row = {"label": f"{scene}, {probes} probes"} | {f"kib_{form}": f"{kib[form]:.0f}" for form in kib} | {"bytes_times": f"{kib['blocks'] / kib['texels']:.2f}"}
        for key in ("right_1", "right_02"):
            row |= {f"{key}_{form}": f"{100 * rays[form][key]:.2f}" for form in rays}
            row[f"{key}_lost"] = f"{round(100 * (rays['texels'][key] - rays['blocks'][key]), 2) + 0.0:.2f}"
        for key in ("relmse", "flip"):
            row |= {f"{key}_{form}": f"{error[form][key]:.4f}" for form in error} | {f"{key}_times": f"{error['blocks'][key] / error['texels'][key]:.3f}"}
        row["mean_times"] = f"{error['blocks']['mean'] / error['texels']['mean']:.3f}"
        row |= {f"trace_ms_{form}": f"{trace[form]:.0f}" for form in trace} | {"trace_times": f"{times:.2f}"}
        rows[slug(scene)] = row
    own = list(rows.values())
    rows["all"] = {"label": "all"} | {key: least_and_most([row[key] for row in own]) for key in own[0] if key.endswith(("_times", "_lost"))}
    write("compact.json", "Maps in blocks (bake --compact) beside the same maps in texels", ["bench/pages/compact_table.sh"],
          ["faces of 256, all that a field holds for a probe; right: within 1 % and 0.2 % of the diagonal, %, of the same glossy rays (GGX alpha 0.1 to 0.3), truth by Embree; reflections: "
           "every surface of roughness 0.2, all traced, 4 rays a pixel and the filter, against 128 paths of 4 bounces; trace: the pass's ms at 320x180, medians of five turns of 5 frames, one form after the other in each"], rows)


def walls(arguments):
    rows = {}
    for wall in ("0.5", "1", "2", "5", "10", "20", "curtain"):
        both, dark = (json.loads(Path(arguments[0], wall + end).read_text()) for end in (".json", ".right.json"))
        rows[slug(f"wall {wall}")] = {"label": wall if wall == "curtain" else f"wall of {wall} cm", "relmse": f"{both['relmse']:.4f}", "flip": f"{both['flip']:.3f}",
                                "dark_relmse": f"{dark['relmse']:.6f}", "dark_flip": f"{dark['flip']:.3f}", "dark_light": f"{dark['mean']:.3f}"}
    write("walls.json", "Two rooms, one a hundred times darker, by what stands between them", ["bench/pages/leaks_sheet.sh"],
          ["dark_light: the mean of the dark room's own picture, ours over the reference's"], rows)


def steps(arguments):
    at, name, count, steps, views = arguments[0], arguments[1], arguments[2], arguments[3].split(","), int(arguments[4])
    race = {Path(entry["field"]).name.split(".")[-2]: entry for entry in json.loads(Path(at + ".race.json").read_text()) if "field" in entry}
    placed = {line.split()[0]: line.split() for line in Path(at + ".placed.txt").read_text().splitlines() if line.split()[:1] and line.split()[0] in steps}
    grid = placed["grid"][1] if "grid" in placed else count
    row = {"label": f"{name}, {count}"} | ({"grid_probes": grid} if grid != count else {})
    for step in steps:
        key, ray = slug(step), race[step]
        row |= {f"{key}_wrong": f"{100 * (1 - ray['right_1']):.2f}", f"{key}_wrong_02": f"{100 * (1 - ray['right_02']):.2f}", f"{key}_unsure": f"{100 * ray['right_1_unsure']:.2f}",
                f"{key}_area": placed[step][3], f"{key}_quality": placed[step][6], f"{key}_seconds": placed[step][7]}
        if not views: continue
        light = [json.loads(Path(f"{at}.{step}.{i}.json").read_text()) for i in range(views)]
        mean = lambda key: sum(view[key] for view in light) / views
        row |= {f"{key}_relmse": f"{mean('relmse'):.5f}", f"{key}_flip": f"{mean('flip'):.3f}", f"{key}_means": " ".join(f"{view['mean']:.3f}" for view in light)}
    print(f'  "{slug(name)}": {json.dumps(row)},', flush=True)


def placed(arguments):
    """Of the lines that placement_table.sh prints, what the default has of the yardstick's and the grid's, and over all scenes geometric means of each step."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    steps = [key.removesuffix("_wrong") for key in next(iter(rows.values())) if key.endswith("_wrong")]
    all_, behind = {"label": "all, geometric means over the yardstick's"}, []
    times = lambda row, step, of, key: float(row[f"{step}_{key}"]) / float(row[f"{of}_{key}"])
    for key in ("wrong", "wrong_02", "relmse"):
        of = [row for row in rows.values() if f"yardstick_{key}" in row]
        all_ |= {f"{step}_{key}": f"{statistics.geometric_mean([times(row, step, 'yardstick', key) for row in of]):.2f}" for step in steps if step != "yardstick"}
        all_ |= {"scenes" if key != "relmse" else "lit": str(len(of))}
    for row in rows.values():
        best = min((step for step in steps if step != "grid"), key=lambda step: float(row[f"{step}_wrong"]))
        row |= {"of_best": " / ".join(f"{times(row, 'gradient', min((step for step in steps if step != 'grid'), key=lambda step: float(row[f'{step}_{key}'])), key):.2f}"
                                      for key in ("wrong", "wrong_02"))}
        if "yardstick_relmse" in row:
            row |= {"light_of_yardstick": f"{times(row, 'gradient', 'yardstick', 'relmse'):.2f}"}
        unsure = max(float(row["gradient_unsure"]), float(row[f"{best}_unsure"]))
        behind.append((float(row["gradient_wrong"]) - float(row[f"{best}_wrong"])) / unsure)
        for of in ("yardstick", "grid"):
            row |= {f"of_{of}": " / ".join(f"{times(row, 'gradient', of, key):.2f}" for key in ("wrong", "wrong_02"))}
    rows["all"] = all_ | {"behind_best": f"{max(behind):.1f}"}
    write("placement_steps.json", "What each step of placing buys: glossy rays wrong within 1 % and 0.2 % of the diagonal, in %, and diffuse relMSE, FLIP and means over a scene's views",
          ["bench/pages/placement_table.sh"],
          ["yardstick: plain greedy cover; grid: the one that place --fit-grid takes, by what its corners see, which rays of ours may find worse than others (scene_methods: the best of 12 by its own tracer's rays); chosen: greedy and exchange; gradient: that refined, as sconce place does; balls, balls_gradient: chosen and refined from the other skeleton",
           "100,000 rays, all by our tracer, maps of 256; unsure: standard error of wrong rays by viewpoint; light of up to 8 bounces, as the references",
           "relMSE is without the reference's noise (256 paths in parts); Sponza's third view is of its roof, which is no part of the space that counts",
           "behind_best: by how many standard errors (the larger of the two) the default has more wrong rays than the best step, in the scene where it is most"], rows)


def response(arguments):
    """The lines of sconce_light_response: a row a way, its curve at some frames, and when it is there."""
    lines = Path(arguments[0]).read_text().splitlines()
    end = next(i for i, line in enumerate(lines[1:], 1) if not line[:1].isdigit())
    curve = [line.split(";") for line in lines[1:end]]
    shown, rows = [frame for frame in (1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 100, 150, 200, 300) if frame <= len(curve)], {}
    for way, line in enumerate(lines[end:]):
        name, said = line.rsplit(": ", 1)
        numbers = re.search(r"50 % after (.*?), 95 % after (.*?), 99 % after (.*?) frames; mean error on the way to 95 % (.*)", said).groups()
        at = lambda frame, k: curve[frame - 1][1 + 2 * way + k]
        rows[slug(name)] = {"label": name} | dict(zip(("frames_50", "frames_95", "frames_99", "error"), numbers)) | {
            "frames": " ".join(map(str, shown)), "means": " ".join(at(frame, 0) for frame in shown), "errors": " ".join(at(frame, 1) for frame in shown),
            "worst": f"{max(float(at(frame, 1)) for frame in range(1, len(curve) + 1)):.3f}"}
    write("light_response.json", "Light that bounces after a lamp of hall is switched on, frame by frame, of what it settles at", ["bench/pages/response_table.sh"],
          ["means: of all texels by area, over the settled mean; errors: root mean square over the settled root mean square; error: its mean on the way to 95 %",
           "blended: an irradiance volume's blending (Majercik et al. 2021) at every texel, fed without noise: what rays a frame it has doesn't show"], rows)


def bounces(arguments):
    """Of the lines that bounces_table.sh prints, and over them least and most."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    keys = [key for key in next(iter(rows.values())) if key != "label"]
    rows["all"] = {"label": "least and most", "scenes": str(len(rows))} | {key: least_and_most([row[key] for row in rows.values()]) for key in keys}
    write("bounces.json", "The mean of a view's indirect light over the path tracer's, both with as many bounces", ["bench/pages/bounces_table.sh"],
          ["diffuse_N, glossy_N, picture_N: of N bounces; pixels in which both see the same surface",
           "what a gathering ray brings that was reflected on its way is of as many bounces earlier, up to three"], rows)


def effects(arguments):
    """What each scene's effects cost, auto against all, of the files that effects_table.sh leaves in a folder; and each pass."""
    folder, names, turns = Path(arguments[0]), arguments[2:], int(arguments[1])
    rows, passes = {}, {}
    for name in names:
        plans = {}
        for plan in ("auto", "all"):
            runs = [json.loads((folder / f"{name}.{plan}.{turn}.json").read_text()) for turn in range(turns)]
            plans[plan] = runs[0] | {"passes_ms": {one: min(run["passes_ms"][one] for run in runs) for one in runs[0]["passes_ms"]}}
            passes[f"{slug(name)}__{plan}"] = {"label": name, "plan": plan} | {slug(one): f"{ms:.0f}" for one, ms in plans[plan]["passes_ms"].items()}
        light = {plan: sum(ms for one, ms in run["passes_ms"].items() if one not in HOST) for plan, run in plans.items()}
        auto, size = plans["auto"], lambda end: f"{(folder / f'{name}{end}').stat().st_size / 1e6:.1f}"
        rows[slug(name)] = {"label": name, "calls_for": " ".join(one for one in ("diffuse", "rough", "glossy", "mirror", "emitters", "sky") if auto["effects"][one]),
                            "traced_pixels": f"{100 * auto.get('traced_pixels', 0):.1f} %", "auto_ms": f"{light['auto']:.0f}", "all_ms": f"{light['all']:.0f}",
                            "ratio": f"{light['all'] / light['auto']:.2f}x", "auto_images_mb": f"{auto['device_bytes'] / 1e6:.1f}",
                            "all_images_mb": f"{plans['all']['device_bytes'] / 1e6:.1f}", "auto_file_mb": size(".sconce"), "all_file_mb": size(".all.sconce"),
                            "same": "yes" if json.loads((folder / f"{name}.same.json").read_text())["mse"] == 0 else "NO"}
    write("effects.json", "Indirect light with only what a scene calls for (auto) and with everything over the whole picture (all); 960x540, one ray a pixel",
          ["bench/pages/effects_table.sh"],
          [f"both plans in turns, the least time of each pass of {turns} turns of 5 frames; nothing else running",
           "milliseconds of indirect light alone, without G-buffer, direct light and composition"], rows)
    write("effects_passes.json", "Milliseconds a pass of the table of effects", ["bench/pages/effects_table.sh"], [], passes)


def gpu(arguments):
    """Milliseconds of each pass of frames, and rays a second of tracers, of a kit's run on a GPU."""
    kit = json.loads(Path(arguments[0]).read_text())
    parts, device = kit["parts"], kit["parts"]["doctor"]["result"]["devices"][0]
    machine = f"{device['name']}, {device['driver']}"
    notes = [f"kit of sconce {kit['kit']}: frames of {kit['size']} but where a name says 4k, {kit['frames']} timed after {kit['warm_seconds']} s of others, the median"
             " counts; effects as the scene calls for, all: every effect over the whole picture, glossy: every pixel at roughness 0.15"]
    clocks = {name: part["clock_mhz"] for name, part in parts.items() if name.startswith(("frame", "glossy", "race")) and part["clock_mhz"]}
    notes += arguments[1:]
    if clocks:
        medians = [clock[1] for clock in clocks.values()]
        notes.append(f"clock while times were taken: {min(medians)} to {max(medians)} MHz, medians of its parts")
    frames = {name: part["result"]["passes_ms"] for name, part in parts.items() if name.startswith(("frame", "glossy")) and part["result"]}
    passes = list(dict.fromkeys(one for times in frames.values() for one in times))
    rows = {slug(one): {"label": one} | {slug(name): f"{times[one]:.3f}" for name, times in frames.items() if one in times} for one in passes}
    rows["indirect"] = {"label": "indirect light: all but G-buffer, direct light, compose"} | {
        slug(name): f"{sum(ms for one, ms in times.items() if one not in HOST):.2f}" for name, times in frames.items()}
    write("gpu_frames.json", "Milliseconds of each pass on a GPU", ["bench/gpu/bundle.sh", "bench/gpu/run.sh", "bench_rows.py gpu"], notes, rows, machine)
    labels = {"ours": "Sconce", "b0plus-octree": "B0+, same probes and lists", "wang": "W', same probes and lists"}
    rows = {}
    raced, plain, cold = ({entry["tracer"]: entry for entry in parts[name]["result"] or []} for name in ("race", "race_plain", "race_cold"))
    orders = {"order": "coherent_ms", "shuffled": "incoherent_ms"}
    # Each tracer in the form that is the faster one for it.
    best = lambda tracer, order: min((one[tracer][orders[order]] for one in (raced, plain)), key=lambda times: times["median"])
    for tracer, entry in raced.items():
        row = {"label": labels[tracer], "right_1": f"{100 * entry['right_1']:.2f}", "right_02": f"{100 * entry['right_02']:.2f}", "reads": f"{entry['distance_reads']['mean']:.1f}"}
        for order, times in orders.items():
            row |= {order: f"{entry[times]['mrays_per_s']:.0f}", f"plain_{order}": f"{plain[tracer][times]['mrays_per_s']:.0f}",
                    f"ratio_{order}": f"{best(tracer, order)['median'] / best('b0plus-octree', order)['median']:.2f}",
                    f"ratio_plain_{order}": f"{plain[tracer][times]['median'] / plain['b0plus-octree'][times]['median']:.2f}",
                    f"refill_{order}": f"{entry[times]['median'] / plain[tracer][times]['median']:.2f}"}
        if tracer in cold:
            row |= {"cold": f"{cold[tracer]['coherent_ms']['mrays_per_s']:.0f}",
                    "ratio_cold": f"{cold[tracer]['coherent_ms']['median'] / cold['b0plus-octree']['coherent_ms']['median']:.2f}"}
        rows[slug(tracer)] = row
    if parts.get("race_compact", {}).get("result"):
        texels, compact = parts["race_compact"]["result"]
        rows["compact"] = {"label": "Sconce, compact maps"} | {
            key: f"{100 * compact[key]:.2f}" for key in ("right_1", "right_02")} | {
            f"times_{order}": f"{compact[times]['median'] / texels[times]['median']:.2f}" for order, times in orders.items()}
    for name in parts:  # what a GPU answers otherwise than the processor
        if name.startswith("rays_") and parts[name]["result"]:
            rows[slug(name)] = {"label": name, "rays": str(parts[name]["result"][0]["rays"]), "differs": str(parts[name]["result"][0]["cpu_differs"])}
    for name in parts:
        if name.startswith("picture_") and parts[name]["result"]:
            rows[slug(name)] = {"label": name, "relmse": f"{parts[name]['result']['relmse']:.1e}"}
    if parts["passes"]["result"]:
        rows |= {slug(one["pass"]): {"label": one["pass"]} | {slug(key): str(value) for key, value in one["statistics"].items() if key in
                                                                  ("subgroup_size", "Register Count", "Shared Memory Size", "Binary Size", "VGPRs", "Spilled VGPRs", "Instructions")} for one in parts["passes"]["result"]["passes"]}
    write("gpu_rays.json", "Rays, answers and passes on a GPU", ["bench/gpu/bundle.sh", "bench/gpu/run.sh", "bench_rows.py gpu"],
          notes + ["million rays a second: rays of one camera's picture, in its order and shuffled, again and again; plain: a ray a lane, else four, see shaders/refill.glsl; ratio: of the faster form of each;"
                   " refill: of a tracer's plain time; cold: 256 MiB are written before each pass;"
                   " Sconce and W' on cube faces of 128 texels, B0+ on octahedral maps of 320",
                   "differs: rays that the same text on the machine's processor answers otherwise"], rows, machine)


def primary(arguments):
    """A scene's row: shares of rays from the eye, and three of its views as pictures, nearest to a probe first."""
    at, label, views = arguments[0], arguments[1], arguments[2].split(",")
    load = lambda end: json.loads(Path(f"{at}.{end}.json").read_text())
    race = load("race")
    row = {"label": label, "to_probe": " ".join(f"{race['views'][int(i)]['to_probe']:.2f}" for i in views)}
    for method in race["methods"]:
        key, one = slug(method["method"]), method["one_eye"]
        mean, each = one["mean"], [view["right_02"] for view in one["views"]]
        row |= {f"{key}_right_02": f"{100 * mean['right_02']:.2f}", f"{key}_right_1": f"{100 * mean['right_1']:.2f}", f"{key}_unknown": f"{100 * mean['unknown']:.2f}",
                f"{key}_reads": f"{mean['reads']:.1f}", f"{key}_ms": f"{mean['milliseconds']:.1f}", f"{key}_ends": f"{100 * each[0]:.1f} {100 * each[-1]:.1f}",
                f"{key}_least": f"{100 * min(each):.1f}"}
        for kind in ("two_eyes", "two_eyes_through_lenses"):
            other = method[kind]["mean"]
            row |= {f"{key}_{kind}_right_02": f"{100 * other['right_02']:.2f}", f"{key}_{kind}_times": f"{other['milliseconds'] / mean['milliseconds']:.2f}"}
    for picture in ("drawn", "seen"):
        errors = [load(f"{i}.{picture}.error") for i in views]
        row |= {f"{picture}_{metric}": " ".join(f"{error[metric]:.{digits}f}" for error in errors) for metric, digits in (("psnr", 1), ("flip", 3), ("mean", 2))}
        row[f"{picture}_ms"] = " ".join(f"{load(f'{i}.{picture}')['frame_ms']:.0f}" for i in views)
    print(f'  "{slug(label.split(",")[0])}": {json.dumps(row)},', flush=True)


def primaries(arguments):
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("primary_rays.json", "Rays from the eye through light fields, ten views a scene, and pictures of three", ["bench/pages/primary_table.sh"],
          ["right_02, right_1: %, a hit within that share of its own distance, or a true miss; ends: of the views nearest to a probe and farthest",
           "480x270; ms: of the trace; times: of two eyes in one pass over one eye; pictures: the nearest view, the middle one, the farthest; drawn: the whole frame with geometry",
           "cube faces of 208 and octahedral maps of 512 texels: equal memory; B0+ on our probes and on the fitted grid of as many"], rows)


def moving(arguments):
    """A scene's row: errors in the masks with the light told of what moves, over those without, and what telling costs."""
    at, label, poses = arguments[0], arguments[1], int(arguments[2])
    load = lambda end: json.loads(Path(f"{at}.{end}.json").read_text())
    row = {"label": label}
    for kind in ("figure", "door"):
        names = [f"{kind}.{i}" for i in range(poses)]
        for layer, mask in (("diffuse_indirect", "shadow"), ("glossy_indirect", "reflection"), ("beauty", "object")):
            pairs = [(load(f"{name}.told.{layer}.error"), load(f"{name}.untold.{layer}.error")) for name in names]
            pairs = [(told, untold) for told, untold in pairs if told and untold]
            if not pairs:
                continue
            total = lambda side, key: sum(pair[side][key] for pair in pairs) / len(pairs)
            row |= {f"{kind}_{mask}_mse_ratio": f"{total(0, 'mse') / total(1, 'mse'):.3f}", f"{kind}_{mask}_relmse": f"{total(0, 'relmse'):.4f}",
                    f"{kind}_{mask}_relmse_untold": f"{total(1, 'relmse'):.4f}", f"{kind}_{mask}_mean": f"{total(0, 'mean'):.3f}",
                    f"{kind}_{mask}_mean_untold": f"{total(1, 'mean'):.3f}", f"{kind}_{mask}_worst": f"{max(told['mse'] / untold['mse'] for told, untold in pairs):.2f}"}
            if mask != "reflection":
                continue
            for way in ("seen", "both"): # by rays that meet what the picture shows, of shapes untold and told
                of = [error for error in (load(f"{name}.{way}.{layer}.error") for name in names) if error]
                if len(of) != len(pairs):
                    sys.exit(f"{at}: {len(of)} of {len(pairs)} poses have errors of '{way}'")
                row |= {f"{kind}_{mask}_{way}_mse_ratio": f"{sum(error['mse'] for error in of) / len(of) / total(1, 'mse'):.3f}",
                        f"{kind}_{mask}_{way}_relmse": f"{sum(error['relmse'] for error in of) / len(of):.4f}", f"{kind}_{mask}_{way}_mean": f"{sum(error['mean'] for error in of) / len(of):.3f}"}
        seen = [load(f"{name}.seen") for name in names]
        traces = lambda frames: sum(frame["passes_ms"].get(name, 0.0) for frame in frames for name in ("glossy trace", "mirror trace"))
        if (untold := traces([load(f"{name}.untold") for name in names])) > 0:
            row |= {f"{kind}_seen_trace_ratio": f"{traces(seen) / untold:.3f}"}
        frames = [(load(f"{name}.told"), load(f"{name}.untold")) for name in names]
        row |= {f"{kind}_pass_ms": f"{sum(told['passes_ms'].get('moving shapes', 0.0) for told, _ in frames) / len(frames):.1f}",
                f"{kind}_frame_ratio": f"{sum(told['frame_ms'] for told, _ in frames) / sum(untold['frame_ms'] for _, untold in frames):.3f}"}
    print(f'  "{slug(label.split(",")[0])}": {json.dumps(row)},', flush=True)


def movings(arguments):
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("moving_shapes.json", "A walking figure of ten shapes and a door, eight poses each, that the field doesn't know", ["bench/pages/moving_table.sh"],
          ["masks by the reference with and without the shape: shadow and reflection: light of surfaces that stayed, where it changed by over a tenth; object: what shows it",
           "mse_ratio: of the mean squared error with the light told of the shapes over that without, means over poses; worst: of one pose",
           "seen, both: with --screen-trace, of shapes untold and told, over untold without; trace_ratio: time of the traces, seen over untold",
           "pass: over diffuse light and rough reflections; frame_ratio: the whole frame's time, told over untold"], rows)


def fly(arguments):
    """A flight's row: what a streamed field's frames are off by."""
    flight, settled, name = json.loads(Path(arguments[0]).read_text()), json.loads(Path(arguments[1]).read_text()), arguments[2]
    root = lambda key: f"{100 * flight['error'][key] ** 0.5:.1f}"
    row = {"label": f"{name}, {flight['resident']} of {flight['probes']} probes, {flight['speed']:.0f} m/s", "settled_flip": f"{settled['flip']:.3f}", "settled_mean": f"{settled['mean']:.3f}", "median_error": root("median"), "p90_error": root("p90"),
           "worst_error": root("worst"), "least_light": f"{flight['light']['least']:.3f}", "most_light": f"{flight['light']['most']:.3f}",
           "cut_frames": str(flight["cut"]["frames"]), "cut_light": f"{flight['cut']['first_light']:.2f}", "most_missing": f"{flight['most_missing']:.0f}", "read": str(flight["read"]), "mib": f"{flight['device_bytes'] / 2**20:.1f}",
           "whole_mib": f"{flight['whole_device_bytes'] / 2**20:.1f}", "p999_over_median": f"{flight['frame_ms']['p999'] / flight['frame_ms']['median']:.2f}",
           "copy_most_ms": f"{flight['copy_ms']['most']:.1f}"}
    print(f'  "{slug(name)}_{flight["resident"]}_{flight["speed"]:.0f}": {json.dumps(row)},', flush=True)


def flights(arguments):
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("streaming.json", "A camera that flies from probe to probe through a field whose maps come from its file, against the whole field", ["bench/pages/stream_table.sh"],
          ["error: root of the mean squared difference of indirect light, % of its mean; light: ratio of the means, of the worst frames",
           "settled: of the scene's first view once what it asks for has come, FLIP and mean over those of the whole field; 320x180, 100 frames at 60 a second, at most 2 probes copied in one; mib: of the field on the device, with what is on its way; read: probes from the file",
           "missing: of the probes that pixels and rays asked for; cut: frames until the error is below a tenth where the flight begins without a map on the device, and the first one's light"], rows)


def sparse(arguments):
    """A scene's rows: light at one pixel of some, by edges and without; and a flight at a ray for 16 pixels."""
    at, label, speeds = arguments[0], arguments[1], arguments[2].split()
    found = json.loads(Path(f"{at}.edges.json").read_text())
    row = {"label": label, "edges": str(found["edges"]), "find_ms": f"{found['find_ms']:.0f}"} | {kind: f"{100 * share:.1f}" for kind, share in found["pixels"].items()}
    row |= {"flip_whole": f"{found['frame']['smooth_flip']:.4f}", "flip_whole_smoothed": f"{found['frame']['smoothed_flip']:.4f}"}
    for every in (4, 16, 64):
        for way, of in found[f"every_{every}"].items():
            row |= {f"{way}_{every}_samples": f"{100 * of['samples']:.1f}", f"{way}_{every}_relmse": f"{of['relmse']:.4f}", f"{way}_{every}_flip": f"{of['flip']:.4f}",
                    f"{way}_{every}_flip_smooth": f"{of.get('smoothed_flip', of['smooth_flip']):.4f}"}
    print(json.dumps({"of": "edges", "key": slug(label.split(",")[0]), "row": row}), flush=True)
    for speed in speeds:
        flown = json.loads(Path(f"{at}.{speed}.json").read_text())
        row = {"label": f"{label}, {speed} m/s"}
        for way, of in (flown["ways"] | flown["reflections"]).items():
            row |= {f"{way}_rays": f"{100 * of['rays']:.1f}"} if "rays" in of else {}
            row |= {f"{way}_relmse": f"{of['error']:.4f}", f"{way}_flip": f"{of['flip']:.3f}", f"{way}_ghosts": f"{100 * of['ghosts']:.1f}"}
            # Light changes in hall alone.
            row |= {f"{way}_frames": "over 47" if of["frames_to_light"] is None else str(of["frames_to_light"]), f"{way}_ghosts_after": " ".join(f"{100 * of[f'ghosts_after_{i}']:.0f}" for i in (0, 8, 16, 32))} if label.startswith("hall") else {}
        print(json.dumps({"of": "cached", "key": slug(f"{label.split(',')[0]}_{speed}"), "row": row}), flush=True)


def sparses(arguments):
    lines = [json.loads(line) for line in Path(arguments[0]).read_text().splitlines()]
    rows = lambda of: {line["key"]: line["row"] for line in lines if line["of"] == of}
    write("edges_and_points.json", "Pictures whose light is known at one pixel of 4, 16 or 64, between edges of the scene and without them", ["bench/pages/sparse_table.sh"],
          ["320x180; all light but emission, before the surface's colour; samples: % of the pixels, with those that no sample says anything of; relMSE and FLIP against light at every pixel",
           "flip_smooth: against the same frame of 16 pixels for each, ways by edges with their edges smoothed; whole: of light at every pixel, without and with smoothed edges",
           "empty, simple, complex: % of the pixels, by their edges; find_ms: edges of the view and of shadows, on one core"], rows("edges"))
    write("cached_frames.json", "A flight at a ray from the eye for 16 pixels a frame, by what is kept over frames", ["bench/pages/sparse_table.sh"],
          ["320x180, 60 frames a second, against all rays of the same frame; ghosts: % of pixels off by over a quarter",
           "prefiltered, corrected, every, temporal: reflections alone, of frames with geometry, against those of all rays; rays: % of the pixels; corrected: textures of what prefiltered radiance lacks; every: --trace-every 16, temporal: kept, too; both trace what is sharp everywhere",
           "hall: half of a lamp's light goes at the middle frame; frames: until the picture's mean is right within 0.05; ghosts_after: at 0, 8, 16 and 32 frames"], rows("cached"))


def field_paths(arguments):
    """Of the lines that paths_table.sh prints, and over them least and most."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    own = list(rows.values())
    rows["all"] = {"label": "least and most", "scenes": str(len(own))} | {key: least_and_most([row[key] for row in own]) for key in own[0] if key != "label"}
    write("field_paths.json", "Paths through a light field, rays on the device, against paths through triangles by as many paths a pixel", ["bench/pages/paths_table.sh"],
          ["_N: N rays a path on a field of direct light, against a reference of N - 1 bounces; _all: one ray on a field of all bounces, against 16; 160x90, 64 paths a pixel, pixels in which both see the same surface",
           "mean: over the reference's; endless: relMSE that more paths don't take away, of halves of the paths, below zero by noise; right: of the last ray of all paths, %, within 1 % of the true distance",
           "trace_s: of our rays on the device; s: with what the host does between them; theirs: Embree's path tracer on the same cores, with draws of emitters, which ours has none of; frame: the default's, of the field of all bounces"], rows)


def surfaces(arguments):
    """Of the lines that surface_table.sh prints; scenes that they lack keep their rows, and the commit that those were measured with."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    before = json.loads((ROOT / "bench/results/surface_light.json").read_text())
    others = {key: row | {"commit": row.get("commit", before["commit"])} for key, row in before["rows"].items() if key not in rows}
    notes = ["relMSE without the reference's noise, FLIP and mean over the reference's of the layer diffuse_indirect, of pixels in which both see the same surface; glossy: of glossy_indirect",
             "ms of one frame of 960x540: gathering, surface light, area light, diffuse filter and lamps; alone: of diffuse light without rough reflections", "kib: of a light field, a probe"]
    if others:
        notes.append(f"measured before, of the commit in the row: {', '.join(row['label'].rpartition(',')[0] for row in others.values())}; their relMSE may have the reference's noise in it")
    write("surface_light.json", "Diffuse light read at surfaces against irradiance with shadowed samples and a filter; 320x180, maps of 256, at most 8 bounces, against 512 paths a pixel "
          "(Sponza: 2,048) and 8 bounces", ["bench/pages/surface_table.sh"], notes, {key: rows.get(key) or others[key] for key in before["rows"]})


def day(arguments):
    """Of the lines that day_sheet.sh prints, and over them least and most."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    own = list(rows.values())
    rows["all"] = {"label": "least and most", "hours": str(len(own))} | {key: least_and_most([row[key] for row in own]) for key in own[0] if key != "label"}
    write("day.json", "A day in Sponza: one field with live links, its sky a group, under six suns and skies, against the path tracer", ["bench/pages/day_sheet.sh"],
          ["256x144, 192 paths a pixel of up to 16 bounces, pixels in which both see the same surface; mean: over the reference's"], rows)


def gallery(arguments):
    """Of the lines that gallery.sh prints."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("gallery.json", "Whole pictures of scenes against the path tracer: ours with every default but the ones named", ["bench/pages/gallery.sh"],
          ["1280x720, 16 frames blended over time, maps of 256 texels a face; reference: 128 paths a pixel of up to 16 bounces, through the pixel's centre; "
           "pixels in which both see the same surface; mean: over the reference's; truths_own: relMSE of the reference by its noise, of indirect light"], rows)


def each_effect(arguments):
    """Of the lines that effects_sheet.sh prints."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("each_effect.json", "Each effect alone, one ray a pixel, 160x90, against the path tracer (256 paths a pixel, 4 bounces), the layer that it makes", ["bench/pages/effects_sheet.sh"],
          ["passes in ms of one frame; sun is judged with the whole of direct light"], rows)


def covered(arguments):
    path, name, count, asked = arguments
    lines = {line.split()[0]: line.split() for line in Path(path).read_text().splitlines()[2:]}
    row = {"label": name, "probes": count, "bound": lines["bound"][2]}
    for key, method in (("yardstick", "yardstick"), ("grid", "grid"), ("ours", "gradient")):
        probes, rays, area, _, _, quality, seconds, cpu = lines[method][1:9]
        row |= {f"{key}_rays": rays, f"{key}_area": area, f"{key}_quality": quality, f"{key}_seconds": seconds, f"{key}_cpu": cpu} | ({f"{key}_probes": probes} if probes != count else {})
    print(f'  "{slug(name)}_{count}": {json.dumps(row | {"asked": asked})},', flush=True)


def coverage(arguments):
    """Of the lines that coverage_table.sh prints."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("placement_coverage.json", "Coverage of placements, % of ray hits and of area, quality of views, and seconds of placing, on samples no placement used", ["bench/pages/coverage_table.sh"],
          ["60,000 points: the standard error at 99.7 % is 0.02 %", "bound: share of the same points that some position which keeps the clearance sees (300 directions x 12 depths before each point)",
           "yardstick: plain greedy cover over 1,500 random free points in the same free space; grid: the pose of place --fit-grid's twelve that sees most; _probes: where it has another number",
           "quality: mean of cosine x spacing / (spacing + distance) of the best view; cpu: user and system"], rows)


def reflections(arguments):
    """Of the lines that placement_pictures.sh prints, and by how many per cent FLIP is less in views that see what some probe of the grid sees, but for Sponza's."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    less = [f"{100 * (1 - float(row['ours_flip']) / float(row['grid_flip'])):.0f}" for key, row in rows.items() if not key.startswith("sponza") and row["camera"] not in ("cella", "door")]
    rows["all"] = {"label": "least and most", "others_less": least_and_most(less)}
    write("placement_pictures.json", "Reflections at equal count: every surface at roughness 0.15, 64 rays a pixel, no filter, --bounces 0", ["bench/pages/placement_pictures.sh"],
          ["grid: of place --fit-grid; others_less: per cent less FLIP of ours in temple's main and colonnade and in modern_hall; errors hold the reference's noise of 256 paths"], rows)


def pipeline(arguments):
    """Of the lines that scene_table.sh prints."""
    rows = json.loads("{" + Path(arguments[0]).read_text().rstrip().rstrip(",") + "}")
    write("scene_pipeline.json", "Every scene through the whole pipeline: 32 probes, cube faces of 256 texels, frames of 480x270, one glossy ray a pixel", ["bench/pages/scene_table.sh"],
          ["MB is the peak resident memory of the step before it", "covered, %: share of the surface points hit by random rays from the reachable space that some probe sees",
           "triangles are those left after degenerate and fully transparent ones are dropped"], rows)


def least_and_most(texts):
    numbers = sorted((float(text), text) for text in texts if text != "nan")
    return f"{numbers[0][1]} to {numbers[-1][1]}" if numbers else ""


if __name__ == "__main__":
    modes = {"methods": methods, "knobs": knobs, "rays": rays, "resolution": resolution, "orders": orders, "compact": compact, "walls": walls, "steps": steps, "placed": placed, "response": response, "bounces": bounces, "effects": effects,
             "gpu": gpu, "primary": primary, "primaries": primaries, "moving": moving, "movings": movings, "field_paths": field_paths, "sparse": sparse, "sparses": sparses, "surfaces": surfaces, "day": day, "gallery": gallery, "each_effect": each_effect, "covered": covered, "coverage": coverage, "reflections": reflections, "pipeline": pipeline, "fly": fly, "flights": flights}
    if len(sys.argv) < 3 or sys.argv[1] not in modes:
        sys.exit(__doc__)
    modes[sys.argv[1]](sys.argv[2:])
