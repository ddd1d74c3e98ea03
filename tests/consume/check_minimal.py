#!/usr/bin/env python3
"""Runs examples/minimal under the validation layer and checks its picture: check_minimal.py PROGRAM

check_minimal.py PROGRAM --like MINIMAL does the same with another example that draws the same scene, and compares its
picture (PPM or PNG) with that of examples/minimal.

check_minimal.py --picture FILE takes a picture that is there.

Some pixels are worked out in double precision, from the scene that examples/minimal/shaders describes."""
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

WIDTH, HEIGHT = 800, 600
EYE, LOOK_AT, FOCAL = (2.3, 2.15, 4.3), (0.0, -0.12, 0.0), 2.75
HORIZON, ZENITH = (0.70, 0.77, 0.84), (0.20, 0.38, 0.75)
TINTS = ((0.60, 0.90, 0.95), (0.98, 0.86, 0.52), (0.96, 0.64, 0.76))
TOLERANCE = 4  # of 255: up to nine panes, each rounded to 8 bits
FAR_APART, MEAN_APART = 0.06, 1.5  # of the values; of 255


def fail(message):
    sys.exit(f"check_minimal: {message}")


def read_png(path):
    """The rows of an 8-bit RGB picture."""
    data = open(path, "rb").read()
    place, packed = 8, b""
    while place < len(data):
        size, kind = struct.unpack(">I4s", data[place:place + 8])
        body = data[place + 8:place + 8 + size]
        if kind == b"IHDR" and struct.unpack(">IIBBBBB", body)[:6] != (WIDTH, HEIGHT, 8, 2, 0, 0):
            fail(f"{path} is not an RGB picture of {WIDTH}x{HEIGHT}")
        packed += body if kind == b"IDAT" else b""
        place += 12 + size
    raw, stride, rows = zlib.decompress(packed), 3 * WIDTH, []
    above = bytes(stride)
    for y in range(HEIGHT):
        first = y * (stride + 1)
        above = unfilter(raw[first], raw[first + 1:first + 1 + stride], above)
        rows.append(above[3:])
        above = above[3:]
    return rows


def unfilter(kind, row, above):
    """A row of three bytes a pixel as it was before one of PNG's filters, with a pixel of zeros to its left."""
    if kind == 2:
        return bytes(3) + bytes(r + u & 255 for r, u in zip(row, above))
    out, above = bytearray(3 + len(row)), bytes(3) + above
    if kind == 0:
        out[3:] = row
    for i, value in enumerate(row if kind else b"", 3):
        left, up = out[i - 3], above[i]
        if kind == 3:
            left = (left + up) // 2
        elif kind == 4:
            corner = above[i - 3]
            from_left, from_up, from_corner = abs(up - corner), abs(left - corner), abs(left + up - 2 * corner)
            if from_left > from_up or from_left > from_corner:
                left = up if from_up <= from_corner else corner
        out[i] = value + left & 255
    return out


def read_ppm(path):
    """The rows of a picture of three bytes a pixel."""
    data = open(path, "rb").read()
    header = b"P6 %d %d 255\n" % (WIDTH, HEIGHT)
    if not data.startswith(header) or len(data) != len(header) + 3 * WIDTH * HEIGHT:
        fail(f"{path} is not a PPM of {WIDTH}x{HEIGHT}")
    return [data[len(header) + 3 * WIDTH * y:][:3 * WIDTH] for y in range(HEIGHT)]


