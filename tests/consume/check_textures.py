#!/usr/bin/env python3
"""Runs examples/raster_textures under the validation layer, by the raster and by fragment lists, and compares the
pictures: check_textures.py PROGRAM"""
import os
import sys
import tempfile

from check_minimal import draw, fail, read_png

TOLERANCE = 2       # of 255
FAR_APART = 0.0001  # of the values: where a mask ends, or surfaces cross, in another pixel
LEAST = 5000        # pixels of leaves, and of blue glass


def count(rows, what):
    return sum(what(*row[i:i + 3]) for row in rows for i in range(0, len(row), 3))


def main():
    program = sys.argv[1]
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture.png")
        draw(program, path)
        rows = read_png(path)
        draw(program, path, "--lists")
        lists = read_png(path)
    leaves = count(rows, lambda r, g, b: g > r + 10 and g > b + 40)
    blue = count(rows, lambda r, g, b: b > r + 30 and b > g + 15)
    if min(leaves, blue) < LEAST:
        fail(f"{leaves} pixels are green and {blue} blue: less than {LEAST}")
    pairs = [(a, b) for row, other in zip(rows, lists) for a, b in zip(row, other)]
    far = sum(abs(a - b) > TOLERANCE for a, b in pairs)
    if far > FAR_APART * len(pairs):
        fail(f"{far} of {len(pairs)} values differ from those by fragment lists by more than {TOLERANCE}")
    print(f"check_textures: all values but {far} of {len(pairs)} are those by fragment lists")


main()
