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

from streams import STREAMS, stream

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

    for name, mode in (("points", 0), ("lines", 1), ("line_loop", 2), ("line_strip", 3)):
        m = Model()
        # Vertex 4 is not named; the last line of the list is not whole; a line from vertex 2 to itself is none.
        indices = m.accessor([0, 1, 2, 2, 3, 2, 0], "SCALAR", UBYTE)
        m.mesh({"POSITION": m.accessor(QUAD + [9, 9, 9], "VEC3")}, mode=mode, indices=indices)
        m.save(f"{name}.gltf")
    m = quad()
    m.doc["meshes"][0]["primitives"][0]["material"] = m.put(
        "materials",
        {
            "doubleSided": True,
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0, 0, 1]},
            "extensions": {"KHR_materials_unlit": {}},
        },
    )
    lines = m.mesh({"POSITION": m.accessor([-1, 0.5, 1, 1, 0.5, 1], "VEC3")}, mode=1, material=0)
    m.doc["nodes"] = [
        {"camera": 0, "translation": [0, 0, 10]},
        {"mesh": 0, "translation": [-1, -1, 0]},
        {"mesh": lines},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1, 2]}]
    m.put("cameras", {"type": "orthographic", "orthographic": {"xmag": 1, "ymag": 1, "znear": 0.1, "zfar": 100}})
    m.save("lines_beside_triangles.gltf")
    m = Model()
    # A normal that is none leaves all points unlit.
    m.mesh({"POSITION": m.accessor(TRIANGLE, "VEC3"), "NORMAL": m.accessor([0, 0, 2] * 2 + [0, 0, 0], "VEC3")}, mode=0)
    m.mesh({"POSITION": m.accessor(TRIANGLE, "VEC3"), "NORMAL": m.accessor([0, 0, 2] * 3, "VEC3")}, mode=0)
    m.doc["nodes"] = [{"mesh": 0}, {"mesh": 1}]
    m.doc["scenes"] = [{"nodes": [0, 1]}]
    m.save("points_with_normals.gltf")

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


def write_good_hierarchies():
    """Files whose nodes are no strict trees, and nodes that extensions hide or repeat."""
    m = triangle()
    m.doc["nodes"] = [{"mesh": 0}, {"name": "outside", "children": [0], "translation": [5, 0, 0]}]
    m.save("root_is_child.gltf")
    m.doc["nodes"][1]["translation"] = [0, 0, 0]
    m.save("root_is_child_in_place.gltf")
    # All nodes are listed, as some exporters do.
    m.doc["nodes"] = [{"mesh": 0, "translation": [0, 1, 0]}, {"children": [0], "translation": [5, 0, 0]}]
    m.doc["scenes"] = [{"nodes": [0, 1, 1]}]
    m.save("all_nodes_listed.gltf")
    m.doc["nodes"] = [
        {"children": [2, 2], "translation": [1, 0, 0]},
        {"children": [2], "translation": [0, 1, 0]},
        {"mesh": 0},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1]}]
    m.save("node_two_parents.gltf")

    m = triangle()
    m.doc["extensionsUsed"] = ["KHR_node_visibility", "KHR_lights_punctual"]
    hide = {"extensions": {"KHR_node_visibility": {"visible": False}}}
    lights = [{"type": "point"}]
    m.doc["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    m.doc["nodes"] = [
        {"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": True}}},
        {"mesh": 0, "children": [2, 3], **hide},
        {"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": True}}},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1]}]
    m.save("visibility.gltf")

    m = triangle()
    m.doc["nodes"] = [{"mesh": 0, **hide}]
    m.save("all_hidden.gltf")

    # What of a file is wrong and can be left out: two of three cameras, a rotation, a variant's material, the letter
    # case and the slashes of a file's name, a texture that makes a material shine, twice the same missing file.
    m = triangle()
    m.doc["cameras"] = [
        {"type": "perspective", "perspective": {"yfov": 0, "znear": 1}},
        {"type": "perspective", "perspective": {"yfov": 1}},
        {"name": "right", "type": "perspective", "perspective": {"yfov": 1, "znear": 1}},
    ]
    m.doc["nodes"] = [{"mesh": 0, "camera": 0, "rotation": [0, 0, 0, 0], "children": [1, 2]}, {"camera": 1}, {"camera": 2}]
    m.doc["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}}
    mappings = [{"material": 7, "variants": [0]}, {"material": 0, "variants": [1, 5]}]
    m.doc["meshes"][0]["primitives"][0]["extensions"] = {"KHR_materials_variants": {"mappings": mappings}}
    m.doc["meshes"][0]["primitives"][0]["material"] = 0
    m.doc["images"] = [{"uri": ".\\Red%20GREEN.png"}, {"uri": "gone.png"}, {"uri": "gone.png"}]
    m.doc["textures"] = [{"source": 0}, {"source": 1}, {"source": 2}]
    m.doc["materials"] = [{
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0}, "metallicRoughnessTexture": {"index": 1}},
        "emissiveTexture": {"index": 2},
        "emissiveFactor": [1, 1, 1],
    }]
    (GOOD / "red green.png").write_bytes(RED_GREEN)
    m.save("parts_left_out.gltf")

    m = triangle()
    m.doc["extensionsUsed"] = ["EXT_mesh_gpu_instancing"]
    half = math.sqrt(0.5)
    instancing = {
        "TRANSLATION": m.accessor([0, 0, 0, 3, 0, 0], "VEC3"),
        "ROTATION": m.accessor([0, 0, 0, 127, 0, 0, round(127 * half), round(127 * half)], "VEC4", BYTE, normalized=True),
        "SCALE": m.accessor([1, 1, 1, 2, 2, 2], "VEC3"),
    }
    m.doc["nodes"] = [
        {"mesh": 0, "translation": [0, 10, 0], "extensions": {"EXT_mesh_gpu_instancing": {"attributes": instancing}}}
    ]
    m.save("instancing.gltf")

    # The same geometry in three meshes, one of which asks for other coordinates that the file does not have.
    m = triangle()
    m.put("meshes", copy.deepcopy(m.doc["meshes"][0]))
    m.put("meshes", copy.deepcopy(m.doc["meshes"][0]))
    m.doc["meshes"][1]["primitives"][0]["material"] = 0
    m.doc["meshes"][2]["primitives"][0]["indices"] = m.accessor([0, 2, 1], "SCALAR", UBYTE)
    m.put("materials", {"name": "other"})
    m.doc["nodes"] = [{"mesh": 0}, {"mesh": 1}, {"mesh": 2}]
    m.doc["scenes"] = [{"nodes": [0, 1, 2]}]
    m.save("shared_geometry.gltf")

    m = triangle()
    m.doc["nodes"] = [
        {"mesh": 0, "translation": [500000.25, 0, 4649776.25]},
        {"camera": 0, "translation": [500000.25, 0, 4649780.25]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [500000.25, 0.5, 4649776.25]},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1, 2]}]
    m.doc["cameras"] = [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.25}}]
    m.doc["extensions"] = {"KHR_lights_punctual": {"lights": [{"type": "point"}]}}
    m.doc["extensionsUsed"] = ["KHR_lights_punctual"]
    m.save("far_away.gltf")


