#!/usr/bin/env python3
"""A walking figure of ten capsules, or a door that opens, as `sconce render --shapes` takes it. Prints JSON.

moving_shapes.py figure|door X,Y,Z ABOUT_Y PHASE    place on the ground, metres; degrees; 0 to 1, of a step or of the door's swing
"""
import json
import math
import sys

kind, at, about, phase = sys.argv[1], [float(x) for x in sys.argv[2].split(",")], math.radians(float(sys.argv[3])), float(sys.argv[4])
SKIN, COAT, CLOTH = [0.55, 0.38, 0.30], [0.45, 0.10, 0.08], [0.10, 0.13, 0.25]


def placed(p):
    """From the figure's own metres, x to its side, z ahead, to the world's."""
    c, s = math.cos(about), math.sin(about)
    return [at[0] + c * p[0] + s * p[2], at[1] + p[1], at[2] - s * p[0] + c * p[2]]


def turn(direction):
    """Quaternion that turns y into a unit direction."""
    x, y, z = direction
    if y < -0.9999:
        return [1.0, 0.0, 0.0, 0.0]
    size = math.sqrt(z * z + x * x + (1.0 + y) ** 2)
    return [z / size, 0.0, -x / size, (1.0 + y) / size]


def limb(a, b, radius, albedo):
    a, b = placed(a), placed(b)
    along = [q - p for p, q in zip(a, b)]
    length = math.sqrt(sum(v * v for v in along))
    return {"kind": "capsule", "centre": [(p + q) / 2 for p, q in zip(a, b)], "half": [radius, length / 2, 0], "turn": turn([v / length for v in along]), "albedo": albedo}


def figure():
    shapes = [limb((0, 1.0, 0), (0, 1.4, 0), 0.17, COAT), {"kind": "sphere", "centre": placed((0, 1.68, 0)), "half": [0.12, 0, 0], "albedo": SKIN}]
    for side in (-1, 1):
        swing = 0.5 * side * math.sin(2 * math.pi * phase)
        hip, knee = (0.1 * side, 0.92, 0), (0.1 * side, 0.5, 0.42 * math.sin(swing))
        foot = (0.1 * side, 0.08, knee[2] + 0.42 * math.sin(swing - 0.3 * max(swing, 0)))
        shoulder, elbow = (0.24 * side, 1.4, 0), (0.26 * side, 1.12, -0.28 * math.sin(swing))
        hand = (0.24 * side, 0.9, elbow[2] + 0.1)
        shapes += [limb(hip, knee, 0.08, CLOTH), limb(knee, foot, 0.065, CLOTH), limb(shoulder, elbow, 0.05, COAT), limb(elbow, hand, 0.045, SKIN)]
    return shapes


def door():
    angle = about + math.radians(100.0 * phase)
    middle = [at[0] + 0.45 * math.cos(angle), at[1] + 1.02, at[2] - 0.45 * math.sin(angle)]
    return [{"kind": "box", "centre": middle, "half": [0.45, 1.0, 0.025], "turn": [0, math.sin(angle / 2), 0, math.cos(angle / 2)], "albedo": [0.46, 0.28, 0.13]}]


print(json.dumps({"shapes": figure() if kind == "figure" else door()}))
