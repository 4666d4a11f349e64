#!/usr/bin/env python3
"""Bytes that a pixel of a frame reads and writes, pass by pass, from the formats that the built passes name; and bytes of its images.

frame_bytes.py BUILD GUARD [--write] [--print]

BUILD is the build's folder, GUARD the file of what was found before: more bytes of a pass fail. --write keeps what is found now. A pass counts for each
image once what it reads and once what it writes: taps of neighbours are taken to hit a cache. It counts as if it ran at every pixel, and an image that a
constant switches off as if it were on, but for those below. Buffers aren't counted: lists take half a byte.
"""
import json
import pathlib
import struct
import sys

# A sampled image's format is the host's alone.
G_BUFFER = {"gDepth": 4, "gNormalRoughness": 8, "gBaseColorMetallic": 8, "gGeometricNormal": 4}  # as SceneRenderer::make() has them
EMISSION = 8  # which is drawn beside them, into the direct light
SAMPLED = {"direct": 8, "diffuse": 8, "rough": 8, "glossy": 8, "mirror": 8, "before": 8, "pointsBefore": 4, "pictureBefore": 16}  # light as it is stored, and its points
TEXEL_BYTES = {1: 16, 2: 8, 3: 4, 30: 16, 33: 4, 35: 8}  # of SPIR-V's formats: Rgba32f, Rgba16f, R32f, Rgba32ui, R32ui, Rg32ui
READ_PIXEL = {"gDepth", "gNormalRoughness", "gBaseColorMetallic"}
# The command's frame without layers: passes, how often each runs, and images that it doesn't touch.
FRAME = {
    "direct light": ("direct_comp", 1, set()),
    "classify tiles": ("classify_tiles_comp", 1, set()),
    "surface light": ("surface_light_comp", 1, READ_PIXEL),  # of the few look-ups that are left to its second dispatch
    "gather light": ("gather_light_comp", 1, set()),
    "glossy or mirror trace": ("trace_glossy_comp", 1, {"counts", "packedPixels", "pictureBefore"}),
    "glossy denoise, steps 1 to 3": ("denoise_comp", 3, READ_PIXEL),
    "glossy denoise, last step": ("denoise_comp", 1, set()),
    "compose": ("compose_comp", 1, {"diffuseLayer", "glossyLayer", "mirror"}),
}
# What else a frame can have.
MORE = {
    "lamp light": ("lamp_light_comp", 1, {"glossy", "mirror"}),
    "glossy fill": ("reconstruct_comp", 1, READ_PIXEL),
    "glossy blend over time": ("temporal_comp", 1, READ_PIXEL),
    "area light": ("area_light_comp", 1, set()),
    "diffuse denoise": ("denoise_comp", 4, READ_PIXEL),
    "moving shapes": ("moving_light_comp", 1, set()),
    "glossy or mirror trace over the picture": ("trace_glossy_comp", 1, {"counts", "packedPixels"}),
}


def instructions(file):
    words = struct.unpack(f"<{file.stat().st_size // 4}I", file.read_bytes())
    at = 5
    while at < len(words):
        count = words[at] >> 16
        yield words[at] & 0xFFFF, words[at + 1 : at + count]
        at += count


def text_of(words):
    return b"".join(struct.pack("<I", word) for word in words).split(b"\0")[0].decode()


def images_of(file):
    """Of each image that some function of a pass touches: name, whether it is read and written, bytes of a texel; None: the host's format."""
    names, images, pointers, variables, flags, loaded = {}, {}, {}, {}, {}, {}
    reads, writes = set(), set()
    for op, args in instructions(file):
        if op == 5:
            names[args[0]] = text_of(args[1:])
        elif op == 25:
            if args[2] == 1 and args[4] == 0:  # of two dimensions, no array: no maps of lights or of the field
                images[args[0]] = args[7]
        elif op == 32:
            pointers[args[0]] = args[2]
        elif op == 59 and pointers.get(args[0]) in images:
            variables[args[1]] = images[pointers[args[0]]]
        elif op == 61 and args[2] in variables:
            loaded[args[1]] = args[2]
        elif op in (95, 98):
            reads.add(loaded.get(args[2]))
        elif op == 99:
            writes.add(loaded.get(args[0]))
    return [(names[v], v in reads, v in writes, TEXEL_BYTES.get(variables[v])) for v in variables if v in reads or v in writes]


def bytes_of(file, without):
    read = written = 0
    for name, reads, writes, texel in images_of(file):
        if name in without:
            continue
        texel = (G_BUFFER | SAMPLED)[name] if texel is None else texel
        read, written = read + texel * reads, written + texel * writes
    return read, written


def main():
    folder = pathlib.Path(sys.argv[1], "shaders/spirv")
    guard = pathlib.Path(sys.argv[2])
    found = {"G-buffer": {"read": 0, "written": sum(G_BUFFER.values()) + EMISSION}}
    for name, (spirv, times, without) in (FRAME | MORE).items():
        read, written = bytes_of(folder / f"{spirv}.spv", without)
        found[name] = {"read": read * times, "written": written * times}
    found["frame"] = {way: sum(one[way] for name, one in found.items() if name not in MORE) for way in ("read", "written")}
    if "--print" in sys.argv:
        for name, one in found.items():
            print(f"{name:30} {one['read']:4} + {one['written']:3}")
    if "--write" in sys.argv:
        guard.write_text(json.dumps({"bytes a pixel": found}, indent=1) + "\n", encoding="utf-8")
        return
    kept = json.loads(guard.read_text(encoding="utf-8"))["bytes a pixel"]
    wrong = [f"{name}: {one} bytes a pixel, {kept.get(name)} before" for name, one in found.items() if name not in kept or sum(one.values()) > sum(kept[name].values())]
    if wrong or kept.keys() - found.keys():
        sys.exit("\n".join(wrong + sorted(f"{name} is no pass any more" for name in kept.keys() - found.keys())))


if __name__ == "__main__":
    main()
