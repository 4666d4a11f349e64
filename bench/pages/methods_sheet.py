#!/usr/bin/python3
"""Diffuse light of a view by several methods: a row of pictures, truth first, at one exposure, and below it by how much each is off: white where it is the
truth, red above, blue below, full at a factor of two. A pair of rows a view.
methods_sheet.py OUT.png METHOD,METHOD... RESULTS.json[=SCENE]...     of `sconce bench` (bench/pages/methods_table.sh)"""
# The system's Python, not the first of the path: packages.txt installs Pillow for that one.
import json
import math
import struct
import sys
from pathlib import Path

from PIL import Image

LAYER, LARGEST = "diffuse", 2.0


def read_half(file):
    """Width, height, pixels as (r, g, b)."""
    data = file.read_bytes()
    magic, width, height, kind = struct.unpack_from("<4sIII", data)
    if magic != b"SCNI" or kind != 0:
        sys.exit(f"{file} is no picture of colours")
    values = struct.unpack_from(f"<{3 * width * height}e", data, 16)
    return width, height, list(zip(values[0::3], values[1::3], values[2::3]))


def luminance(pixel):
    return 0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2]


def shown(pixels, width, height, exposure):
    to_byte = lambda x: round(255 * min(1.0, max(0.0, 1.0 - math.exp(-exposure * x))) ** (1 / 2.2))
    picture = Image.new("RGB", (width, height))
    picture.putdata([tuple(to_byte(c) & 0xF8 for c in pixel) for pixel in pixels])
    return picture


def off(pixels, truth, width, height, floor):
    """How far off, smoothed by 3x3 so that noise of either doesn't hide it."""
    def blurred(of):
        lights = [luminance(pixel) for pixel in of]
        out = []
        for y in range(height):
            rows = range(max(0, y - 1), min(height, y + 2))
            for x in range(width):
                columns = range(max(0, x - 1), min(width, x + 2))
                out.append(sum(lights[row * width + column] for row in rows for column in columns) / (len(rows) * len(columns)))
        return out

    colours = []
    for ours, theirs in zip(blurred(pixels), blurred(truth)):
        k = math.log((ours + floor) / (theirs + floor)) / math.log(LARGEST) if theirs > 0 or ours > 0 else 0.0
        fade = 255 - (round(255 * min(1.0, abs(k))) & 0xF8)
        colours.append((255, fade, fade) if k > 0 else (fade, fade, 255))
    picture = Image.new("RGB", (width, height))
    picture.putdata(colours)
    return picture


def main():
    if len(sys.argv) < 4:
        sys.exit(__doc__)
    out, methods, rows = sys.argv[1], sys.argv[2].split(","), []
    for argument in sys.argv[3:]:
        name, _, wanted = argument.partition("=")
        folder = Path(name).parent
        for scene in json.loads(Path(name).read_text())["scenes"]:
            if wanted and scene["name"] != wanted:
                continue
            width, height, truth = read_half(folder / scene["reference"]["images"][LAYER])
            of = {point["method"]: point["images"][LAYER] for point in scene["points"] if point["knob"] == "default" and "images" in point}
            lit = [luminance(pixel) for pixel in truth if luminance(pixel) > 0]
            exposure = 0.35 / math.exp(sum(map(math.log, lit)) / len(lit))
            floor = 0.02 * sum(lit) / len(lit)
            pictures, errors = [shown(truth, width, height, exposure)], [Image.new("RGB", (width, height), "white")]
            for method in methods:
                pixels = read_half(folder / of[method])[2]
                pictures.append(shown(pixels, width, height, exposure))
                errors.append(off(pixels, truth, width, height, floor))
            rows += [pictures, errors]
    width, height = rows[0][0].size
    sheet = Image.new("RGB", ((1 + len(methods)) * width, len(rows) * height))
    for y, row in enumerate(rows):
        for x, picture in enumerate(row):
            sheet.paste(picture.resize((width, height)), (x * width, y * height))
    sheet.save(out, optimize=True)


if __name__ == "__main__":
    main()
