#!/usr/bin/env python3
"""Writes the model files that the loading tests read: good/ and bad/ beside this script.

The files are kept in the repository; run this again only to change them. Its output is the same every time.
With `--seeds FOLDER` it writes that folder instead: the same files as seeds for tests/fuzz/load_fuzz.cpp, which takes
the reader from a first byte.
"""

import argparse
import base64
import copy
import json
import math
import pathlib
import struct
import zlib

HERE = pathlib.Path(__file__).resolve().parent
GOOD = HERE / "good"
BAD = HERE / "bad"

BYTE, UBYTE, SHORT, USHORT, UINT, FLOAT = 5120, 5121, 5122, 5123, 5125, 5126
CODES = {BYTE: "b", UBYTE: "B", SHORT: "h", USHORT: "H", UINT: "I", FLOAT: "f"}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


def png(width, height, pixels, depth=8, color_type=6):
    """A PNG of rows of bytes; `pixels` holds them one after the other."""

    def chunk(name, data):
        return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))

    stride = len(pixels) // height
    rows = b"".join(b"\0" + pixels[y * stride : (y + 1) * stride] for y in range(height))
    header = struct.pack(">IIBBBBB", width, height, depth, color_type, 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")


def data_uri(data, mime="application/octet-stream"):
    return f"data:{mime};base64,{base64.b64encode(data).decode()}"


class Model:
    """A glTF document with one buffer that grows."""

    def __init__(self):
        self.data = b""
        self.doc = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}]}

    def put(self, key, value):
        self.doc.setdefault(key, []).append(value)
        return len(self.doc[key]) - 1

    def view(self, data, **extra):
        self.data += b"\0" * (-len(self.data) % 4)
        view = {"buffer": 0, "byteOffset": len(self.data), "byteLength": len(data), **extra}
        self.data += data
        return self.put("bufferViews", view)

    def accessor(self, values, kind, component=FLOAT, stride=0, **extra):
        width = WIDTHS[kind]
        count = len(values) // width
        packed = [struct.pack("<%d%s" % (width, CODES[component]), *values[i * width : (i + 1) * width]) for i in range(count)]
        if stride:
            data = b"".join(p + b"\xee" * (stride - len(p)) for p in packed)
            view = self.view(data, byteStride=stride)
        else:
            view = self.view(b"".join(packed))
        return self.put(
            "accessors", {"bufferView": view, "componentType": component, "count": count, "type": kind, **extra}
        )

    def mesh(self, attributes, **extra):
        return self.put("meshes", {"primitives": [{"attributes": attributes, **extra}]})

    def finished(self):
        doc = copy.deepcopy(self.doc)
        if self.data:
            doc["buffers"] = [{"byteLength": len(self.data), "uri": data_uri(self.data)}]
        return doc

    def save(self, name):
        write_json(GOOD / name, self.finished())


def write_json(path, doc):
    path.write_text(json.dumps(doc, indent=1) + "\n")


def glb(doc, data=None):
    text = json.dumps(doc).encode()
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text
    if data is not None:
        data += b"\0" * (-len(data) % 4)
        chunks += struct.pack("<I4s", len(data), b"BIN\0") + data
    return b"glTF" + struct.pack("<II", 2, 12 + len(chunks)) + chunks


TRIANGLE = [0, 0, 0, 1, 0, 0, 0, 1, 0]
QUAD = [0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0]
UP = [0, 0, 1]


def triangle():
    m = Model()
    m.mesh({"POSITION": m.accessor(TRIANGLE, "VEC3")})
    return m


def quad(**primitive):
    m = Model()
    uv = m.accessor([0, 1, 1, 1, 0, 0, 1, 0], "VEC2")
    m.mesh(
        {"POSITION": m.accessor(QUAD, "VEC3"), "NORMAL": m.accessor(UP * 4, "VEC3"), "TEXCOORD_0": uv},
        indices=m.accessor([0, 1, 2, 2, 1, 3], "SCALAR", USHORT),
        **primitive,
    )
    return m


RED_GREEN = png(2, 1, bytes([255, 0, 0, 255, 0, 255, 0, 128]))


