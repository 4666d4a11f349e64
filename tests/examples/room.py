#!/usr/bin/env python3
"""A room that has in it all that a host must get right, as glTF on stdout: the sun through an open roof, a lamp, walls of all roughnesses with a
mirror among them and one that shows its back, textures of every kind, nodes that are turned and scaled unevenly, and two cameras.
room.py > room.gltf"""
import base64, io, json, math, pathlib, struct, sys, zlib

sys.path.append(str(pathlib.Path(__file__).resolve().parents[2] / "bench/pages"))
from gltf_room import Room, lamp, surface


def png(size, color_at):
    """size x size pixels of RGB."""
    rows = b"".join(b"\0" + bytes(c for x in range(size) for c in color_at(x, y)) for y in range(size))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    header = struct.pack(">2I5B", size, size, 8, 2, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


def mesh_of(room):
    """A glTF of one mesh, with texture coordinates by place, of the plane that a normal is nearest to; a unit is a metre."""
    text = io.StringIO()
    room.write(text, materials, eye=[0, 1.3, 1.9], down=8, fov=1.0)
    gltf = json.loads(text.getvalue())
    planes = [max(range(3), key=lambda i: abs(n[i])) for n in room.normals]
    uvs = b"".join(struct.pack("<2f", p[(axis + 1) % 3], p[(axis + 2) % 3]) for p, axis in zip(room.positions, planes))
    gltf["buffers"].append({"byteLength": len(uvs), "uri": uri("application/octet-stream", uvs)})
    gltf["bufferViews"].append({"buffer": 1, "byteLength": len(uvs)})
    gltf["accessors"].append({"bufferView": len(gltf["bufferViews"]) - 1, "componentType": 5126, "count": len(room.positions), "type": "VEC2"})
    for primitive in gltf["meshes"][0]["primitives"]:
        primitive["attributes"]["TEXCOORD_0"] = len(gltf["accessors"]) - 1
    return gltf


def add_mesh(gltf, other, node):
    """Takes another file's mesh, at a node."""
    buffers, views, accessors = (len(gltf[kind]) for kind in ("buffers", "bufferViews", "accessors"))
    gltf["buffers"] += other["buffers"]
    gltf["bufferViews"] += [view | {"buffer": buffers + view["buffer"]} for view in other["bufferViews"]]
    gltf["accessors"] += [accessor | {"bufferView": views + accessor["bufferView"]} for accessor in other["accessors"]]
    primitives = [p | {"attributes": {name: accessors + at for name, at in p["attributes"].items()}, "indices": accessors + p["indices"]}
                  for p in other["meshes"][0]["primitives"]]
    gltf["meshes"].append({"primitives": primitives})
    gltf["nodes"].append({"mesh": len(gltf["meshes"]) - 1} | node)


def add_textures(gltf):
    checker = png(16, lambda x, y: (230, 200, 160) if (x // 8 + y // 8) % 2 else (120, 60, 40))
    rough = png(16, lambda x, y: (0, 140 if x < 8 else 220, 0))
    waves = png(32, lambda x, y: (int(127.5 + 40 * math.sin(x * math.pi / 8)), int(127.5 + 40 * math.sin(y * math.pi / 8)), 235))
    stripes = png(8, lambda x, y: (255, 255, 255) if x % 4 < 2 else (120, 90, 60))
    gltf["images"] = [{"uri": uri("image/png", picture)} for picture in (checker, rough, waves, stripes)]
    gltf["textures"] = [{"source": i} for i in range(4)]
    gltf["materials"][TILES]["pbrMetallicRoughness"] |= {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}}
    gltf["materials"][LAMP]["emissiveTexture"] = {"index": 3}
    gltf["materials"][BENT]["normalTexture"] = {"index": 2, "scale": 0.8}


def turn(axis, degrees):
    half = math.radians(degrees) / 2
    return [math.sin(half) * (axis == i) for i in range(3)] + [math.cos(half)]


# The bent wall is as rough as where reflections go from rays to prefiltered radiance: it has both.
WALL, RED, TILES, BENT, GLOSSY, MIRROR, LAMP, GOLD = range(8)
materials = [surface("wall", [0.75, 0.75, 0.72]), surface("red", [0.6, 0.12, 0.1], 0.7), surface("tiles", [1, 1, 1]),
             surface("bent", [0.5, 0.55, 0.6], 0.4), surface("glossy", [0.25, 0.3, 0.35], 0.2), surface("mirror", [0.9, 0.9, 0.9], 0, 1),
             lamp("lamp", [1, 0.8, 0.5], 12), surface("gold", [1, 0.75, 0.35], 0.3, 1)]

room = Room()
room.quad([-2, 0, 2], [4, 0, 0], [0, 0, -4], GLOSSY)        # floor
room.quad([2, 0, -2], [-4, 0, 0], [0, 2.5, 0], BENT)        # back wall, its back to the room: surfaces have two sides
room.quad([-2, 0, 2], [0, 0, -4], [0, 2.5, 0], RED)         # left
room.quad([2, 0, -2], [0, 0, 4], [0, 2.5, 0], TILES)        # right
room.quad([2, 0, 2], [-4, 0, 0], [0, 2.5, 0], WALL)         # behind the camera
room.quad([-2, 2.5, -2], [4, 0, 0], [0, 0, 2.2], WALL)      # roof, open to the front
room.quad([-1.2, 0.5, -1.98], [1.2, 0, 0], [0, 1.2, 0], MIRROR)
room.quad([0.6, 2.3, -1.6], [0.5, 0, 0], [0, 0, 0.5], LAMP)
boxes = Room()
boxes.box([-0.5, 0, -0.5], [0.5, 1, 0.5], TILES)
gold = Room()
gold.box([-0.5, 0, -0.5], [0.5, 1, 0.5], GOLD)
gltf = mesh_of(room)
add_textures(gltf)
# A node's own turn and uneven scale show whether normals are turned as planes are.
add_mesh(gltf, mesh_of(boxes), {"translation": [0.9, 0, -0.7], "rotation": turn(1, 25), "scale": [0.6, 1.1, 0.8]})
add_mesh(gltf, mesh_of(gold), {"translation": [-0.9, 0, -0.2], "rotation": turn(1, -35), "scale": [0.7, 0.6, 0.5]})

# A node's transform with another's within it: what is turned up or down first, and then about y.
def add_turned(yaw, place, down, what):
    gltf["nodes"].append({"rotation": turn(0, -down)} | what)
    gltf["nodes"].append({"rotation": turn(1, yaw), "translation": place, "children": [len(gltf["nodes"]) - 1]})
    return len(gltf["nodes"]) - 2


gltf["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "directional", "name": "sun", "color": [1, 0.95, 0.85], "intensity": 4}]}}
gltf["extensionsUsed"].append("KHR_lights_punctual")
children = [add_turned(25, [0, 0, 0], 55, {"extensions": {"KHR_lights_punctual": {"light": 0}}}),  # down through the open part of the roof
            add_turned(-55, [-1.7, 1.9, 0.9], 28, {"camera": 0, "name": "corner"})]
gltf["scenes"] = [{"nodes": [i for i in range(len(gltf["nodes"])) if i not in children]}]
json.dump(gltf, sys.stdout)
