#!/usr/bin/env python3
"""Compiles the blocks of code in the guides against the installed package:

    check_docs.py --prefix PREFIX --cc CC --cxx CXX [--prelude HEADER] [--pkg-config FOLDER] FILE.md...

```c and ```cpp: the body of a function, after docs/prelude.h or another header of that folder, or docs/opengl.h where it
calls OpenGL; or, where there is an `int main(`, a program for the rasteriser for CPUs, which pkg-config links and which
must end with 0 and print what the ```text block after it says. ```glsl: a whole fragment or compute shader, one for
vitrail/raster.glsl in all its stages, or the body of a fragment shader's main(). ```cmake: the end of a CMakeLists.txt with an executable `renderer`. ```sh is not run. A
block that does not say what it is nobody would compile: an error."""
import argparse
import os
import re
import subprocess
import sys
import tempfile

HERE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "docs")
SHADER_START = """#version 460
#extension GL_GOOGLE_include_directive : require
#define VITRAIL_SET 1
#include "vitrail/collect.glsl"
void main() {
"""
CMAKE_START = """cmake_minimum_required(VERSION 3.25)
project(guide LANGUAGES C)
add_executable(renderer main.c)
"""


def blocks_of(path):
    """(line, language, text) of each fenced block."""
    found, start, language, text = [], 0, None, []
    for number, line in enumerate(open(path, encoding="utf-8"), 1):
        fence = re.match(r"```(\w*)\s*$", line)
        if fence and language is None:
            start, language, text = number + 1, fence.group(1), []
            if not language:
                sys.exit(f"check_docs: {path}:{number}: the block does not say which language it is in (`text`: none)")
        elif fence:
            found.append((start, language, "".join(text)))
            language = None
        elif language is not None:
            text.append(line)
    if language is not None:
        sys.exit(f"check_docs: {path}:{start}: the block does not end")
    return found


def write(folder, name, text):
    path = os.path.join(folder, name)
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


def build_program(options, folder, line, where, text):
    environment = dict(os.environ, PKG_CONFIG_PATH=os.path.join(options.prefix, options.pkg_config))
    found = subprocess.run(["pkg-config", "--static", "--cflags", "--libs", "vitrail-cpu"], env=environment, check=True,
                           capture_output=True, text=True)
    source = write(folder, "block.c", f'#line {line} "{where}"\n{text}')
    return [options.cc, "-std=c11", "-Wall", "-Wextra", "-Werror", source, *found.stdout.split(), "-lm",
            "-o", os.path.join(folder, "program")]


def prelude_of(options, text):
    return "opengl.h" if re.search(r"\b(vitrailGl[A-Z]|vitrail::opengl\b|gl[A-Z])", text) else options.prelude


def compile_c(options, folder, line, where, text):
    if "int main(" in text:
        return build_program(options, folder, line, where, text)
    prelude = prelude_of(options, text)
    source = f'#include "{prelude}"\nvoid guide(void);\nvoid guide(void) {{\n#line {line} "{where}"\n{text}\n}}\n'
    return [options.cc, "-std=c11", write(folder, "block.c", source)] + c_flags(options)


def compile_cpp(options, folder, line, where, text):
    prelude = prelude_of(options, text)
    source = f'#include "{prelude}"\nvoid guide();\nvoid guide() {{\n#line {line} "{where}"\n{text}\n}}\n'
    return [options.cxx, "-std=c++20", write(folder, "block.cpp", source)] + c_flags(options)


def c_flags(options):
    warnings = ["-Wall", "-Wextra", "-Werror", "-Wno-unused", "-Wno-missing-field-initializers"]
    return ["-fsyntax-only", *warnings, f"-I{HERE}", f"-I{options.prefix}/include"]


def compile_raster(options, folder, text):
    compiler = ["glslc", "--target-env=vulkan1.2", "-Werror", f"-I{options.prefix}/share/vitrail/shaders", "-o", os.devnull,
                write(folder, "block.comp", text)]
    return ["sh", "-ec", 'for stage in 0 1 2 3 4; do "$@" -DVITRAIL_RASTER_STAGE=$stage; done', "stages", *compiler]


def compile_glsl(options, folder, line, where, text):
    if '"vitrail/raster.glsl"' in text:
        return compile_raster(options, folder, text)
    prelude = open(os.path.join(HERE, "prelude.glsl"), encoding="utf-8").read()
    if "void main()" not in text:
        text = SHADER_START + text + "}\n"
    elif "#version" not in text:
        text = "#version 460\n" + text
    source = text.replace("void main()", prelude + "void main()")
    stage = "comp" if "local_size_x" in text else "frag"
    return ["glslc", "--target-env=vulkan1.2", "-Werror", f"-I{options.prefix}/share/vitrail/shaders", "-o", os.devnull,
            write(folder, f"block.{stage}", source)]


def configure_cmake(options, folder, line, where, text):
    write(folder, "main.c", "int main(void) { return 0; }\n")
    write(folder, "CMakeLists.txt", CMAKE_START + text)
    return ["cmake", "-S", folder, "-B", os.path.join(folder, "build"), f"-DCMAKE_PREFIX_PATH={options.prefix}"]


COMPILERS = {"c": compile_c, "cpp": compile_cpp, "glsl": compile_glsl, "cmake": configure_cmake}


def run(folder, where, said):
    done = subprocess.run([os.path.join(folder, "program")], capture_output=True, text=True)
    if done.returncode == 0 and not done.stderr and done.stdout == said:
        return True
    print(f"check_docs: the program at {where} ended with {done.returncode} and said\n{done.stdout}{done.stderr}"
          f"where the guide has\n{said}", file=sys.stderr)
    return False


def check(options, path, line, language, text, said):
    where = f"{os.path.basename(path)}:{line}"
    with tempfile.TemporaryDirectory() as folder:
        command = COMPILERS[language](options, folder, line, os.path.basename(path), text)
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode == 0 and "int main(" in text:
            return run(folder, where, said)
    if done.returncode != 0:
        said = done.stdout + done.stderr
        print(f"check_docs: the {language} block at {where} does not compile:\n{said}", file=sys.stderr)
    return done.returncode == 0


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--prefix", required=True)
    parser.add_argument("--cc", default="cc")
    parser.add_argument("--cxx", default="c++")
    parser.add_argument("--prelude", default="prelude.h")
    parser.add_argument("--pkg-config", default="lib/pkgconfig")
    parser.add_argument("files", nargs="+")
    options = parser.parse_args()
    good = []
    for path in options.files:
        found = blocks_of(path)
        output = [after[2] if after[1] == "text" else "" for after in found[1:]] + [""]
        blocks = [(*block, said) for block, said in zip(found, output) if block[1] in COMPILERS]
        if not blocks:
            sys.exit(f"check_docs: {path} has no code to check")
        good += [check(options, path, *block) for block in blocks]
    if not all(good):
        sys.exit(1)
    print(f"check_docs: {len(good)} blocks compile")


main()