def write_good_shapes():
    triangle().save("triangle.gltf")
    (GOOD / "triangle.glb").write_bytes(
        glb({**triangle().doc, "buffers": [{"byteLength": 36}]}, struct.pack("<9f", *TRIANGLE))
    )

    for name, mode in (("strip", 5), ("fan", 6), ("list", 4)):
        m = Model()
        positions = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 2, 0, -1, 1, 0]
        normals = m.accessor(UP * 5, "VEC3")
        m.mesh(
            {"POSITION": m.accessor(positions, "VEC3"), "NORMAL": normals},
            mode=mode,
            # The strip names vertex 2 twice; the list ends in the middle of a triangle.
            indices=m.accessor({5: [0, 1, 2, 2, 3], 6: [0, 1, 2, 3, 4], 4: [0, 1, 2, 0, 2]}[mode], "SCALAR", UBYTE),
        )
        m.save(f"{name}.gltf")

    m = Model()
    attributes = {"POSITION": m.accessor(QUAD, "VEC3"), "NORMAL": m.accessor(UP * 4, "VEC3")}
    primitives = [
        {"attributes": attributes, "indices": m.accessor([1, 3, 2], "SCALAR", t)} for t in (UBYTE, USHORT, UINT)
    ]
    m.put("meshes", {"primitives": primitives})
    m.save("index_types.gltf")

    m = Model()
    position = m.accessor(TRIANGLE, "VEC3")
    m.doc["accessors"][position]["sparse"] = {
        "count": 1,
        "indices": {"bufferView": m.view(struct.pack("<H", 2)), "componentType": USHORT},
        "values": {"bufferView": m.view(struct.pack("<3f", 0, 5, 0))},
    }
    zeros = m.put("accessors", {"componentType": FLOAT, "count": 3, "type": "VEC2"})
    filled = m.put("accessors", {"componentType": USHORT, "count": 3, "type": "SCALAR"})
    m.doc["accessors"][filled]["sparse"] = {
        "count": 2,
        "indices": {"bufferView": m.view(struct.pack("<2B", 1, 2)), "componentType": UBYTE},
        "values": {"bufferView": m.view(struct.pack("<2H", 1, 2))},
    }
    m.mesh({"POSITION": position, "TEXCOORD_0": zeros}, indices=filled)
    m.save("sparse.gltf")

    m = Model()
    m.doc["extensionsUsed"] = m.doc["extensionsRequired"] = ["KHR_mesh_quantization"]
    m.doc["nodes"][0]["scale"] = [2, 2, 2]
    m.mesh(
        {
            "POSITION": m.accessor([0, 0, 0, 32767, 0, 0, 0, -32767, 0], "VEC3", SHORT, stride=8, normalized=True),
            "NORMAL": m.accessor([0, 0, -127] * 3, "VEC3", BYTE, stride=4, normalized=True),
            "TEXCOORD_0": m.accessor([0, 0, 255, 0, 0, 51], "VEC2", UBYTE, stride=4, normalized=True),
            "TEXCOORD_1": m.accessor([0, 0, 65535, 0, 0, 13107], "VEC2", USHORT, normalized=True),
            "COLOR_0": m.accessor([255, 0, 0, 51] * 3, "VEC4", UBYTE, normalized=True),
        },
        indices=m.accessor([0, 2, 1], "SCALAR", USHORT),
    )
    m.save("normalized.gltf")

    m = Model()
    vertices = b"".join(
        struct.pack("<3f3f2f", *TRIANGLE[3 * i : 3 * i + 3], 0, 0, 1, i / 4, i / 2) for i in range(3)
    )
    view = m.view(b"\xee" * 8 + vertices, byteStride=32)
    common = {"bufferView": view, "componentType": FLOAT, "count": 3}
    m.mesh(
        {
            "POSITION": m.put("accessors", {**common, "byteOffset": 8, "type": "VEC3"}),
            "NORMAL": m.put("accessors", {**common, "byteOffset": 20, "type": "VEC3"}),
            "TEXCOORD_0": m.put("accessors", {**common, "byteOffset": 32, "type": "VEC2"}),
            "COLOR_0": m.accessor([0.5, 0.25, 1] * 3, "VEC3"),
        }
    )
    m.save("interleaved.gltf")

    m = triangle()
    m.doc["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = m.accessor([0, 0, 0, 0, 0, math.nan, 0, 0, 7], "VEC3")
    m.save("broken_normals.gltf")


def write_good_poses():
    m = Model()
    m.doc["nodes"] = [
        {"mesh": 0, "skin": 0, "translation": [100, 0, 0]},
        {"translation": [0, 1, 0]},
        {"translation": [0, 0, 3], "scale": [2, 2, 2]},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1, 2]}]
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    moved = identity[:12] + [0, 0, -1, 1]
    m.put("skins", {"joints": [1, 2], "inverseBindMatrices": m.accessor(identity + moved, "MAT4")})
    # The first vertex follows joint 0, the second joint 1, the third both: through both sets, with a sum of 4.
    m.mesh(
        {
            "POSITION": m.accessor(TRIANGLE, "VEC3"),
            "NORMAL": m.accessor(UP * 3, "VEC3"),
            "JOINTS_0": m.accessor([0, 0, 0, 0, 1, 0, 0, 0, 0, 9, 9, 9], "VEC4", UBYTE),
            "WEIGHTS_0": m.accessor([1, 0, 0, 0, 1, 0, 0, 0, 2, 0, 0, 0], "VEC4"),
            "JOINTS_1": m.accessor([0, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0], "VEC4", USHORT),
            "WEIGHTS_1": m.accessor([0, 0, 0, 0, 0, 0, 0, 0, 2, 0, 0, 0], "VEC4"),
        }
    )
    m.save("skin.gltf")

    m = triangle()
    lift = m.accessor([0, 0, 1] * 3, "VEC3")
    shift = m.accessor([1, 0, 0] * 3, "VEC3")
    m.doc["meshes"][0]["primitives"][0]["targets"] = [{"POSITION": lift}, {"POSITION": shift}]
    m.doc["meshes"][0]["weights"] = [0.5, 0]
    m.doc["nodes"] = [{"mesh": 0}, {"mesh": 0, "weights": [0, 2]}]
    m.doc["scenes"] = [{"nodes": [0, 1]}]
    m.save("morph.gltf")

    m = triangle()
    m.doc["nodes"] = [
        {"mesh": 0},
        {"children": [2], "translation": [1, 2, 3], "rotation": [0, 0, math.sqrt(0.5), math.sqrt(0.5)], "scale": [2, 2, 2]},
        {"mesh": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 10, 0, 0, 1]},
    ]
    m.doc["scenes"] = [{"nodes": [0]}, {"nodes": [1]}]
    m.doc["scene"] = 1
    m.save("two_scenes.gltf")
    del m.doc["scene"]
    m.save("unnamed_scene.gltf")
    del m.doc["scenes"]
    m.save("no_scenes.gltf")

    m = triangle()
    m.doc["nodes"] = [
        {"mesh": 0, "children": [1, 2]},
        {"camera": 1, "translation": [0, 0, 5], "scale": [3, 3, 3]},
        {"camera": 0, "translation": [0, 1, 0], "rotation": [0, math.sqrt(0.5), 0, math.sqrt(0.5)]},
    ]
    m.doc["cameras"] = [
        {"name": "eye", "type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}},
        {"type": "orthographic", "orthographic": {"xmag": 3, "ymag": 2, "znear": 1, "zfar": 9}},
    ]
    m.save("cameras.gltf")


def write_good_materials():
    m = quad(material=0)
    m.put("images", {"uri": data_uri(RED_GREEN, "image/png")})
    m.put("samplers", {"magFilter": 9728, "minFilter": 9986, "wrapS": 33071, "wrapT": 33648})
    m.put("textures", {"source": 0, "sampler": 0})
    m.doc["extensionsUsed"] = ["KHR_texture_transform", "KHR_materials_emissive_strength", "KHR_materials_unlit"]
    m.doc["extensionsRequired"] = ["KHR_texture_transform"]
    transform = {"offset": [0.5, 0.25], "rotation": math.pi / 2, "scale": [2, 3], "texCoord": 1}
    m.put(
        "materials",
        {
            "name": "glass",
            "alphaMode": "BLEND",
            "doubleSided": True,
            "emissiveFactor": [0.5, 0, 1],
            "pbrMetallicRoughness": {
                "baseColorFactor": [1, 0.5, 0.25, 0.125],
                "metallicFactor": 0.75,
                "roughnessFactor": 0.5,
                "baseColorTexture": {"index": 0, "texCoord": 0, "extensions": {"KHR_texture_transform": transform}},
            },
            "emissiveTexture": {"index": 0},
            "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 4}, "KHR_materials_unlit": {}},
        },
    )
    m.put("materials", {"alphaMode": "MASK", "alphaCutoff": 0.75})
    m.doc["meshes"][0]["primitives"].append({**m.doc["meshes"][0]["primitives"][0], "material": 1})
    m.save("material.gltf")

    m = quad(material=0)
    m.put("images", {"bufferView": m.view(RED_GREEN), "mimeType": "image/png"})
    m.put("textures", {"source": 0})
    m.put("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    (GOOD / "texture.glb").write_bytes(glb({**m.doc, "buffers": [{"byteLength": len(m.data)}]}, m.data))

    m = quad(material=0)
    m.put("images", {"uri": "a%2Bb%20c.png"})
    m.put("textures", {"source": 0})
    m.put("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    doc = {**m.doc, "buffers": [{"byteLength": len(m.data), "uri": "some%20data.bin"}]}
    write_json(GOOD / "external.gltf", doc)
    (GOOD / "some data.bin").write_bytes(m.data + b"more")
    (GOOD / "a+b c.png").write_bytes(RED_GREEN)

    m = quad(material=0)
    sixteen = struct.pack(">4H", 0xFFFF, 0x8080, 0x00FF, 0x0080)
    m.put("images", {"uri": data_uri(png(1, 1, sixteen, depth=16), "image/png")})
    m.put("textures", {"source": 0})
    m.put("materials", {"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}})
    m.save("sixteen_bit.gltf")

    # Two quads side by side; the second one mirrors its texture.
    m = Model()
    m.put("images", {"uri": data_uri(png(1, 1, bytes([128, 128, 255, 255])), "image/png")})
    m.put("textures", {"source": 0})
    m.put("materials", {"normalTexture": {"index": 0, "texCoord": 3, "scale": 0.5}})
    positions = [0, 0, 0, 0, 1, 0, 1, 0, 0, 1, 1, 0, 2, 0, 0, 2, 1, 0]
    uv = [0, 1, 0, 0, 1, 1, 1, 0, 0, 1, 0, 0]
    m.mesh(
        {
            "POSITION": m.accessor(positions, "VEC3"),
            "NORMAL": m.accessor(UP * 6, "VEC3"),
            "TEXCOORD_3": m.accessor(uv, "VEC2"),
        },
        indices=m.accessor([0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5], "SCALAR", USHORT),
        material=0,
    )
    m.save("tangents.gltf")


def write_good_transmission():
    """Panes that transmit light, side by side before a patterned wall, and one before them all."""
    m = Model()
    m.doc["scenes"] = [{"nodes": []}]
    m.doc["nodes"] = []
    m.doc["extensionsUsed"] = m.doc["extensionsRequired"] = ["KHR_materials_transmission"]
    m.doc["extensionsUsed"] = m.doc["extensionsUsed"] + ["KHR_materials_unlit", "KHR_materials_emissive_strength"]
    pattern = [[235, 90, 40, 255], [40, 60, 200, 255], [250, 240, 200, 255], [20, 20, 20, 255]]
    wall = b"".join(bytes(pattern[(x + 2 * (y % 2)) % 4]) for y in range(4) for x in range(8))
    m.put("images", {"uri": data_uri(png(8, 4, wall), "image/png")})
    m.put("images", {"uri": data_uri(RED_GREEN, "image/png")})
    m.put("samplers", {"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33071})
    m.put("textures", {"source": 0, "sampler": 0})
    m.put("textures", {"source": 1, "sampler": 0})

    attributes = {
        "POSITION": m.accessor(QUAD, "VEC3"),
        "NORMAL": m.accessor(UP * 4, "VEC3"),
        "TEXCOORD_0": m.accessor([0, 1, 1, 1, 0, 0, 1, 0], "VEC2"),
    }
    indices = m.accessor([0, 1, 2, 2, 1, 3], "SCALAR", USHORT)

    def pane(name, place, size, extension, color=(1, 1, 1, 1), metallic=0, turn=0.0, pbr=None, **fields):
        material = m.put(
            "materials",
            {
                "name": name,
                "pbrMetallicRoughness": {
                    "baseColorFactor": list(color),
                    "metallicFactor": metallic,
                    "roughnessFactor": 0.3,
                    **(pbr or {}),
                },
                "extensions": {"KHR_materials_transmission": extension} if extension else {"KHR_materials_unlit": {}},
                **fields,
            },
        )
        mesh = m.mesh(attributes, indices=indices, material=material)
        rotation = [0, math.sin(turn / 2), 0, math.cos(turn / 2)]
        node = {"mesh": mesh, "translation": place, "scale": [*size, 1], "rotation": rotation}
        m.doc["scenes"][0]["nodes"].append(m.put("nodes", node))

    pane("wall", [-3.2, -1.2, -1], [6.4, 2.4], None, pbr={"baseColorTexture": {"index": 0}})
    full = {"transmissionFactor": 1}
    pane("clear", [-3, -0.8, 0], [0.9, 1.6], full, (0.3, 0.8, 1, 1), turn=0.2)
    pane("half", [-2, -0.8, 0], [0.9, 1.6], {"transmissionFactor": 0.5}, (0.3, 0.8, 1, 1), turn=0.1)
    textured = {"transmissionFactor": 0.9, "transmissionTexture": {"index": 1}}
    pane("textured", [-1, -0.8, 0], [0.9, 1.6], textured, (1, 0.9, 0.3, 1))
    pane("covers half", [0, -0.8, 0], [0.9, 1.6], full, (0.2, 0.9, 0.3, 0.5), alphaMode="BLEND")
    cut = {"baseColorTexture": {"index": 1}}
    pane("cut", [1, -0.8, 0], [0.9, 1.6], full, pbr=cut, alphaMode="MASK", alphaCutoff=0.75)
    pane("metal", [2, -0.8, 0], [0.9, 1.6], full, (0.9, 0.6, 0.3, 1), metallic=1, turn=-0.1)
    glow = {"KHR_materials_emissive_strength": {"emissiveStrength": 3}}
    pane("glow", [-2.5, -0.2, 0.5], [5, 0.4], {"transmissionFactor": 0.8}, (1, 0.5, 0.8, 1), turn=0.05)
    m.doc["materials"][-1]["emissiveFactor"] = [0.2, 0.05, 0]
    m.doc["materials"][-1]["extensions"].update(glow)
    camera = m.put("cameras", {"type": "perspective", "perspective": {"yfov": 0.6, "znear": 0.5, "zfar": 20}})
    m.doc["scenes"][0]["nodes"].append(m.put("nodes", {"camera": camera, "translation": [0, 0, 6]}))
    m.save("transmission.gltf")


def write_good_volume():
    """A pane of glass before a white background, as thick as it is said to be; and what is no volume."""
    m = Model()
    m.doc["extensionsUsed"] = m.doc["extensionsRequired"] = ["KHR_materials_transmission", "KHR_materials_volume"]
    m.put("images", {"uri": data_uri(RED_GREEN, "image/png")})
    m.put("textures", {"source": 0})
    attributes = {
        "POSITION": m.accessor(QUAD, "VEC3"),
        "NORMAL": m.accessor(UP * 4, "VEC3"),
        "TEXCOORD_0": m.accessor([0, 1, 1, 1, 0, 0, 1, 0], "VEC2"),
    }
    indices = m.accessor([0, 1, 2, 2, 1, 3], "SCALAR", USHORT)
    rose = {"attenuationDistance": 1, "attenuationColor": [1, 0.5, 0.5]}
    volumes = [
        ("pane", {"transmissionFactor": 1}, {"thicknessFactor": 1, **rose}),
        ("textured", {"transmissionFactor": 1}, {"thicknessFactor": 2, "thicknessTexture": {"index": 0}, **rose}),
        ("thin", {"transmissionFactor": 1}, rose),
        ("clear", {"transmissionFactor": 1}, {"thicknessFactor": 1}),
        ("opaque", {}, {"thicknessFactor": 1, **rose}),
    ]
    for i, (name, transmission, volume) in enumerate(volumes):
        extensions = {"KHR_materials_transmission": transmission, "KHR_materials_volume": volume}
        pbr = {"metallicFactor": 0, "roughnessFactor": 1}
        material = m.put("materials", {"name": name, "pbrMetallicRoughness": pbr, "extensions": extensions})
        mesh = m.mesh(attributes, indices=indices, material=material)
        node = m.put("nodes", {"mesh": mesh, "translation": [1.5 * i, 0, 0]})
        m.doc.setdefault("scenes", [{"nodes": []}])[0].setdefault("nodes", []).append(node)
    m.save("volume.gltf")


def write_good_plain():
    (GOOD / "colors.ply").write_text(
        "ply\nformat ascii 1.0\ncomment made by make_corpus.py\nelement vertex 4\n"
        "property float x\nproperty float y\nproperty float z\nproperty float r\nproperty float g\nproperty float b\n"
        "property uchar alpha\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0 1 0.5 0 255\n1 0 0 1 0.5 0 51\n1 1 0 1 0.5 0 255\n0 1 0 1 0.5 0 255\n4 0 1 2 3\n"
    )
    vertices = b"".join(
        struct.pack(">3d3f3B", *QUAD[3 * i : 3 * i + 3], 0, 0, -1, 255, 188, 0) for i in range(4)
    )
    (GOOD / "strips_big_endian.ply").write_bytes(
        b"ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty double x\nproperty double y\nproperty double z\n"
        b"property float nx\nproperty float ny\nproperty float nz\n"
        b"property uchar red\nproperty uchar green\nproperty uchar blue\nelement tristrips 1\n"
        b"property list int int vertex_indices\nend_header\n" + vertices + struct.pack(">i8i", 8, 0, 1, 2, 3, -1, 0, 1, 2)
    )
    (GOOD / "concave.ply").write_text(
        "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_index\nend_header\n"
        "0 0 0\n4 0 0\n4 4 0\n2 1 0\n0 4 0\n5 0 1 2 3 4\n"
    )

    def facet(*corners):
        lines = "".join(f"   vertex {x} {y} {z}\n" for x, y, z in corners)
        return f" facet normal 0 0 0\n  outer loop\n{lines}  endloop\n endfacet\n"

    # Two facets that meet at a right angle, and one that continues the first.
    text = facet((0, 0, 0), (1, 0, 0), (0, 1, 0)) + facet((1, 0, 0), (1, 1, 0), (0, 1, 0))
    text += facet((0, 0, 0), (0, 0, -1), (1, 0, 0))
    (GOOD / "text.stl").write_text(f"solid name with spaces\n{text}endsolid\n")

    def binary(header, facets):
        body = b"".join(struct.pack("<12fH", 0, 0, 0, *corners, bits) for corners, bits in facets)
        return header.ljust(80, b" ") + struct.pack("<I", len(facets)) + body

    (GOOD / "solid_binary.stl").write_bytes(binary(b"solid but binary", [(TRIANGLE, 0)]))
    (GOOD / "magics.stl").write_bytes(
        binary(b"COLOR=" + bytes([255, 0, 0, 51]), [(TRIANGLE, 0x8000), ([v + 2 for v in TRIANGLE], 31 << 5)])
    )
    (GOOD / "viscam.stl").write_bytes(binary(b"", [(TRIANGLE, 0x8000 | 31), ([v + 2 for v in TRIANGLE], 0)]))

    (GOOD / "box.mtl").write_text(
        "newmtl glass\nKd 1 0.5 0\nd 0.25\nnewmtl cut\\out\nKd 1 1 1\nmap_Kd leaf.png\nnewmtl fog\nKd 0 0 0\nTr 0.75\n"
    )
    (GOOD / "leaf.png").write_bytes(RED_GREEN)
    (GOOD / "box.obj").write_text(
        "mtllib box.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 -1\nvt 0 0\nvt 1 0\nvt 1 0.25\nvn 0 0 -1\n"
        "usemtl glass\nf 1//1 2//1 3//1 4//1\nusemtl cut\\out\nf -5/1 -4/2 -3/3\nusemtl fog\nf 1 2 5\n"
    )
    (GOOD / "vertex_colors.obj").write_text("v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 1 0.5 0\nf 1 2 3\n")


OBJ_QUAD = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n"


def grey_png(width, height, values):
    return png(width, height, bytes(values), color_type=0)


def write_good_obj():
    """OBJ files and their libraries as other programs and systems write them: a folder for each question of files."""

    def folder(name):
        path = GOOD / "obj" / name
        path.mkdir(parents=True, exist_ok=True)
        return path

    # Where libraries and pictures are found.
    case = folder("letter_case")
    (case / "model.obj").write_text("mtllib MODEL.MTL\n" + OBJ_QUAD + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n")
    (case / "Model.mtl").write_text("newmtl a\nKd 1 1 1\nmap_Kd Maps\\LEAF.PNG\n")
    (case / "maps").mkdir(exist_ok=True)
    (case / "maps" / "leaf.png").write_bytes(RED_GREEN)
    below = folder("library_below")
    (below / "model.obj").write_text("mtllib .\\sub\\model.mtl\n" + OBJ_QUAD + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n")
    (below / "sub" / "tex").mkdir(parents=True, exist_ok=True)
    (below / "sub" / "model.mtl").write_text("newmtl a\nmap_Kd tex/leaf.png\nnewmtl b\nmap_Kd beside.png\n")
    (below / "sub" / "tex" / "leaf.png").write_bytes(RED_GREEN)
    absolute = folder("windows_paths")
    (absolute / "model.obj").write_text(
        "mtllib C:\\work\\model one.mtl\n" + OBJ_QUAD + "vt 0 0\nusemtl a\nf 1/1 2/1 3/1 4/1\n"
    )
    (absolute / "model one.mtl").write_text('newmtl a\nmap_Kd "D:\\maps\\my leaf.png"\n')
    (absolute / "my leaf.png").write_bytes(RED_GREEN)

    # Which library a material comes from.
    several = folder("several_libraries")
    (several / "model.obj").write_text(
        OBJ_QUAD + "usemtl b\nf 1 2 3\nmtllib one two.mtl three.mtl # both\nmtllib gone.mtl gone too.mtl\nusemtl a # glass\nf 1 3 4\n"
        "usemtl c\nf 1 2 4\n"
    )
    (several / "one two.mtl").write_text("newmtl a\nd .25\n")
    (several / "three.mtl").write_text("newmtl a\nd .75\nnewmtl b # brown\nd .5 # half\nnewmtl d\n")
    joined = folder("same_names")
    (joined / "model.obj").write_text(
        OBJ_QUAD + "mtllib first.mtl\nusemtl a\nf 1 2 3\nmtllib second.mtl\nusemtl a\nf 1 3 4\nusemtl none\nf 1 2 4\nusemtl nil\nf 2 3 4\n"
    )
    (joined / "first.mtl").write_text("newmtl a\nd .25\n")
    (joined / "second.mtl").write_text("newmtl a\nd .75\n")

    # How pictures are used.
    maps = folder("maps")
    (maps / "model.obj").write_text(
        "mtllib model.mtl\n"
        + OBJ_QUAD.replace(" 0\n", " 0 .5 .5 .5\n")
        + "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
        + "".join(
            f"usemtl {name}\nf 1/1 2/2 3/3 4/4\n"
            for name in ("grey", "alpha", "channel", "both", "only", "placed", "scaled", "pbr", "normals", "bumps", "same", "missing")
        )
    )
    (maps / "model.mtl").write_text(
        "newmtl grey\nKd 1 0 0\nmap_d grey.png\n"
        "newmtl alpha\nKd 1 0 0\nmap_d leaf.png\n"
        "newmtl channel\nKd 1 0 0\nd 0\nmap_d -imfchan r leaf.png\n"
        "newmtl both\nmap_Kd leaf.png\nmap_d grey.png\n"
        "newmtl only\nd 0.5\nmap_Kd leaf.png\nmap_d leaf.png\n"
        "newmtl placed\nmap_Kd -clamp on -blendu on -o 0.25 0.5 0 -s 2 4 1 leaf.png\n"
        "newmtl scaled\nmap_Kd -mm 0.2 0.6 leaf.png\n"
        "newmtl pbr\nPr 0.3\nPm 0.2\nKe 0 0 0\nmap_Pr grey.png\nmap_Ke leaf.png\nPc 0.5\nPcr 0.25\n"
        "newmtl normals\nmap_Bump -bm 0.5 up.png\n"
        "newmtl bumps\nbump -bm 25 steps.png\n"
        "newmtl same\nmap_Kd grey.png\nmap_d grey.png\n"
        "newmtl missing\nmap_Kd gone.png\nmap_Ks leaf.png\n"
    )
    (maps / "leaf.png").write_bytes(RED_GREEN)
    (maps / "grey.png").write_bytes(grey_png(1, 1, [128]))
    (maps / "up.png").write_bytes(png(1, 1, bytes([128, 128, 255]), color_type=2))
    (maps / "steps.png").write_bytes(grey_png(4, 1, [0, 51, 102, 51]))


def bad_documents():
    """Each name with a glTF document that is wrong in one way."""

    def change(edit, model=triangle):
        doc = model().finished()
        edit(doc)
        return doc

    def setter(*path):
        *parents, last, value = path

        def edit(doc):
            for key in parents:
                doc = doc[key]
            doc[last] = value

        return edit

    def triangle_with(**kwargs):
        def make():
            m = triangle()
            for key, value in kwargs.items():
                m.doc[key] = value
            return m

        return make

    def simple(name, *path, model=triangle):
        return name, change(setter(*path), model)

    image = {"images": [{"uri": data_uri(RED_GREEN)}], "textures": [{"source": 0}]}
    textured = {"materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0}}}]}

    def textured_quad(picture):
        m = quad(material=0)
        m.doc.update(copy.deepcopy(image))
        m.doc.update(copy.deepcopy(textured))
        m.doc["images"][0]["uri"] = data_uri(picture, "image/png")
        return m

    huge = bytearray(RED_GREEN)
    huge[16:24] = struct.pack(">II", 16000, 16000)
    huge[29:33] = struct.pack(">I", zlib.crc32(bytes(huge[12:29])))
    larger = bytearray(RED_GREEN)
    larger[16:24] = struct.pack(">II", 100000, 2)
    larger[29:33] = struct.pack(">I", zlib.crc32(bytes(larger[12:29])))

    def sparse(count, index, component=USHORT):
        def make():
            m = triangle()
            m.doc["accessors"][0]["sparse"] = {
                "count": count,
                "indices": {"bufferView": m.view(struct.pack("<2H", index, index)), "componentType": component},
                "values": {"bufferView": m.view(struct.pack("<3f", 0, 5, 0))},
            }
            return m

        return make

    def indexed(values, component=USHORT, kind="SCALAR"):
        def make():
            m = triangle()
            m.doc["meshes"][0]["primitives"][0]["indices"] = m.accessor(values, kind, component)
            return m

        return make

    def skinned(joint, matrices=1):
        def make():
            m = triangle()
            attributes = m.doc["meshes"][0]["primitives"][0]["attributes"]
            attributes["JOINTS_0"] = m.accessor([joint, 0, 0, 0] * 3, "VEC4", USHORT)
            attributes["WEIGHTS_0"] = m.accessor([1, 0, 0, 0] * 3, "VEC4")
            m.doc["nodes"][0]["skin"] = 0
            m.put("skins", {"joints": [0, 0], "inverseBindMatrices": m.accessor([1.0] * 16 * matrices, "MAT4")})
            return m

        return make

    def positions(values):
        def make():
            m = Model()
            m.mesh({"POSITION": m.accessor(values, "VEC3")})
            return m

        return make

    def plain(model):
        return model().finished()

    yield simple("accessor_bufferview_range", "accessors", 0, "bufferView", 1)
    yield simple("accessor_component_type", "accessors", 0, "componentType", 5130)
    yield simple("accessor_count_2_32", "accessors", 0, "count", 2**32)
    yield simple("accessor_count_negative", "accessors", 0, "count", -3)
    yield simple("accessor_count_fraction", "accessors", 0, "count", 2.5)
    yield simple("accessor_count_string", "accessors", 0, "count", "3")
    yield simple("accessor_count_too_many", "accessors", 0, "count", 4)
    yield simple("accessor_offset_2_53", "accessors", 0, "byteOffset", 2**53)
    yield simple("accessor_offset_2_64", "accessors", 0, "byteOffset", 2**64 - 4)
    yield simple("accessor_type", "accessors", 0, "type", "VEC5")
    yield simple("bufferview_buffer_range", "bufferViews", 0, "buffer", 9)
    yield simple("bufferview_length_2_32", "bufferViews", 0, "byteLength", 2**32 + 36)
    yield simple("bufferview_offset_2_53", "bufferViews", 0, "byteOffset", 2**53 - 36)
    yield simple("bufferview_stride_small", "bufferViews", 0, "byteStride", 8)
    yield simple("bufferview_stride_odd", "bufferViews", 0, "byteStride", 13)
    yield simple("buffer_longer_than_data", "buffers", 0, "byteLength", 37)
    yield simple("buffer_garbage_uri", "buffers", 0, "uri", "data:application/octet-stream;base64,AAAA!!!!AAAA")
    yield simple("buffer_missing_file", "buffers", 0, "uri", "not-there.bin")
    yield simple("buffer_absolute_file", "buffers", 0, "uri", "/dev/zero")
    yield simple("buffer_remote", "buffers", 0, "uri", "https://example.org/data.bin")
    doc = plain(triangle)
    doc["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0, "znear": 1}}]
    doc["nodes"][0]["camera"] = 0
    yield "camera_flat", doc
    yield simple("extension_required", "extensionsRequired", ["KHR_draco_mesh_compression"])
    yield "index_range", plain(indexed([0, 1, 3]))
    yield "index_restart", plain(indexed([0, 1, 65535]))
    yield "index_floats", plain(indexed([0, 1, 2], FLOAT))
    yield "index_vectors", plain(indexed([0, 1, 2], USHORT, "VEC3"))
    yield "image_huge", plain(lambda: textured_quad(bytes(huge)))
    yield "image_over_limit", plain(lambda: textured_quad(bytes(larger)))
    yield "image_truncated", plain(lambda: textured_quad(RED_GREEN[:50]))
    yield "image_garbage", plain(lambda: textured_quad(b"no picture at all"))
    table = bytes([0] + [17] * 16 + [0] * 272)
    jpeg = b"\xff\xd8\xff\xc4" + struct.pack(">H", 2 + len(table)) + table
    yield "image_jpeg_table", plain(lambda: textured_quad(jpeg))
    yield "joint_range", plain(skinned(2, 2))
    yield "joint_matrices", plain(skinned(0))
    yield simple("material_range", "meshes", 0, "primitives", 0, "material", 0)
    yield "material_texture_range", change(
        setter("materials", 0, "pbrMetallicRoughness", "baseColorTexture", "index", 1), lambda: textured_quad(RED_GREEN)
    )
    yield simple("material_factor_range", "materials", [{"pbrMetallicRoughness": {"metallicFactor": 1e39}}])
    glass = {"KHR_materials_transmission": {"transmissionTexture": {"index": 1}}}
    yield "material_transmission_range", change(setter("materials", [{"extensions": glass}]), triangle_with(**image))
    volume = {"KHR_materials_volume": {"attenuationColor": [1, 0.5]}}
    yield simple("material_volume_color", "materials", [{"extensions": volume}])
    yield simple("material_factor_type", "materials", [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]}}])
    yield "texture_no_image", change(setter("textures", 0, {}), lambda: textured_quad(RED_GREEN))
    yield simple("mesh_mode", "meshes", 0, "primitives", 0, "mode", 7)
    yield simple("mesh_points_only", "meshes", 0, "primitives", 0, "mode", 0)
    yield simple("node_cycle", "nodes", [{"mesh": 0}, {"children": [2]}, {"children": [1]}])
    yield simple("node_two_parents", "nodes", [{"children": [2]}, {"children": [2]}, {"mesh": 0}])
    yield simple("node_child_range", "nodes", 0, "children", [5])
    yield simple("node_mesh_range", "nodes", 0, "mesh", 1)
    yield simple("node_matrix_short", "nodes", 0, "matrix", [1] * 15)
    yield simple("node_far_away", "nodes", 0, "translation", [1e30, 0, 0])
    yield simple("node_rotation_zero", "nodes", 0, "rotation", [0, 0, 0, 0])
    yield "position_nan", plain(positions([0, 0, 0, math.nan, 0, 0, 0, 1, 0]))
    yield "position_infinite", plain(positions([0, 0, 0, 1, 0, 0, 0, math.inf, 0]))
    yield "positions_equal", plain(positions([1, 1, 1] * 3))
    yield simple("scene_range", "scene", 1)
    yield simple("scene_string", "scene", "0")
    yield "sparse_index_range", plain(sparse(1, 3))
    yield "sparse_count", plain(sparse(4, 0))
    yield "sparse_values_short", plain(sparse(2, 0))
    yield "sparse_component_type", plain(sparse(1, 0, FLOAT))
    yield simple("version_1", "asset", "version", "1.0")
    doc = plain(triangle)
    del doc["accessors"][0]["bufferView"]
    doc["accessors"][0]["count"] = 2**31
    yield "zero_filled_count", doc
    doc = plain(triangle)
    doc["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = len(doc["accessors"])
    doc["accessors"].append({**doc["accessors"][0], "count": 2})
    yield "attribute_counts", doc


def write_bad():
    for name, doc in bad_documents():
        write_json(BAD / f"{name}.gltf", doc)
    text = json.dumps(triangle().finished())
    (BAD / "json_truncated.gltf").write_text(text[: len(text) // 2])
    (BAD / "json_1e999.gltf").write_text(text.replace('"count": 3', '"count": 1e999'))
    (BAD / "json_nan.gltf").write_text(text.replace('"count": 3', '"count": NaN'))
    (BAD / "json_nested.gltf").write_text('{"extras":' + "[" * 20000 + "]" * 20000 + "}")
    (BAD / "json_array.gltf").write_text("[1, 2, 3]")
    (BAD / "json_control_bytes.gltf").write_bytes(b'{"asset": \x1b[31m\x9b31m\xff}')
    (BAD / "not_json.gltf").write_bytes(b"\x1b[31mred\x1b[0m")
    (BAD / "not_glb.glb").write_bytes(b"\x07\x1b]0;glTF\x9c" + bytes(range(128, 256)))
    (BAD / "empty.gltf").write_bytes(b"")
    (BAD / "no_asset.gltf").write_text("{}")

    whole = glb({**triangle().doc, "buffers": [{"byteLength": 36}]}, struct.pack("<9f", *TRIANGLE))
    json_length = struct.unpack_from("<I", whole, 12)[0]
    (BAD / "truncated.glb").write_bytes(whole[:-8])
    (BAD / "header_only.glb").write_bytes(whole[:12])
    (BAD / "version_1.glb").write_bytes(whole[:4] + struct.pack("<I", 1) + whole[8:])
    (BAD / "json_length.glb").write_bytes(whole[:12] + struct.pack("<I", 0xFFFFFFF0) + whole[16:])
    binary = 20 + json_length
    (BAD / "bin_length.glb").write_bytes(whole[:binary] + struct.pack("<I", 0x7FFFFFFC) + whole[binary + 4 :])
    (BAD / "bin_first.glb").write_bytes(whole[:12] + whole[binary:] + whole[12:binary])
    (BAD / "no_bin.glb").write_bytes(glb({**triangle().doc, "buffers": [{"byteLength": 36}]}))
    (BAD / "bin_short.glb").write_bytes(glb({**triangle().doc, "buffers": [{"byteLength": 360}]}, whole[binary + 8 :]))

    def ply(name, header, body=b""):
        (BAD / f"{name}.ply").write_bytes(b"ply\n" + header.encode() + b"end_header\n" + body)

    ascii_format = "format ascii 1.0\n"
    little = "format binary_little_endian 1.0\n"
    xyz = "property float x\nproperty float y\nproperty float z\n"
    face = "property list uchar int vertex_indices\n"
    corners = b"0 0 0\n1 0 0\n0 1 0\n"
    three = f"element vertex 3\n{xyz}"
    ply("vertex_count_2_64", f"{ascii_format}element vertex 18446744073709551615\n{xyz}", corners)
    ply("vertex_count_large", f"{little}element vertex 4000000000\n{xyz}", b"\0" * 36)
    ply("vertex_count_negative", f"{ascii_format}element vertex -3\n{xyz}", corners)
    ply("vertex_truncated", f"{little}{three}element face 1\n{face}", struct.pack("<8f", *TRIANGLE[:8]))
    ply("vertex_nan", f"{ascii_format}{three}element face 1\n{face}", b"0 0 0\n1 0 nan\n0 1 0\n3 0 1 2\n")
    ply("vertex_1e999", f"{ascii_format}{three}element face 1\n{face}", b"0 0 0\n1 0 1e999\n0 1 0\n3 0 1 2\n")
    ply("vertex_no_z", f"{ascii_format}element vertex 3\nproperty float x\nproperty float y\n", corners)
    ply("face_index_range", f"{ascii_format}{three}element face 1\n{face}", corners + b"3 0 1 3\n")
    ply("face_index_negative", f"{ascii_format}{three}element face 1\n{face}", corners + b"3 0 -1 2\n")
    ply(
        "face_list_length",
        f"{little}{three}element face 1\nproperty list uint int vertex_indices\n",
        struct.pack("<9fI3i", *TRIANGLE, 0xFFFFFFFF, 0, 1, 2),
    )
    ply("points_only", f"{ascii_format}{three}", corners)
    ply("type_unknown", f"{ascii_format}element vertex 3\nproperty real x\n", corners)
    ply("no_format", three, corners)
    (BAD / "header_unfinished.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    (BAD / "not_ply.ply").write_text("solid\n")

    header = b"".ljust(80, b" ")
    (BAD / "facet_count.stl").write_bytes(header + struct.pack("<I", 0xFFFFFFFF) + b"\0" * 50)
    (BAD / "truncated_binary.stl").write_bytes(header + struct.pack("<I", 2) + b"\0" * 60)
    (BAD / "header_short.stl").write_bytes(header[:60])
    (BAD / "no_facets.stl").write_bytes(header + struct.pack("<I", 0))
    (BAD / "not_finite.stl").write_bytes(
        header + struct.pack("<I12fH", 1, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0, math.inf, 0, 0)
    )
    loop = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
    (BAD / "truncated_text.stl").write_text(loop)
    (BAD / "two_corners.stl").write_text(loop + "endloop\nendfacet\nendsolid\n")
    (BAD / "four_corners.stl").write_text(loop + "vertex 0 1 0\nvertex 1 1 0\nendloop\nendfacet\nendsolid\n")
    (BAD / "not_a_number.stl").write_text(loop + "vertex 0 one 0\nendloop\nendfacet\nendsolid\n")

    (BAD / "face_range.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n")
    (BAD / "face_before_start.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -9\n")
    (BAD / "face_word.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 \\\n0\nf 1 2/x 3\n")
    (BAD / "position_nan.obj").write_text("v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n")
    (BAD / "position_1e999.obj").write_text("v 0 0 0\nv 1e999 0 0\nv 0 1 0\nf 1 2 3\n")
    (BAD / "truncated.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2")
    (BAD / "nothing.obj").write_text("# nothing\n")
    (BAD / "unknown.fbx").write_text("Kaydara FBX Binary\n")


def write_seeds(folder):
    readers = {".gltf": 0, ".glb": 0, ".obj": 1, ".ply": 2, ".stl": 3, ".png": 4, ".mtl": 5}
    folder.mkdir(parents=True, exist_ok=True)
    for path in sorted([*GOOD.rglob("*"), *BAD.iterdir()]):
        if path.suffix in readers:
            (folder / f"{path.parent.name}-{path.name}").write_bytes(bytes([readers[path.suffix]]) + path.read_bytes())


def main():
    parser = argparse.ArgumentParser(description="Writes the model files that the loading tests read.")
    parser.add_argument("--seeds", type=pathlib.Path, metavar="FOLDER", help="write seeds for the fuzzer instead")
    seeds = parser.parse_args().seeds
    if seeds:
        write_seeds(seeds)
        return
    GOOD.mkdir(exist_ok=True)
    BAD.mkdir(exist_ok=True)
    write_good_shapes()
    write_good_poses()
    write_good_materials()
    write_good_transmission()
    write_good_volume()
    write_good_plain()
    write_good_obj()
    write_bad()


if __name__ == "__main__":
    main()
