#!/usr/bin/env python3
"""A closed box of black metal, 2 m wide about the origin, below whose ceiling a small square shines down, as glTF on stdout: so far away for its size
that a bake keeps it as a lamp, whose light on the floor one can write down."""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "bench/pages"))
from gltf_room import Room, lamp, surface

room = Room()
room.box([-1, -1, -1], [1, 1, 1], 0, inward=True)
room.quad([-0.03, 0.9, -0.03], [0.06, 0, 0], [0, 0, 0.06], 1)
room.write(sys.stdout, [surface("wall", [0, 0, 0], metallic=1), lamp("lamp", [1, 1, 1], 1000) | {"doubleSided": False}], eye=[0, 0, 0.9], down=0, fov=1)