def write_good_lights():
    m = triangle()
    m.doc["extensionsUsed"] = m.doc["extensionsRequired"] = ["KHR_lights_punctual"]
    lights = [
        {"type": "directional", "name": "sun", "color": [1, 0.5, 0], "intensity": 2},
        {"type": "point", "range": 7},
        {"type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5}},
        {"type": "area"},
    ]
    m.doc["extensions"] = {"KHR_lights_punctual": {"lights": lights}}
    half = math.sqrt(0.5)

    def light(index, **extra):
        return {"extensions": {"KHR_lights_punctual": {"light": index}}, **extra}

    # A quarter turn about x turns -z to +y; about y, -z to -x.
    m.doc["nodes"] = [
        {"mesh": 0},
        light(0, rotation=[half, 0, 0, half], scale=[3, 3, 3]),
        {"translation": [0, 0, 4], "children": [3]},
        light(1, translation=[1, 2, 0]),
        light(2, rotation=[0, half, 0, half]),
        light(3),
    ]
    m.doc["scenes"] = [{"nodes": [0, 1, 2, 4, 5]}]
    m.save("lights.gltf")


def write_good_variants():
    m = triangle()
    m.doc["extensionsUsed"] = ["KHR_materials_variants"]
    m.doc["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}}
    for name in ("plain", "bright", "dark"):
        m.put("materials", {"name": name})
    primitive = m.doc["meshes"][0]["primitives"][0]
    primitive["material"] = 0
    mappings = [{"material": 1, "variants": [0]}, {"material": 2, "variants": [1]}]
    m.doc["meshes"][0]["primitives"] = [
        primitive,
        {**primitive, "extensions": {"KHR_materials_variants": {"mappings": mappings}}},
    ]
    m.save("variants.gltf")


def write_good_extensions():
    """Extensions that are not drawn: on what is drawn, on what is not, and one that nobody knows."""
    m = quad(material=0)
    m.doc["asset"]["generator"] = "make_corpus.py"
    m.doc["extensionsUsed"] = ["MSFT_lod", "AGI_articulations", "EXAMPLE_unknown", "KHR_xmp_json_ld", "KHR_draco_mesh_compression"]
    m.doc["extensionsRequired"] = ["EXAMPLE_required"]
    m.put("materials", {"extensions": {"EXAMPLE_unknown": {}}})
    m.doc["nodes"] = [
        {"mesh": 0, "extensions": {"MSFT_lod": {"ids": [1]}}},
        {"mesh": 0, "extensions": {"AGI_articulations": {}}},
    ]
    m.doc["extensions"] = {"KHR_xmp_json_ld": {}}
    m.save("extensions.gltf")


def write_good_animations():
    """Each way of interpolating, on nodes, a skin and morph targets."""
    m = triangle()
    half = math.sqrt(0.5)
    m.doc["nodes"] = [
        {"mesh": 0, "name": "moved"},
        {"mesh": 0, "name": "turned", "translation": [0, 0, 7]},
        # A quarter turn about z, a scale of (2, 3, 4) and a translation.
        {"mesh": 0, "name": "matrix", "matrix": [0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 4, 0, 5, 6, 7, 1]},
        {"mesh": 0, "name": "stepped"},
        {"mesh": 0, "name": "curved"},
    ]
    m.doc["scenes"] = [{"nodes": [0, 1, 2, 3, 4]}]
    times = m.accessor([1, 3], "SCALAR")
    samplers = []

    def sampler(values, kind, interpolation=None, component=FLOAT, **extra):
        output = m.accessor(values, kind, component, **extra)
        entry = {"input": times, "output": output}
        if interpolation:
            entry["interpolation"] = interpolation
        samplers.append(entry)
        return len(samplers) - 1

    def channel(index, node, path):
        return {"sampler": index, "target": {"node": node, "path": path}}

    # The second rotation is a quarter turn about z, as the negated quaternion: the short way there is the other one.
    # In 16-bit integers, of which 23170 is the root of a half.
    turns = [0, 0, 0, 32767, 0, 0, -23170, -23170]
    first = [
        channel(sampler([0, 0, 0, 4, 0, 0], "VEC3"), 0, "translation"),
        channel(sampler(turns, "VEC4", "LINEAR", SHORT, normalized=True), 1, "rotation"),
        channel(sampler([1, 1, 1, 0, 0, 0], "VEC3"), 2, "scale"),
        channel(sampler([1, 0, 0, 2, 0, 0], "VEC3", "STEP"), 3, "translation"),
        # From 0 with slope 2 to 4 with slope 0, over 2 seconds.
        channel(sampler([0, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 4, 0, 0, 9, 9, 9], "VEC3", "CUBICSPLINE"), 4, "translation"),
        {"sampler": 0, "target": {"path": "pointer", "extensions": {"KHR_animation_pointer": {"pointer": "/x"}}}},
        {"sampler": 0, "target": {"path": "translation"}},
    ]
    m.put("animations", {"name": "walk", "channels": first, "samplers": samplers})
    later = m.accessor([0, 0.5, 10.5], "SCALAR")
    up = {"input": later, "output": m.accessor([0, 0, 0, 0, 1, 0, 0, 2, 0], "VEC3")}
    m.put("animations", {"name": "rise", "channels": [channel(0, 0, "translation")], "samplers": [up]})
    m.save("animations.gltf")

    # A joint that turns by a quarter about z within 2 seconds; the triangle's second corner follows it.
    m = Model()
    m.doc["nodes"] = [{"mesh": 0, "skin": 0, "translation": [100, 0, 0]}, {"children": [2]}, {"translation": [0, 0, 1]}]
    m.doc["scenes"] = [{"nodes": [0, 1]}]
    identity = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]
    m.put("skins", {"joints": [1, 2], "inverseBindMatrices": m.accessor(identity * 2, "MAT4")})
    m.mesh(
        {
            "POSITION": m.accessor(TRIANGLE, "VEC3"),
            "NORMAL": m.accessor(UP * 3, "VEC3"),
            "JOINTS_0": m.accessor([0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0], "VEC4", UBYTE),
            "WEIGHTS_0": m.accessor([1, 0, 0, 0] * 3, "VEC4"),
        }
    )
    turn = {"input": m.accessor([0, 2], "SCALAR"), "output": m.accessor([0, 0, 0, 1, 0, 0, half, half], "VEC4")}
    m.put("animations", {"channels": [channel(0, 1, "rotation")], "samplers": [turn]})
    m.save("animated_skin.gltf")

    m = triangle()
    m.doc["meshes"][0]["primitives"][0]["targets"] = [
        {"POSITION": m.accessor([0, 0, 1] * 3, "VEC3")},
        {"POSITION": m.accessor([1, 0, 0] * 3, "VEC3")},
    ]
    m.doc["meshes"][0]["weights"] = [1, 1]
    fade = {
        "input": m.accessor([0, 1], "SCALAR"),
        "output": m.accessor([0, 0, 255, 51], "SCALAR", UBYTE, normalized=True),
    }
    m.put("animations", {"name": "0", "channels": [channel(0, 0, "weights")], "samplers": [fade]})
    m.save("animated_morph.gltf")


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


def ktx2(vulkan_format, width, height, pixels, scheme=0, packed=None, model=1, key_values=()):
    """A KTX 2.0 texture of one level; `model` is the colour model of its data format descriptor."""
    descriptor = struct.pack("<IIHHBBBB", 4 + 24, 0, 2, 24, model, 1, 1, 0) + b"\0" * 12
    words = b""
    for key, value in key_values:
        pair = key.encode() + b"\0" + value.encode() + b"\0"
        words += struct.pack("<I", len(pair)) + pair + b"\0" * (-len(pair) % 4)
    descriptor_at = 80 + 24
    words_at = descriptor_at + len(descriptor)
    data_at = (words_at + len(words) + 15) // 16 * 16
    data = pixels if packed is None else packed
    header = struct.pack("<9I", vulkan_format, 1, width, height, 0, 0, 1, 1, scheme)
    index = struct.pack("<4I2Q", descriptor_at, len(descriptor), words_at, len(words), 0, 0)
    level = struct.pack("<3Q", data_at, len(data), len(pixels))
    front = b"\xabKTX 20\xbb\r\n\x1a\n" + header + index + level + descriptor + words
    return front.ljust(data_at, b"\0") + data


def zstd_stored(data):
    """A Zstandard frame of one block that is not compressed, of fewer than 256 bytes."""
    return b"\x28\xb5\x2f\xfd\x20" + bytes([len(data)]) + struct.pack("<I", len(data) << 3 | 1)[:3] + data


def draco_quad(name, **primitive):
    """A primitive that is compressed as a whole, whose accessors have no data of their own."""
    m = Model()
    m.doc["extensionsUsed"] = ["KHR_draco_mesh_compression"]

    def accessor(kind, component, count=4, **extra):
        return m.put("accessors", {"componentType": component, "count": count, "type": kind, **extra})

    view = m.view(stream(name))
    ids = {"POSITION": 7, "NORMAL": 2, "TEXCOORD_0": 5, "COLOR_0": 3}
    m.mesh(
        {
            "POSITION": accessor("VEC3", FLOAT),
            "NORMAL": accessor("VEC3", FLOAT),
            "TEXCOORD_0": accessor("VEC2", FLOAT),
            "COLOR_0": accessor("VEC4", UBYTE, normalized=True),
        },
        indices=accessor("SCALAR", USHORT, 6),
        extensions={"KHR_draco_mesh_compression": {"bufferView": view, "attributes": ids}},
        **primitive,
    )
    return m


def meshopt_view(m, name, mode, count, stride, extension="EXT_meshopt_compression", **extra):
    """A buffer view whose bytes are only in its compressed form, in buffer 0; buffer 1 is the fallback."""
    data = stream(name)
    m.data += b"\0" * (-len(m.data) % 4)
    compressed = {
        "buffer": 0,
        "byteOffset": len(m.data),
        "byteLength": len(data),
        "byteStride": stride,
        "count": count,
        "mode": mode,
        **extra,
    }
    m.data += data
    view = {"buffer": 1, "byteOffset": 0, "byteLength": count * stride, "extensions": {extension: compressed}}
    if mode == "ATTRIBUTES":
        view["byteStride"] = stride
    return m.put("bufferViews", view)


def meshopt_quad(extension="EXT_meshopt_compression", filtered=False):
    m = Model()
    m.doc["extensionsUsed"] = m.doc["extensionsRequired"] = [extension, "KHR_mesh_quantization"]

    def accessor(view, kind, component, count=4, **extra):
        return m.put("accessors", {"bufferView": view, "componentType": component, "count": count, "type": kind, **extra})

    if filtered:
        positions = meshopt_view(
            m, "MESHOPT_POSITIONS_EXPONENTIAL", "ATTRIBUTES", 4, 12, extension, filter="EXPONENTIAL"
        )
        indices = meshopt_view(m, "MESHOPT_INDICES", "INDICES", 4, 4, extension)
    else:
        positions = meshopt_view(m, "MESHOPT_POSITIONS", "ATTRIBUTES", 4, 12, extension)
        indices = meshopt_view(m, "MESHOPT_TRIANGLES", "TRIANGLES", 6, 2, extension)
    normals = meshopt_view(m, "MESHOPT_NORMALS_OCTAHEDRAL", "ATTRIBUTES", 4, 4, extension, filter="OCTAHEDRAL")
    m.mesh(
        {
            "POSITION": accessor(positions, "VEC3", FLOAT),
            "NORMAL": accessor(normals, "VEC3", BYTE, normalized=True),
        },
        indices=accessor(indices, "SCALAR", UINT if filtered else USHORT, 4 if filtered else 6),
        mode=5 if filtered else 4,
    )
    return m


def with_fallback(m, extension="EXT_meshopt_compression"):
    doc = m.finished()
    doc["buffers"].append({"byteLength": 1000, "extensions": {extension: {"fallback": True}}})
    return doc


def write_good_compressed():
    draco_quad("DRACO_EDGEBREAKER").save("draco_edgebreaker.gltf")
    m = draco_quad("DRACO_SEQUENTIAL", mode=5)
    m.doc["extensionsRequired"] = m.doc["extensionsUsed"]
    m.save("draco_sequential.gltf")
    # Damaged, but the same triangle stands beside it.
    m = triangle()
    view = m.view(stream("DRACO_EDGEBREAKER")[:60])
    m.doc["extensionsUsed"] = ["KHR_draco_mesh_compression"]
    m.doc["meshes"][0]["primitives"][0]["extensions"] = {
        "KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 7}}
    }
    m.save("draco_damaged_with_data.gltf")

    write_json(GOOD / "meshopt.gltf", with_fallback(meshopt_quad()))
    write_json(GOOD / "meshopt_filters.gltf", with_fallback(meshopt_quad(filtered=True)))
    khronos = "KHR_meshopt_compression"
    write_json(GOOD / "meshopt_khronos.gltf", with_fallback(meshopt_quad(khronos), khronos))
    m = triangle()
    rotations = meshopt_view(m, "MESHOPT_ROTATIONS_QUATERNION", "ATTRIBUTES", 4, 8, filter="QUATERNION")
    m.put(
        "accessors",
        {"bufferView": rotations, "componentType": SHORT, "count": 4, "type": "VEC4", "normalized": True},
    )
    write_json(GOOD / "meshopt_rotations.gltf", with_fallback(m))


def pictured(picture, mime="image/png", extension=None):
    """A quad with a base colour factor of (1, 0.5, 1, 0.5) and a texture."""
    m = quad(material=0)
    if picture is not None:
        m.doc["images"] = [{"name": "skin", "uri": data_uri(picture, mime) if isinstance(picture, bytes) else picture}]
    m.doc["textures"] = [{"extensions": {extension: {"source": 0}}} if extension else {"source": 0}]
    m.doc["materials"] = [
        {
            "alphaMode": "BLEND",
            "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 1, 0.5], "baseColorTexture": {"index": 0}},
        }
    ]
    if extension:
        m.doc["extensionsUsed"] = [extension]
    return m


def gif(width, height, palette, codes):
    """A GIF whose pixels are `codes`, of 2 bits each: a clear code goes before each of them."""
    bits = 0
    count = 0
    for code in [c for pixel in codes for c in (4, pixel)] + [5]:
        bits |= code << count
        count += 3
    data = bits.to_bytes((count + 7) // 8, "little")
    screen = b"GIF89a" + struct.pack("<HHBBB", width, height, 0x81, 0, 0) + bytes(palette).ljust(12, b"\0")
    image = b"," + struct.pack("<HHHHB", 0, 0, width, height, 0) + b"\2" + bytes([len(data)]) + data + b"\0"
    return screen + image + b";"


def write_good_images():
    pixels = bytes([255, 0, 0, 255, 0, 255, 0, 128])
    webp = stream("WEBP_LOSSLESS")
    plain = ktx2(37, 2, 1, pixels)
    turned = ktx2(9, 1, 2, bytes([10, 20]), key_values=[("KTXorientation", "ru"), ("KTXswizzle", "rrr1")])
    for name, picture, extension in (
        ("image_webp", webp, "EXT_texture_webp"),
        ("image_webp_plain_source", webp, None),
        ("image_webp_lossy", stream("WEBP_LOSSY"), "EXT_texture_webp"),
        ("image_ktx2", plain, "KHR_texture_basisu"),
        ("image_ktx2_zlib", ktx2(37, 2, 1, pixels, 3, zlib.compress(pixels)), "KHR_texture_basisu"),
        ("image_ktx2_zstd", ktx2(43, 2, 1, pixels, 2, zstd_stored(pixels)), None),
        ("image_ktx2_grey", turned, None),
        ("image_ktx2_16", ktx2(77, 1, 1, struct.pack("<2H", 32896, 65535)), None),
        ("image_ktx2_bgr", ktx2(30, 1, 1, bytes([1, 2, 3])), None),
        ("image_gif", gif(2, 1, [255, 0, 0, 0, 255, 0], [0, 1]), None),
    ):
        m = pictured(picture, "image/any", extension)
        if extension:
            m.doc["extensionsRequired"] = [extension]
        m.save(f"{name}.gltf")
    # An image that cannot be read, and the plain one beside it.
    m = pictured(ktx2(0, 4, 4, bytes(16), model=166), "image/ktx2", "KHR_texture_basisu")
    m.put("images", {"uri": data_uri(RED_GREEN, "image/png")})
    m.doc["textures"][0]["source"] = 1
    m.save("image_basisu_fallback.gltf")


def write_good_without_images():
    """Each is drawn without its image, with the warning that load_missing_images_test.cpp states."""

    def png_with(at, data):
        changed = bytearray(RED_GREEN)
        changed[at : at + len(data)] = data
        changed[29:33] = struct.pack(">I", zlib.crc32(bytes(changed[12:29])))
        return bytes(changed)

    table = bytes([0] + [17] * 16 + [0] * 272)
    jpeg = b"\xff\xd8\xff\xc4" + struct.pack(">H", 2 + len(table)) + table
    uastc = ktx2(0, 4, 4, bytes(16), model=166)
    pictures = {
        "garbage": b"no picture at all",
        "huge": png_with(16, struct.pack(">II", 16000, 16000)),
        "jpeg_table": jpeg,
        "over_limit": png_with(16, struct.pack(">II", 100000, 2)),
        "truncated": RED_GREEN[:50],
        "missing": "not-there.png",
        "remote": "https://example.org/skin.png",
        "outside": "/dev/zero",
        "data_uri": "data:image/png;base64,AAAA!!!!AAAA",
        "avif": b"\0\0\0\x20ftypavif" + bytes(20),
        "dds": b"DDS " + bytes(124),
        "webp_damaged": stream("WEBP_LOSSLESS")[:30],
        "webp_huge": stream("WEBP_LOSSLESS")[:21] + b"\xff\xff\xff\x1f" + stream("WEBP_LOSSLESS")[25:],
        "basisu_etc1s": ktx2(0, 4, 4, bytes(16), 1, b"", 163),
        "ktx2_cut_off": ktx2(37, 2, 1, bytes(8))[:-4],
        "ktx2_header": ktx2(37, 2, 1, bytes(8))[:70],
        "ktx2_huge": ktx2(37, 16384, 16384, bytes(8)),
        "ktx2_layers": ktx2(37, 2, 1, bytes(100000), 3, zlib.compress(bytes(100000))),
        "ktx2_pixels": ktx2(37, 2, 1, bytes(4)),
        "ktx2_zlib": ktx2(37, 2, 1, bytes(8), 3, b"no zlib"),
        "ktx2_zstd": ktx2(37, 2, 1, bytes(8), 2, b"no Zstandard"),
        "ktx2_scheme": ktx2(37, 2, 1, bytes(8), 9),
        "ktx2_bc7": ktx2(145, 4, 4, bytes(16)),
    }
    for name, picture in pictures.items():
        pictured(picture).save(f"no_image_{name}.gltf")
    m = pictured(uastc, "image/ktx2", "KHR_texture_basisu")
    m.doc["extensionsRequired"] = ["KHR_texture_basisu"]
    m.save("no_image_basisu_uastc.gltf")
    m = pictured(None)
    m.doc["textures"] = [{}]
    m.save("no_image_texture.gltf")
    m = pictured("skin.png")
    del m.doc["images"][0]["uri"]
    m.save("no_image_neither.gltf")
    m = pictured("skin.png")
    m.doc["images"][0]["bufferView"] = 0
    m.save("no_image_both.gltf")
    m = pictured("skin.png")
    m.doc["images"] = [{"bufferView": 0}]
    m.doc["bufferViews"].insert(0, {"buffer": 0, "byteOffset": 4, "byteLength": 10000})
    for accessor in m.doc["accessors"]:
        accessor["bufferView"] += 1
    m.save("no_image_buffer_view.gltf")


def ply_header(encoding, elements, comments=()):
    """`elements`: name, count and the lines of its properties without the word "property"."""
    lines = ["ply", f"format {encoding} 1.0", *(f"comment {text}" for text in comments)]
    for name, count, properties in elements:
        lines += [f"element {name} {count}", *(f"property {text}" for text in properties)]
    return "\n".join([*lines, "end_header", ""])


XYZ = ["float x", "float y", "float z"]
RGBA = ["uchar red", "uchar green", "uchar blue", "uchar alpha"]
CORNERS = "list uchar int vertex_indices"
SQUARE = "-1 -1 0\n1 -1 0\n1 1 0\n-1 1 0\n"


def write_good_ply():
    def text(name, elements, body, comments=()):
        (GOOD / name).write_text(ply_header("ascii", elements, comments) + body)

    # Two triangles that share an edge and not their colour.
    text(
        "face_colors.ply",
        [("vertex", 4, XYZ), ("face", 2, [CORNERS, *RGBA])],
        SQUARE + "3 0 1 2 255 0 0 128\n3 0 2 3 0 0 255 255\n",
    )
    # MeshLab's way of three textures, one of them not there, and a face without one.
    text(
        "face_textures.ply",
        [("vertex", 4, XYZ), ("face", 4, [CORNERS, "list uchar float texcoord", "int texnumber"])],
        SQUARE
        + "4 0 1 2 3 8 0 0 1 0 1 1 0 1 0\n3 0 1 2 6 0 0 1 0 1 0.25 1\n3 0 1 2 6 0 0 1 0 1 1 2\n3 0 1 3 0 -1\n",
        ["made by make_corpus.py", "TextureFile leaf.png", "TextureFile a+b c.png", "TextureFile not there.png"],
    )
    # Artec's way of two textures.
    text(
        "artec.ply",
        [
            ("vertex", 4, XYZ),
            ("face", 2, [CORNERS]),
            ("multi_texture_vertex", 4, ["uchar tx", "float u", "float v"]),
            ("multi_texture_face", 2, ["uchar tx", "uint tn", "list uchar int texture_vertex_indices"]),
        ],
        SQUARE + "3 0 1 2\n3 0 2 3\n0 0 0\n0 1 0\n1 1 0.25\n1 0 1\n0 7 3 0 1 2\n1 7 3 0 2 3\n",
        ["TextureFile C:\\scans\\LEAF.PNG", "TextureFile a+b c.png"],
    )
    text(
        "corner_colors.ply",
        [("vertex", 3, XYZ), ("face", 2, [CORNERS, "list uchar float color"])],
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 1 0 0 0 1 0 0 0 1\n3 0 2 1 9 1 0 0 0 0 1 0 0.5 0\n",
    )
    # A cloud in rows and columns, as the Point Cloud Library writes it: places without a measurement are not numbers.
    points = [(0, 0, 0), (math.nan, math.nan, math.nan), (1, 0, 0), (1, 2, 0)]
    (GOOD / "points.ply").write_bytes(
        ply_header("binary_little_endian", [("vertex", 4, XYZ + ["ushort red", "ushort green", "ushort blue"])]).encode()
        + b"".join(struct.pack("<3f3H", *p, 65535, 0, 32768) for p in points)
    )
    splat = ["float nx", "float ny", "float nz", *(f"float f_dc_{i}" for i in range(3)), "float f_rest_0", "float opacity"]
    splat += [*(f"float scale_{i}" for i in range(3)), *(f"float rot_{i}" for i in range(4))]
    first = [1.7724538509, 0, -1.7724538509]  # half a unit up and down
    (GOOD / "splats.ply").write_bytes(
        ply_header("binary_little_endian", [("vertex", 2, XYZ + splat)]).encode()
        + struct.pack("<18f", 0, 0, 0, 0, 0, 0, *first, 9, 0, -3, -3, -3, 1, 0, 0, 0)
        + struct.pack("<18f", 1, 0, 0, 0, 0, 0, *first, 9, 100, -3, -3, -3, 1, 0, 0, 0)
    )
    text(
        "edges.ply",
        [("vertex", 3, XYZ), ("edge", 2, ["int vertex1", "int vertex2", "uchar red", "uchar green", "uchar blue"])],
        "0 0 0\n1 0 0\n1 1 0\n0 1 255 0 0\n1 2 0 0 255\n",
    )
    # A triangle with a side of a metre, 4649 km from its origin.
    text(
        "far_away.ply",
        [("vertex", 3, ["double x", "double y", "double z"]), ("face", 1, [CORNERS])],
        "500000.25 4649776.125 10.5\n500001.25 4649776.125 10.5\n500000.25 4649777.125 10.5\n3 0 1 2\n",
    )
    # Line ends of Windows, a list counted in 32 bits, properties of no meaning between others, a vertex of no face.
    header = ply_header(
        "binary_little_endian",
        [
            ("vertex", 5, ["float confidence", *XYZ, "double quality"]),
            ("range_grid", 1, ["list uint8 int32 vertex_indices"]),
            ("face", 1, ["uchar flags", "list uint uint vertex_index", "float area"]),
        ],
    )
    (GOOD / "windows.ply").write_bytes(
        header.replace("\n", "\r\n").encode()
        + b"".join(struct.pack("<4fd", 0.5, *QUAD[3 * i : 3 * i + 3], 7) for i in range(4))
        + struct.pack("<4fd", 0.5, 9, 9, 9, 7)
        + struct.pack("<Bi", 1, 0)
        + struct.pack("<BI4If", 1, 4, 0, 1, 3, 2, 4)
    )


def write_good_stl(facet, binary):
    flat = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
    (GOOD / "uppercase.stl").write_text(f"solid a\n{facet(*flat)}endsolid a\n".upper())
    # Names made of the format's own words, several solids, words in two, normals and corners that are no numbers.
    (GOOD / "solids.stl").write_bytes(
        b"\xef\xbb\xbfsolid facet vertex outer loop\r\n"
        + facet(*flat).replace("endloop", "end loop").replace("endfacet", "end facet").replace("\n", "\r\n").encode()
        + b"end solid facet vertex\r\nsolid\r\nfacet normal nan -nan(ind) 1\r\nouter loop\r\n"
        + b"vertex 0 0 +1.0E+00\r\nvertex 1 0 1.\r\nvertex 0 .1e1 1\r\nendloop\r\nendfacet\r\n"
        + b"facet\r\nouter loop\r\nvertex 0 0 nan\r\nvertex 1 0 0\r\nvertex 0 1 0\r\nendloop\r\nendfacet\r\nendsolid"
    )
    (GOOD / "old_mac.stl").write_bytes(f"solid a\n{facet(*flat)}endsolid a\n".replace("\n", "\r").encode())
    (GOOD / "one_line.stl").write_text(f"solid a {facet(*flat)} endsolid a".replace("\n", " "))
    (GOOD / "utf16.stl").write_bytes(b"\xff\xfe" + f"solid a\n{facet(*flat)}endsolid a\n".encode("utf-16-le"))
    far = [(500000.25 + x, 4649776.125 + y, 10.5) for x, y, _ in flat]
    (GOOD / "far_away.stl").write_text(f"solid a\n{facet(*far)}endsolid a\n")
    whole = binary(b"counts", [(TRIANGLE, 0), ([v + 2 for v in TRIANGLE], 0)])
    (GOOD / "count_zero.stl").write_bytes(whole[:80] + struct.pack("<I", 0) + whole[84:])
    (GOOD / "count_large.stl").write_bytes(whole[:80] + struct.pack("<I", 1000) + whole[84:] + b"\0\0\0")
    (GOOD / "count_small.stl").write_bytes(whole[:80] + struct.pack("<I", 1) + whole[84:])
    material = b"COLOR=" + bytes([255, 0, 0, 51]) + b",MATERIAL=" + bytes([0, 0, 255, 255] + [0] * 8)
    (GOOD / "magics_material.stl").write_bytes(binary(material, [(TRIANGLE, 0x8000)]))
    # A ridge of five facets with a crease of 30 degrees between neighbours, so that no two meet at more than 45.
    corners = []
    for i in range(4):
        a, b = math.radians(30 * i), math.radians(30 * (i + 1))
        corners += [((math.cos(a), math.sin(a), 0), (math.cos(b), math.sin(b), 0), (math.cos(b), math.sin(b), 1))]
        corners += [((math.cos(a), math.sin(a), 0), (math.cos(b), math.sin(b), 1), (math.cos(a), math.sin(a), 1))]
    (GOOD / "ridge.stl").write_bytes(binary(b"ridge", [([v for p in c for v in p], 0) for c in corners]))


def write_good_material_extensions():
    """One material with all extensions that it may have, and one of specular colour and glossiness."""
    m = Model()
    m.put("images", {"uri": data_uri(RED_GREEN, "image/png")})
    m.put("textures", {"source": 0})
    texture = {"index": 0}
    extensions = {
        "KHR_materials_ior": {"ior": 1.8},
        "KHR_materials_volume": {
            "thicknessFactor": 2,
            "thicknessTexture": texture,
            "attenuationDistance": 3,
            "attenuationColor": [0.1, 0.2, 0.3],
        },
        "KHR_materials_specular": {
            "specularFactor": 0.5,
            "specularTexture": texture,
            "specularColorFactor": [2, 0.5, 0],
            "specularColorTexture": texture,
        },
        "KHR_materials_clearcoat": {
            "clearcoatFactor": 0.6,
            "clearcoatTexture": texture,
            "clearcoatRoughnessFactor": 0.2,
            "clearcoatRoughnessTexture": texture,
            "clearcoatNormalTexture": texture,
        },
        "KHR_materials_sheen": {
            "sheenColorFactor": [0.1, 0.2, 0.9],
            "sheenColorTexture": texture,
            "sheenRoughnessFactor": 0.3,
            "sheenRoughnessTexture": texture,
        },
        "KHR_materials_anisotropy": {
            "anisotropyStrength": 0.7,
            "anisotropyRotation": 1.5,
            "anisotropyTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"scale": [2, 3]}}},
        },
        "KHR_materials_iridescence": {
            "iridescenceFactor": 0.8,
            "iridescenceTexture": texture,
            "iridescenceIor": 1.4,
            "iridescenceThicknessMinimum": 200,
            "iridescenceThicknessMaximum": 500,
            "iridescenceThicknessTexture": texture,
        },
        "KHR_materials_diffuse_transmission": {
            "diffuseTransmissionFactor": 0.25,
            "diffuseTransmissionColorFactor": [0.5, 0.75, 1],
            "diffuseTransmissionTexture": texture,
        },
    }
    old = {
        "diffuseFactor": [0.1, 0.2, 0.3, 0.4],
        "diffuseTexture": texture,
        "specularFactor": [0.5, 0.6, 0.7],
        "glossinessFactor": 0.75,
        "specularGlossinessTexture": texture,
    }
    m.put("materials", {"name": "all", "extensions": extensions})
    fallback = {"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 1}
    gloss = {"name": "gloss", "pbrMetallicRoughness": fallback, "alphaMode": "BLEND"}
    m.put("materials", {**gloss, "extensions": {"KHR_materials_pbrSpecularGlossiness": old}})
    coat = {"clearcoatFactor": 1, "clearcoatTexture": {"index": 0, "texCoord": 2}}
    several = {"baseColorTexture": texture, "metallicRoughnessTexture": {"index": 0, "texCoord": 1}}
    m.put("materials", {"pbrMetallicRoughness": several, "extensions": {"KHR_materials_clearcoat": coat}})
    m.doc["extensionsUsed"] = [*extensions, "KHR_materials_pbrSpecularGlossiness", "KHR_texture_transform"]
    attributes = {
        "POSITION": m.accessor(QUAD, "VEC3"),
        "NORMAL": m.accessor(UP * 4, "VEC3"),
        "TEXCOORD_0": m.accessor([0, 1, 1, 1, 0, 0, 1, 0], "VEC2"),
    }
    indices = m.accessor([0, 1, 2, 2, 1, 3], "SCALAR", USHORT)
    meshes = [m.mesh(attributes, indices=indices, material=i) for i in range(3)]
    m.doc["nodes"] = [{"mesh": mesh, "translation": [2 * mesh, 0, 0]} for mesh in meshes]
    m.doc["scenes"] = [{"nodes": [0, 1, 2]}]
    m.save("material_extensions.gltf")


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

    write_good_ply()

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

    write_good_stl(facet, binary)

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
    yield simple("extension_required", "extensionsRequired", ["KHR_accessor_float64"])
    yield "index_range", plain(indexed([0, 1, 3]))
    yield "index_restart", plain(indexed([0, 1, 65535]))
    yield "index_floats", plain(indexed([0, 1, 2], FLOAT))
    yield "index_vectors", plain(indexed([0, 1, 2], USHORT, "VEC3"))
    yield "joint_range", plain(skinned(2, 2))
    yield "joint_matrices", plain(skinned(0))
    yield simple("material_range", "meshes", 0, "primitives", 0, "material", 0)
    yield "material_texture_range", change(
        setter("materials", 0, "pbrMetallicRoughness", "baseColorTexture", "index", 1), lambda: textured_quad(RED_GREEN)
    )
    yield simple("material_factor_range", "materials", [{"pbrMetallicRoughness": {"metallicFactor": 1e39}}])
    glass = {"KHR_materials_transmission": {"transmissionTexture": {"index": 1}}}
    yield "material_transmission_range", change(setter("materials", [{"extensions": glass}]), triangle_with(**image))
    coat = {"KHR_materials_clearcoat": {"clearcoatFactor": [1]}}
    yield simple("material_extension_factor_type", "materials", [{"extensions": coat}])
    shiny = {"KHR_materials_pbrSpecularGlossiness": {"specularGlossinessTexture": {"index": 1}}}
    yield "material_extension_texture_range", change(setter("materials", [{"extensions": shiny}]), triangle_with(**image))
    volume = {"KHR_materials_volume": {"attenuationColor": [1, 0.5]}}
    yield simple("material_volume_color", "materials", [{"extensions": volume}])
    yield simple("material_factor_type", "materials", [{"pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1]}}])
    yield simple("mesh_mode", "meshes", 0, "primitives", 0, "mode", 7)
    yield simple("node_cycle", "nodes", [{"mesh": 0}, {"children": [2]}, {"children": [1]}])
    yield simple("node_light_range", "nodes", [{"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 2}}}])
    # Sixty-four levels that all lead to the next twice would make 2^64 triangles.
    levels = [{"children": [2 * i + 2, 2 * i + 3]} for i in range(64) for _ in range(2)]
    yield simple("node_copies", "nodes", [*levels, {"mesh": 0}, {"mesh": 0}])
    wrong = {"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 7}}}
    yield simple("instancing_range", "nodes", [{"mesh": 0, "extensions": wrong}])

    def instanced():
        m = triangle()
        attributes = {"TRANSLATION": 0, "SCALE": m.accessor([1, 1, 1], "VEC3")}
        m.doc["nodes"] = [{"mesh": 0, "extensions": {"EXT_mesh_gpu_instancing": {"attributes": attributes}}}]
        return m

    yield "instancing_counts", plain(instanced)
    yield simple("animation_accessor_range", "animations", [{"channels": [], "samplers": [{"input": 0, "output": 1}]}])
    yield simple("light_type", "extensions", {"KHR_lights_punctual": {"lights": [{"color": [1, 1, 1]}]}})
    doc = plain(triangle)
    del doc["accessors"][0]["bufferView"]
    doc["meshes"][0]["primitives"][0]["extensions"] = {"KHR_gaussian_splatting_compression_spz_2": {"bufferView": 0}}
    yield "extension_unreadable", doc
    yield simple("node_child_range", "nodes", 0, "children", [5])
    yield simple("node_mesh_range", "nodes", 0, "mesh", 1)
    yield simple("node_matrix_short", "nodes", 0, "matrix", [1] * 15)
    yield simple("node_far_away", "nodes", 0, "translation", [1e30, 0, 0])
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
    yield from bad_compressed()
    doc = plain(triangle)
    del doc["accessors"][0]["bufferView"]
    doc["accessors"][0]["count"] = 2**31
    yield "zero_filled_count", doc
    doc = plain(triangle)
    doc["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = len(doc["accessors"])
    doc["accessors"].append({**doc["accessors"][0], "count": 2})
    yield "attribute_counts", doc


def bad_compressed():
    """Compressed geometry that cannot be decoded."""

    def draco(data, **attributes):
        m = draco_quad("DRACO_EDGEBREAKER")
        m.doc["bufferViews"] = []
        m.data = b""
        m.view(data)
        m.doc["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"].update(attributes)
        return m.finished()

    whole = stream("DRACO_EDGEBREAKER")
    sequential = stream("DRACO_SEQUENTIAL")
    yield "draco_cut_off", draco(whole[:100])
    yield "draco_garbage", draco(b"no Draco at all")
    yield "draco_point_cloud", draco(whole[:7] + b"\0" + whole[8:])
    yield "draco_attribute", draco(whole, NORMAL=9)
    yield "draco_attribute_type", draco(whole, NORMAL="2")
    # Two counts of 2^28 - 1 where 2 triangles and 4 points stood.
    yield "draco_counts", draco(sequential[:11] + b"\xff\xff\xff\x7f" * 2 + sequential[13:])
    yield "draco_counts_edgebreaker", draco(whole[:12] + b"\xff\xff\xff\x7f" * 2 + whole[14:])

    def meshopt(view=0, data=None, **changes):
        doc = with_fallback(meshopt_quad())
        compressed = doc["bufferViews"][view]["extensions"]["EXT_meshopt_compression"]
        compressed.update(changes)
        if data is not None:
            buffer = bytearray(base64.b64decode(doc["buffers"][0]["uri"].split(",")[1]))
            buffer[compressed["byteOffset"] : compressed["byteOffset"] + len(data)] = data
            doc["buffers"][0]["uri"] = data_uri(bytes(buffer))
        return doc

    yield "meshopt_count", meshopt(count=2**31 - 1)
    yield "meshopt_count_triangles", meshopt(1, count=30000)
    yield "meshopt_damaged", meshopt(data=b"\xa0\xff\xff")
    yield "meshopt_filter", meshopt(filter="COLOR")
    yield "meshopt_filter_indices", meshopt(1, filter="OCTAHEDRAL")
    yield "meshopt_mode", meshopt(mode="POINTS")
    yield "meshopt_not_whole", meshopt(1, count=5)
    yield "meshopt_quaternion", meshopt(filter="QUATERNION")
    yield "meshopt_range", meshopt(byteOffset=10000)
    yield "meshopt_stride", meshopt(byteStride=10)
    yield "meshopt_stride_indices", meshopt(1, byteStride=3)
    yield "meshopt_version", meshopt(data=b"\xa1")
    doc = with_fallback(triangle())
    doc["bufferViews"][0]["buffer"] = 1
    yield "meshopt_fallback_alone", doc


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
    ply("vertex_count_large", f"{little}element vertex 4000000000\n{xyz}element face 1\n{face}", b"\0" * 36)
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
    ply("packed_splats", f"{little}element vertex 1\nproperty uint packed_position\n", b"\0" * 4)
    ply("type_unknown", f"{ascii_format}element vertex 3\nproperty real x\n", corners)
    ply("no_format", three, corners)
    (BAD / "header_unfinished.ply").write_text("ply\nformat ascii 1.0\nelement vertex 3\n")
    (BAD / "not_ply.ply").write_text("solid\n")

    header = b"".ljust(80, b" ")
    (BAD / "facet_count.stl").write_bytes(header + struct.pack("<I", 0xFFFFFFFF) + b"\x7f" * 50)
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
    (BAD / "comma.stl").write_text(loop + "vertex 0,5 1,0 0\nendloop\nendfacet\nendsolid\n")
    (BAD / "facet_in_loop.stl").write_text(loop + "facet\nouter loop\n")

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
    # Images, and compressed geometry, outside of glTF.
    for path in sorted(GOOD.glob("*image_*.gltf")):
        for image in json.loads(path.read_text()).get("images", []):
            if "base64," in image.get("uri", "") and "!" not in image["uri"]:
                data = base64.b64decode(image["uri"].split(",")[1])
                (folder / f"image-{path.stem}").write_bytes(bytes([4]) + data)
    for name in STREAMS:
        if name.startswith("DRACO"):
            (folder / f"stream-{name}").write_bytes(bytes([6]) + stream(name))
    meshopt = {
        "MESHOPT_POSITIONS": (0, 12, 4),
        "MESHOPT_NORMALS_OCTAHEDRAL": (3, 4, 4),
        "MESHOPT_ROTATIONS_QUATERNION": (6, 8, 4),
        "MESHOPT_POSITIONS_EXPONENTIAL": (9, 12, 4),
        "MESHOPT_TRIANGLES": (1, 4, 6),
        "MESHOPT_INDICES": (2, 4, 4),
    }
    for name, choices in meshopt.items():
        (folder / f"stream-{name}").write_bytes(bytes([7, *choices]) + stream(name))


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
    write_good_hierarchies()
    write_good_lights()
    write_good_variants()
    write_good_extensions()
    write_good_animations()
    write_good_materials()
    write_good_transmission()
    write_good_material_extensions()
    write_good_volume()
    write_good_plain()
    write_good_obj()
    write_good_compressed()
    write_good_images()
    write_good_without_images()
    write_bad()


if __name__ == "__main__":
    main()
