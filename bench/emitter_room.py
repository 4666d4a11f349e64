#!/usr/bin/env python3
"""A furnished room under N equal square lamps, as glTF on stdout: what light of many emitters costs. All lamps together always shine alike.
With --glossy the farthest box, small on screen, is of smooth metal: what one glossy object costs.
emitter_room.py N [--glossy] > room.gltf"""
import base64, json, math, struct, sys

count = int(sys.argv[1])
positions, normals, primitives = [], [], {}


def quad(a, u, v, material):
    """Corner and edges; the front is where u x v points."""
    n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
    length = math.sqrt(sum(c * c for c in n))
    first = len(positions)
    for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
        positions.append([a[i] + s * u[i] + t * v[i] for i in range(3)])
        normals.append([c / length for c in n])
    primitives.setdefault(material, []).extend(first + k for k in (0, 1, 2, 0, 2, 3))


def box(low, high, material, inward=False):
    x, y, z = ([high[0] - low[0], 0, 0], [0, high[1] - low[1], 0], [0, 0, high[2] - low[2]])
    shift = lambda a, e: [a[i] + e[i] for i in range(3)]
    for a, u, v in ((low, y, x), (shift(low, z), x, y), (low, z, y), (shift(low, x), y, z), (low, x, z), (shift(low, y), z, x)):
        quad(a, *((v, u) if inward else (u, v)), material)


box([-4, 0, -4], [4, 3, 4], 0, inward=True)
for x, z, height in ((-2, -2, 1.0), (1.5, -1, 1.6), (-1, 1.5, 0.6), (2.5, 2, 2.0)):
    box([x - 0.4, 0.001, z - 0.4], [x + 0.4, height, z + 0.4], 3 if x == -2 and "--glossy" in sys.argv else 1)
across = math.ceil(math.sqrt(count))
side = 0.8 / math.sqrt(count)  # 0.64 m^2 in all
for i in range(count):
    x, z = ((k + 0.5) / across * 7 - 3.5 for k in (i % across, i // across))
    quad([x - side / 2, 2.9, z - side / 2], [side, 0, 0], [0, 0, side], 2)

blob = b"".join(struct.pack("<3f", *p) for p in positions) + b"".join(struct.pack("<3f", *n) for n in normals)
views = [{"buffer": 0, "byteOffset": 0, "byteLength": 12 * len(positions)}, {"buffer": 0, "byteOffset": 12 * len(positions), "byteLength": 12 * len(positions)}]
bounds = {f.__name__: [f(p[i] for p in positions) for i in range(3)] for f in (min, max)}
accessors = [{"bufferView": 0, "componentType": 5126, "count": len(positions), "type": "VEC3", **bounds},
             {"bufferView": 1, "componentType": 5126, "count": len(positions), "type": "VEC3"}]
meshes = []
for material, indices in primitives.items():
    views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4 * len(indices)})
    blob += struct.pack(f"<{len(indices)}I", *indices)
    accessors.append({"bufferView": len(views) - 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"})
    meshes.append({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": len(accessors) - 1, "material": material})
diffuse = lambda name, color: {"name": name, "doubleSided": True, "pbrMetallicRoughness": {"baseColorFactor": color + [1], "metallicFactor": 0, "roughnessFactor": 1}}
lamp = diffuse("lamp", [0, 0, 0]) | {"emissiveFactor": [1, 0.9, 0.8], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 12}}}
metal = {"name": "metal", "pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.8, 0.6, 1], "metallicFactor": 1, "roughnessFactor": 0.2}}
turn = math.radians(-12)
json.dump({"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0, "scenes": [{"nodes": [0, 1]}],
           "nodes": [{"mesh": 0}, {"camera": 0, "translation": [0, 1.7, 3.8], "rotation": [math.sin(turn / 2), 0, 0, math.cos(turn / 2)]}],
           "cameras": [{"name": "view", "type": "perspective", "perspective": {"yfov": 1.1, "znear": 0.01}}],
           "meshes": [{"primitives": meshes}], "accessors": accessors, "bufferViews": views,
           "materials": [diffuse("wall", [0.7, 0.68, 0.64]), diffuse("box", [0.5, 0.3, 0.2]), lamp, metal],
           "buffers": [{"byteLength": len(blob), "uri": "data:application/octet-stream;base64," + base64.b64encode(blob).decode()}]}, sys.stdout)
