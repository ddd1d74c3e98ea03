"""Models that are too large to keep: `panes COUNT ALPHA FILE.gltf`, parallel squares of one opacity in random order, a
unit apart in all, seen from +z; `triangles COUNT FILE.stl`, small triangles in random places of a cube, in 50 bytes
each. What they are for: docs/testing.md."""
import base64
import json
import random
import struct
import sys


def panes(count, alpha, path):
    depths = [i / count for i in range(count)]
    random.Random(1).shuffle(depths)
    corners = b"".join(struct.pack("<12f", -1, -1, -z, 1, -1, -z, 1, 1, -z, -1, 1, -z) for z in depths)
    indices = b"".join(struct.pack("<6I", i, i + 1, i + 2, i, i + 2, i + 3) for i in range(0, 4 * count, 4))
    data = base64.b64encode(corners + indices).decode()
    model = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 72 * count, "uri": "data:application/octet-stream;base64," + data}],
        "bufferViews": [{"buffer": 0, "byteLength": 48 * count},
                        {"buffer": 0, "byteOffset": 48 * count, "byteLength": 24 * count}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 4 * count, "type": "VEC3",
                       "min": [-1, -1, -max(depths)], "max": [1, 1, 0]},
                      {"bufferView": 1, "componentType": 5125, "count": 6 * count, "type": "SCALAR"}],
        "materials": [{"alphaMode": "BLEND", "doubleSided": True, "extensions": {"KHR_materials_unlit": {}},
                       "pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.9, alpha]}}],
        "extensionsUsed": ["KHR_materials_unlit"],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
        "nodes": [{"mesh": 0}],
        "scenes": [{"nodes": [0]}],
        "scene": 0,
    }
    with open(path, "w", encoding="utf-8") as file:
        json.dump(model, file)


def triangles(count, path):
    numbers = random.Random(1)
    block = 10000
    with open(path, "wb") as file:
        file.write(bytes(80) + struct.pack("<I", count))
        for first in range(0, count, block):
            part = bytearray()
            for _ in range(min(block, count - first)):
                x, y, z, a, b, c = (numbers.random() for _ in range(6))
                part += struct.pack("<12fH", 0, 0, 0, x, y, z, x + 0.01 * a, y + 0.01 * b, z, x, y + 0.01 * c,
                                    z + 0.01 * a, 0)
            file.write(part)


if sys.argv[1] == "panes":
    panes(int(sys.argv[2]), float(sys.argv[3]), sys.argv[4])
else:
    triangles(int(sys.argv[2]), sys.argv[3])
