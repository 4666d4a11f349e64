#!/usr/bin/env python3
"""A furnished room under N equal square lamps, as glTF on stdout: what light of many emitters costs. All lamps together always shine alike.
With --glossy the farthest box, small on screen, is of smooth metal: what one glossy object costs. With --point a point light shines, too.
With --guest there is one more box, of glossy metal, in the midst: an object that a field baked without it doesn't know.
emitter_room.py N [--glossy] [--point] [--guest] > room.gltf"""
import math, sys

from gltf_room import Room, lamp, surface

count, room = int(sys.argv[1]), Room()
room.box([-4, 0, -4], [4, 3, 4], 0, inward=True)
for x, z, height in ((-2, -2, 1.0), (1.5, -1, 1.6), (-1, 1.5, 0.6), (2.5, 2, 2.0)):
    room.box([x - 0.4, 0.001, z - 0.4], [x + 0.4, height, z + 0.4], 3 if x == -2 and "--glossy" in sys.argv else 1)
if "--guest" in sys.argv:
    room.box([-0.5, 0.001, -0.9], [0.3, 1.3, -0.1], 3)
across = math.ceil(math.sqrt(count))
for i in range(count):
    side = 0.8 / math.sqrt(count)  # 0.64 m^2 in all
    x, z = ((k + 0.5) / across * 7 - 3.5 for k in (i % across, i // across))
    room.quad([x - side / 2, 2.9, z - side / 2], [side, 0, 0], [0, 0, side], 2)
materials = [surface("wall", [0.7, 0.68, 0.64]), surface("box", [0.5, 0.3, 0.2]), lamp("lamp", [1, 0.9, 0.8], 12), surface("metal", [0.9, 0.8, 0.6], 0.2, 1)]
room.write(sys.stdout, materials, eye=[0, 1.7, 3.8], down=12, fov=1.1, point_lights=[([0.2, 2.3, 0.4], [6, 5.4, 4.8])] if "--point" in sys.argv else [])
