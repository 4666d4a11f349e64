"""Rooms of quads and boxes as glTF, for the scripts of this folder."""
import base64, json, math, struct


class Room:
    def __init__(self):
        self.positions, self.normals, self.primitives = [], [], {}

    def quad(self, a, u, v, material):
        """Corner and edges; the front is where u x v points."""
        n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
        length = math.sqrt(sum(c * c for c in n))
        first = len(self.positions)
        for s, t in ((0, 0), (1, 0), (1, 1), (0, 1)):
            self.positions.append([a[i] + s * u[i] + t * v[i] for i in range(3)])
            self.normals.append([c / length for c in n])
        self.primitives.setdefault(material, []).extend(first + k for k in (0, 1, 2, 0, 2, 3))

    def box(self, low, high, material, inward=False, without=()):
        """without: sides to leave out, of -z +z -x +x -y +y = 0..5."""
        x, y, z = ([high[0] - low[0], 0, 0], [0, high[1] - low[1], 0], [0, 0, high[2] - low[2]])
        shift = lambda a, e: [a[i] + e[i] for i in range(3)]
        sides = ((low, y, x), (shift(low, z), x, y), (low, z, y), (shift(low, x), y, z), (low, x, z), (shift(low, y), z, x))
        for side, (a, u, v) in enumerate(sides):
            if side not in without:
                self.quad(a, *((v, u) if inward else (u, v)), material)

    def write(self, file, materials, eye, down, fov, point_lights=()):
        """down: degrees that the camera looks below -z; fov: vertical, radians; point_lights: (position, candela of each channel)."""
        count, primitives = len(self.positions), []
        blob = b"".join(struct.pack("<3f", *p) for p in self.positions + self.normals)
        views = [{"buffer": 0, "byteOffset": 12 * count * k, "byteLength": 12 * count} for k in range(2)]
        bounds = {f.__name__: [f(p[i] for p in self.positions) for i in range(3)] for f in (min, max)}
        accessors = [{"bufferView": k, "componentType": 5126, "count": count, "type": "VEC3", **({} if k else bounds)} for k in range(2)]
        for material, indices in self.primitives.items():
            views.append({"buffer": 0, "byteOffset": len(blob), "byteLength": 4 * len(indices)})
            blob += struct.pack(f"<{len(indices)}I", *indices)
            accessors.append({"bufferView": len(views) - 1, "componentType": 5125, "count": len(indices), "type": "SCALAR"})
            primitives.append({"attributes": {"POSITION": 0, "NORMAL": 1}, "indices": len(accessors) - 1, "material": material})
        turn = math.radians(-down)
        nodes = [{"mesh": 0}, {"camera": 0, "translation": eye, "rotation": [math.sin(turn / 2), 0, 0, math.cos(turn / 2)]}]
        gltf = {"asset": {"version": "2.0"}, "extensionsUsed": ["KHR_materials_emissive_strength"], "scene": 0,
                "cameras": [{"name": "view", "type": "perspective", "perspective": {"yfov": fov, "znear": 0.01}}],
                "meshes": [{"primitives": primitives}], "accessors": accessors, "bufferViews": views, "materials": materials,
                "buffers": [{"byteLength": len(blob), "uri": "data:application/octet-stream;base64," + base64.b64encode(blob).decode()}]}
        if point_lights:
            lights = [{"type": "point", "intensity": max(power), "color": [c / max(power) for c in power]} for _, power in point_lights]
            gltf["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
            gltf["extensionsUsed"].append("KHR_lights_punctual")
            nodes += [{"translation": at, "extensions": {"KHR_lights_punctual": {"light": i}}} for i, (at, _) in enumerate(point_lights)]
        json.dump(gltf | {"nodes": nodes, "scenes": [{"nodes": list(range(len(nodes)))}]}, file)


def surface(name, color, roughness=1, metallic=0):
    return {"name": name, "doubleSided": metallic == 0, "pbrMetallicRoughness": {"baseColorFactor": color + [1], "metallicFactor": metallic, "roughnessFactor": roughness}}


def lamp(name, color, strength):
    return surface(name, [0, 0, 0]) | {"emissiveFactor": color, "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": strength}}}
