#!/usr/bin/env python3
"""A closed box, 2 m wide about the origin, all of whose walls emit 1 W/(m^2 sr) and reflect about half of what arrives, as glTF on stdout: the same
light everywhere in it, which one can write down."""
import pathlib, sys

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "bench/pages"))
from gltf_room import Room, surface

room = Room()
room.box([-1, -1, -1], [1, 1, 1], 0, inward=True)
room.write(sys.stdout, [surface("wall", [0.5, 0.5, 0.5]) | {"emissiveFactor": [1, 1, 1]}], eye=[0, 0, 0.9], down=0, fov=1)
