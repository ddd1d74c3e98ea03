#!/usr/bin/env python3
"""Makes a kernel's SPIR-V HLSL for Direct3D 11: kernel_to_hlsl.py SPIRV OUT STAGE SPIRV-CROSS

SPIRV-Cross translates; what is left to do is to be found in docs/notes/direct3d.md:
  - blocks of one binding become one buffer: HLSL has no two on one register
  - what depends on the target becomes a constant buffer, for want of specialization constants. The node format stays a
    macro, so that each format has a module of its own, and so does a sample count of 1
  - pixel shaders, whose unordered access views come behind the render targets, have one only, u7: the counters. What
    they read besides become shader resource views, from t8 on"""
import re
import subprocess
import sys

# What src/kernels/target.glsl specializes, by id; 0, the format, is defined by the build.
CONSTANTS = """cbuffer VitrailKernel : register(b1)
{
    uint vitrailKernelSamples;
    uint vitrailKernelNearestIsOne;
    uint vitrailKernelMaxLayers;
    uint vitrailKernelTestDepth;
};
#ifndef SPIRV_CROSS_CONSTANT_ID_1
#define SPIRV_CROSS_CONSTANT_ID_1 vitrailKernelSamples
#endif
#define SPIRV_CROSS_CONSTANT_ID_2 (vitrailKernelNearestIsOne != 0u)
#define SPIRV_CROSS_CONSTANT_ID_3 vitrailKernelMaxLayers
#define SPIRV_CROSS_CONSTANT_ID_4 (vitrailKernelTestDepth != 0u)

"""
BUFFER = r"((?:globallycoherent )?RWByteAddressBuffer (\w+) : register\((u\d+)\);\n)"
COUNTERS = "u1"  # VITRAIL_BINDING_CONTROL


def merge(text):
    first = {}
    for line, name, place in re.findall(BUFFER, text):
        if place in first:
            text = re.sub(rf"\b{name}\b", first[place], text.replace(line, ""))
        else:
            first[place] = name
    return text


def views_of_pixel_shader(text):
    for line, name, place in re.findall(BUFFER, text):
        if place == COUNTERS:
            text = text.replace(line, f"RWByteAddressBuffer {name} : register(u7);\n")
            continue
        if re.search(rf"\b{name}\.(Store|Interlocked)", text):
            raise SystemExit(f"a pixel shader writes {place}, which it only has to read from")
        text = text.replace(line, f"ByteAddressBuffer {name} : register(t{8 + int(place[1:])});\n")
    return text


def main():
    spirv, out, stage, cross = sys.argv[1:]
    subprocess.run([cross, spirv, "--hlsl", "--shader-model", "50", "--output", out], check=True)
    with open(out) as file:
        text = merge(file.read())
    if "SPIRV_Cross_NumWorkgroups" in text:
        raise SystemExit(f"{spirv}: HLSL does not tell how many work groups there are, and nobody binds that")
    if stage == "frag":
        text = views_of_pixel_shader(text)
    with open(out, "w") as file:
        file.write(CONSTANTS + text)


main()
