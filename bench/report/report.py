#!/usr/bin/env python3
"""report.py FOLDER SCENE SECONDS: joins the JSON results of bench/run.sh into results.json, report.md and index.html, and prints the table."""

import html
import json
import os
import platform
import sys

STEPS = ["place_ours", "place_grid", "bake_ours", "bake_grid", "reference", "render_ours", "render_b0plus", "compare_ours", "compare_b0plus", "rays"]


def load(folder):
    results = {}
    for step in STEPS:
        with open(os.path.join(folder, step + ".json"), encoding="utf-8") as file:
            results[step] = json.load(file)
    return results


def figure(value, digits=4):
    return "-" if value is None else f"{value:.{digits}g}" if isinstance(value, float) else str(value)


def table(r):
    """Rows of (what, ours, uniform grid with B0+)."""
    pairs = [("place_ours", "place_grid"), ("bake_ours", "bake_grid"), ("render_ours", "render_b0plus"), ("compare_ours", "compare_b0plus")]
    wanted = [
        (0, "probes", lambda j: j["probes"]),
        (0, "surface seen by rays, %", lambda j: 100.0 * j["coverage"]["rays"]),
        (0, "placement, s", lambda j: j["seconds"]),
        (1, "light field, MB", lambda j: j["bytes"]["total"] / 1e6),
        (1, "of it index, MB", lambda j: j["bytes"]["index"] / 1e6),
        (1, "bake, s", lambda j: j["seconds"]),
        (1, "bake, peak host memory, MB", lambda j: j["peak_rss_mb"]),
        (2, "frame, ms", lambda j: j.get("frame_ms")),
        (2, "unresolved glossy rays, %", lambda j: None if j.get("unknown_share") is None else 100.0 * j["unknown_share"]),
        (3, "MSE", lambda j: j["mse"]),
        (3, "relMSE", lambda j: j["relmse"]),
        (3, "PSNR, dB", lambda j: j["psnr"]),
        (3, "FLIP", lambda j: j["flip"]),
    ]
    rows = [(name, figure(get(r[pairs[pair][0]])), figure(get(r[pairs[pair][1]]))) for pair, name, get in wanted]
    rays = [  # of 100,000 glossy rays against Embree
        ("rays right within 1 % of the diagonal, %", lambda j: 100.0 * j["right_1"]),
        ("rays right within 0.2 %, %", lambda j: 100.0 * j["right_02"]),
        ("false hits, %", lambda j: 100.0 * j["false"]),
        ("leaks, %", lambda j: 100.0 * j["leak"]),
        ("unresolved, %", lambda j: 100.0 * j["unresolved"]),
        ("distance reads a ray", lambda j: j["distance_reads"]["mean"]),
        ("hand-offs a ray", lambda j: j["handoffs_mean"]),
        ("trace of 50,000 rays in the order of pictures, ms", lambda j: j["coherent_ms"]["median"]),
    ]
    return rows + [(name, figure(get(r["rays"][0])), figure(get(r["rays"][1]))) for name, get in rays]


def main():
    folder, scene, seconds = sys.argv[1], sys.argv[2], int(sys.argv[3])
    results = load(folder)
    rows = table(results)
    machine = {"cpu_count": os.cpu_count(), "machine": platform.machine(), "device": results["render_ours"].get("device") or results["bake_ours"].get("device")}
    document = {"schema": 1, "scene": scene, "seconds": seconds, "machine": machine, "table": [list(row) for row in rows], "steps": results}
    with open(os.path.join(folder, "results.json"), "w", encoding="utf-8") as file:
        json.dump(document, file, indent=2)

    head = ("", "Sconce", "uniform grid, B0+")
    reference = results["reference"]
    caption = (
        f"{reference['width']}x{reference['height']}; reference: {reference['spp']} paths a pixel, estimated relMSE {figure(reference['estimated_relmse'])}, "
        f"{figure(reference['seconds'])} s; device: {machine['device']}; {machine['cpu_count']} cores; whole run {seconds} s"
    )
    markdown = [f"# {scene}", "", caption, "", "| | Sconce | uniform grid, B0+ |", "| --- | ---: | ---: |"]
    markdown += [f"| {' | '.join(row)} |" for row in rows]
    pictures = [("reference.png", "reference"), ("ours.png", "Sconce"), ("b0plus.png", "uniform grid, B0+"), ("error_ours.png", "error, Sconce"), ("error_b0plus.png", "error, B0+")]
    markdown += [""] + [f"![{text}]({file})" for file, text in pictures]
    with open(os.path.join(folder, "report.md"), "w", encoding="utf-8") as file:
        file.write("\n".join(markdown) + "\n")

    cells = "".join("<tr><th>" + "</th><td>".join(html.escape(cell) for cell in row) + "</td></tr>" for row in rows)
    figures = "".join(f'<figure><img src="{file}" alt="{text}"><figcaption>{text}</figcaption></figure>' for file, text in pictures)
    page = (
        f'<!doctype html><html lang="en"><meta charset="utf-8"><title>{html.escape(scene)}</title>'
        "<style>body{font:16px sans-serif;margin:2em;max-width:80em}td{text-align:right;padding:0 1em}th{text-align:left;font-weight:normal}"
        "figure{display:inline-block;margin:.5em}img{max-width:100%}</style>"
        f"<h1>{html.escape(scene)}</h1><p>{html.escape(caption)}</p><table><tr><th></th><td>{head[1]}</td><td>{head[2]}</td></tr>{cells}</table>{figures}</html>"
    )
    with open(os.path.join(folder, "index.html"), "w", encoding="utf-8") as file:
        file.write(page)

    widths = [max(len(row[i]) for row in [head] + rows) for i in range(3)]
    print(f"\n{scene}: {caption}")
    for row in [head] + rows:
        print(f"  {row[0]:<{widths[0]}}  {row[1]:>{widths[1]}}  {row[2]:>{widths[2]}}")
    print(f"report: {os.path.join(folder, 'index.html')}")


if __name__ == "__main__":
    main()
