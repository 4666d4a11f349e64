#!/usr/bin/env python3
"""Two rooms side by side, open to the viewer, as glTF on stdout: bright and warm the left one, a hundred times darker and blue the right one.
Between them a wall, THICKNESS centimetres thick, or `curtain`: a wavy sheet without thickness. Light that leaks shows on the right.
divided_room.py THICKNESS|curtain > room.gltf"""
import math, sys

from gltf_room import Room, lamp, surface

room = Room()
FRONT = (1,)  # the side that is open
if sys.argv[1] == "curtain":
    room.box([-3, 0, -3], [3, 2.6, 1], 0, inward=True, without=FRONT)
    at = lambda i: [0.06 * math.sin(math.pi * i / 4), 0, -3 + i / 12]
    for i in range(48):
        a, b = at(i), at(i + 1)
        room.quad(a, [b[k] - a[k] for k in range(3)], [0, 2.6, 0], 3)
else:
    half = 0.005 * float(sys.argv[1])
    room.box([-3, 0, -3], [-half, 2.6, 1], 0, inward=True, without=FRONT)
    room.box([half, 0, -3], [3, 2.6, 1], 0, inward=True, without=FRONT)
    room.quad([-half, 0, 1], [2 * half, 0, 0], [0, 2.6, 0], 0)  # the wall's end
for side, material in ((-1, 1), (1, 2)):
    room.quad([1.5 * side - 0.3, 2.5, -1.3], [0.6, 0, 0], [0, 0, 0.6], material)
    room.box([1.5 * side - 0.4, 0.001, -2.2], [1.5 * side + 0.2, 1.0, -1.6], 0)
room.write(sys.stdout, [surface("wall", [0.7, 0.7, 0.7]), lamp("warm", [1, 0.75, 0.5], 30), lamp("blue", [0.3, 0.5, 1], 0.3), surface("cloth", [0.7, 0.7, 0.7])],
           eye=[0, 1.3, 4.2], down=0, fov=0.75)