def read_picture(path):
    with open(path, "rb") as file:
        return read_ppm(path) if file.read(2) == b"P6" else read_png(path)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    return tuple(x / math.sqrt(dot(a, a)) for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def mix(a, b, t):
    return tuple(x + (y - x) * t for x, y in zip(a, b))


def smoothstep(low, high, x):
    t = min(max((x - low) / (high - low), 0.0), 1.0)
    return t * t * (3.0 - 2.0 * t)


def sky(direction):
    height = min(max(direction[1], 0.0), 1.0)
    return tuple(c * (0.5 if direction[1] < 0.0 else 1.0) for c in mix(HORIZON, ZENITH, height))


def ray_through(x, y):
    back = unit(tuple(e - t for e, t in zip(EYE, LOOK_AT)))
    right = unit(cross((0.0, 1.0, 0.0), back))
    up = cross(back, right)
    column = (2.0 * x / WIDTH - 1.0) * WIDTH / HEIGHT / FOCAL
    row = (1.0 - 2.0 * y / HEIGHT) / FOCAL
    return unit(tuple(column * r + row * u - b for r, u, b in zip(right, up, back)))


def floor_color(ray):
    """The colour, and what must be the same in the whole pixel."""
    if ray[1] >= 0.0:
        return HORIZON, None
    distance = (-1.0 - EYE[1]) / ray[1]
    x, z = EYE[0] + distance * ray[0], EYE[2] + distance * ray[2]
    if max(abs(x), abs(z)) > 60.0:
        return HORIZON, None
    square = (math.floor(2.0 * x), math.floor(2.0 * z))
    color = (0.74, 0.72, 0.68) if sum(square) % 2 == 0 else (0.28, 0.29, 0.32)
    away = math.hypot(max(abs(x) - 0.8, 0.0), max(abs(z) - 0.8, 0.0))
    shade = 0.55 + 0.45 * smoothstep(0.0, 1.2, away)
    color = tuple(shade * c for c in color)
    return mix(color, HORIZON, smoothstep(3.0, 16.0, distance - 4.0)), square


def panes_along(ray):
    """(distance, axis, offset, whether it is the pane's edge), the farthest first."""
    hits = []
    for axis in range(3):
        for offset in (-0.62, 0.0, 0.62):
            distance = (offset - EYE[axis]) / ray[axis]
            place = [EYE[i] + distance * ray[i] for i in range(3) if i != axis]
            if distance > 0.0 and max(map(abs, place)) < 1.0:
                hits.append((distance, axis, offset, max(map(abs, place)) >= 0.965))
    return sorted(hits, reverse=True)


def color_along(ray):
    color, square = floor_color(ray)
    hits = panes_along(ray)
    for _, axis, _, rim in hits:
        facing = abs(ray[axis])
        reflectance = 0.55 if rim else 0.04 + 0.96 * (1.0 - facing) ** 5
        reflected = sky([-r if i == axis else r for i, r in enumerate(ray)])
        color = [reflectance * s + (1.0 - reflectance) * t * c for s, t, c in zip(reflected, TINTS[axis], color)]
    return color, (square, [hit[1:] for hit in hits])


def pixel_color(x, y):
    """Codes of a pixel, and its number of panes; None where something ends within it."""
    corners = [color_along(ray_through(x + dx, y + dy)) for dx in (0.25, 0.75) for dy in (0.25, 0.75)]
    margins = [color_along(ray_through(x + dx, y + dy))[1] for dx in (-0.5, 1.5) for dy in (-0.5, 1.5)]
    if any(what != corners[0][1] for what in [c[1] for c in corners] + margins):
        return None
    linear = [sum(c[0][i] for c in corners) / 4.0 for i in range(3)]
    curve = [12.92 * c if c <= 0.0031308 else 1.055 * c ** (1.0 / 2.4) - 0.055 for c in linear]
    return [255.0 * min(c, 1.0) for c in curve], len(corners[0][1][1])


def under(x, y):
    """The numbers of the panes under the lower right quarter of a pixel, the nearest first; None where a pane ends near."""
    lists = [[3 * axis + round(offset / 0.62) + 1 for _, axis, offset, _ in reversed(panes_along(ray_through(u, v)))]
             for u in (x + 0.5, x + 1.0) for v in (y + 0.5, y + 1.0)]
    return lists[0] if all(one == lists[0] for one in lists) else None


def draw(program, path, *place):
    environment = dict(os.environ, VK_INSTANCE_LAYERS="VK_LAYER_KHRONOS_validation",
                       VK_LAYER_ENABLES="VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT")
    done = subprocess.run([program, path, *map(str, place)], env=environment, capture_output=True, text=True)
    if done.returncode != 0 or (done.stdout and not place) or done.stderr:
        fail(f"{program} ended with {done.returncode} and said: {done.stdout}{done.stderr}")
    return [int(line.split()[1]) for line in done.stdout.splitlines()]


def check_closed_forms(rows):
    checked, deepest = 0, 0
    for y in range(20, HEIGHT, 20):
        for x in range(20, WIDTH, 20):
            right = pixel_color(x, y)
            if right is None:
                continue
            codes = rows[y][3 * x:3 * x + 3]
            if any(abs(c - r) > TOLERANCE for c, r in zip(codes, right[0])):
                fail(f"pixel ({x}, {y}), {right[1]} panes deep, is {tuple(codes)} and should be "
                     f"({', '.join(f'{r:.1f}' for r in right[0])})")
            checked, deepest = checked + 1, max(deepest, right[1])
    if checked < 500 or deepest < 6:
        fail(f"only {checked} pixels, at most {deepest} panes deep, could be compared")
    print(f"check_minimal: {checked} pixels of up to {deepest} panes are right")


def check_lists(program, path):
    for place in ((400, 300), (330, 250), (500, 420), (10, 10)):
        panes, right = draw(program, path, *place), under(*place)
        if right is None or panes != right:
            fail(f"under pixel {place} are panes {right}, and the program lists {panes}")


def check_alike(rows, others):
    """Two pictures of the scene differ where something ends within a pixel: one shades it four times, one takes four
    samples and shades it once."""
    pairs = [(a, b) for row, other in zip(rows, others) for a, b in zip(row, other)]
    far = sum(abs(a - b) > TOLERANCE for a, b in pairs) / len(pairs)
    mean = sum(abs(a - b) for a, b in pairs) / len(pairs)
    if far > FAR_APART or mean > MEAN_APART:
        fail(f"the pictures differ by {mean:.2f} of 255 in the mean, and in {100 * far:.1f} % of the values by more than "
             f"{TOLERANCE}")
    print(f"check_minimal: {100 * (1 - far):.1f} % of the values are those of the other picture")


def main():
    program, *like = sys.argv[1:]
    if program == "--picture":
        return check_closed_forms(read_ppm(like[0]))
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "picture")
        draw(program, path)
        rows = read_picture(path)
        if like:
            draw(like[1], path)
            check_alike(rows, read_png(path))
        else:
            check_lists(program, path)
    check_closed_forms(rows)


if __name__ == "__main__":
    main()
