# make.py: writes the pictures of scenes/textures.yaml, surroundings.yaml, maps.yaml and mix.yaml beside itself, and that of the
# test scene cutout.
import math
import pathlib
import struct
import zlib

here = pathlib.Path(__file__).resolve().parent


def png(path, width, height, texel, channels=3):
    """texel(x, y): the channels, 0 to 255."""
    rows = b"".join(b"\0" + bytes(c for x in range(width) for c in texel(x, y)) for y in range(height))

    def chunk(kind, data):
        body = kind + data
        return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))

    kind = {3: 2, 4: 6}[channels]
    path.write_bytes(b"\x89PNG\r\n\x1a\n"
                     + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, kind, 0, 0, 0))
                     + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def hashed(*keys):
    """A number 0 to 1 that looks random."""
    value = zlib.crc32(repr(keys).encode())
    return value / 2**32


def crate(x, y):
    size, plank = 96, 16
    board, across = divmod(y, plank)
    frame = min(x, y, size - 1 - x, size - 1 - y) < 9
    if frame:
        board, across = 9, min(x, y, size - 1 - x, size - 1 - y) + 4
    if abs(x - y) < 7 and not frame:
        board, across = 8, x - y + 8
    along = x if board < 9 or 9 <= x < size - 9 else y
    grain = math.sin(0.9 * across + 2 * math.sin(0.05 * along + board) + 7 * hashed("board", board))
    shade = 0.78 + 0.08 * grain + 0.12 * hashed("tone", board)
    seam = 0.45 if across in (0, plank - 1) or (frame and across == 12) else 1
    nail = (x % 82 in (6, 7)) and (y % 82 in (6, 7))
    if nail:
        return 60, 58, 55
    return tuple(int(min(255, c * shade * seam)) for c in (214, 160, 98))


def tiles(x, y):
    joint = x % 32 < 1 or y % 32 < 1
    cell = (x // 32, y // 32)
    base = (196, 190, 178) if sum(cell) & 1 else (142, 92, 72)
    shade = 0.92 + 0.16 * hashed("tile", *cell)
    return (92, 90, 86) if joint else tuple(int(min(255, c * shade)) for c in base)


def leaf(x, y):
    """A leaf on a stalk, alpha 0 around it, with its own green spread there so that no rim shows."""
    u, v = (x + 0.5) / 64 * 2 - 1, 1 - (y + 0.5) / 64
    inside = 0.12 < v < 0.98
    width = 0.92 * math.sin(math.pi * (v - 0.12) / 0.86) ** 0.8 if inside else 0
    width *= 1 - 0.12 * (math.sin(40 * v) > 0)
    stalk = v <= 0.2 and abs(u) < 0.06
    vein = abs(u) < 0.03 or abs((v - 0.5 * abs(u)) * 9 % 1 - 0.5) < 0.06
    green = (150, 190, 70) if vein else (70, 140, 42)
    return (*((116, 84, 48) if stalk else green), 255 if stalk or abs(u) < width else 0)


def cutout(x, y):
    """The test scene's: red everywhere, opaque at the left."""
    return 255, 0, 0, 255 if x == 0 else 0


def smooth(edge, x):
    x = max(0.0, min(1.0, x / edge))
    return x * x * (3 - 2 * x)


def brick_at(x, y):
    """Which brick of 64 x 32 texels, and how far it is to its edge."""
    row = y // 32 % 4
    along = (x + 32 * (row & 1)) % 128
    return (row, along // 64), min(along % 64, 63 - along % 64, y % 32, 31 - y % 32)


def brick_height(x, y):
    """In texels: bricks stand out of the mortar and are a little uneven and askew."""
    brick, edge = brick_at(x % 128, y % 128)
    lean = (hashed("lean", *brick) - 0.5) * (x % 64) / 64 + (hashed("rise", *brick) - 0.5) * (y % 32) / 16
    waves = math.sin(0.4 * x + 5 * hashed("wave", *brick)) * math.sin(0.5 * y + 3 * hashed(*brick)) * 0.3
    return smooth(5, edge - 1) * (3 + lean + waves)


def bricks(x, y):
    brick, edge = brick_at(x, y)
    if edge < 2:
        return 150, 144, 134
    shade = 0.75 + 0.4 * hashed("shade", *brick)
    return tuple(int(c * shade) for c in (168, 84, 62))


def bricks_normal(x, y):
    across = (brick_height(x + 1, y) - brick_height(x - 1, y)) / 2
    down = (brick_height(x, y + 1) - brick_height(x, y - 1)) / 2
    length = math.sqrt(across * across + down * down + 1)
    return tuple(round(127 * c / length + 128) for c in (-across, down, 1))


def worn(x, y):
    """0: paint, 1: metal. It is worn off at the edges and in spots."""
    edge = min(x, y, 127 - x, 127 - y)
    spots = sum(math.sin(x * 2 * math.pi * i / 128 + 4 * i) * math.sin(y * 2 * math.pi * (i % 3 + 1) / 128 + i * i)
                for i in range(1, 6)) / 5
    return smooth(0.12, spots - 0.05 + 0.5 * (1 - smooth(14, edge)))


def plate(x, y):
    share = worn(x, y)
    return tuple(round(a + (b - a) * share) for a, b in ((28, 205), (96, 198), (150, 190)))


def plate_gloss(x, y):
    """As glTF has it: green is roughness, blue metal."""
    share = worn(x, y)
    scratch = 0.08 * math.sin(1.3 * y + math.sin(0.2 * x)) * share
    return 0, round(255 * (0.55 - 0.3 * share + scratch)), round(255 * share)


def dents(x, y):
    u, v = x / 64 * 2 * math.pi, y / 64 * 2 * math.pi
    height = 0.5 + 0.25 * math.cos(4 * u) * math.cos(4 * v) + 0.2 * math.sin(u + math.sin(2 * v)) * math.sin(v)
    return (round(255 * height),) * 3


def sign(x, y):
    """A neon arrow in a neon ring."""
    u, v = (x + 0.5) / 48 - 1, (y + 0.5) / 48 - 1
    ring = abs(math.hypot(u, v) - 0.82) - 0.05
    shaft = max(abs(v) - 0.05, abs(u + 0.05) - 0.45)
    head = max(abs(abs(v) - 0.45 + u) - 0.07, abs(v) - 0.36, -u)
    tube, pink = min(shaft, head), 1 - smooth(0.06, ring)
    blue = 1 - smooth(0.06, tube)
    return tuple(round(255 * min(1, a * pink + b * blue)) for a, b in ((1, 0.1), (0.12, 0.75), (0.45, 1)))


def studio(u, v):
    """A dark room with a lit ceiling and three lamps, linear, all around (u) and from up to down (v)."""
    if 0.47 < u < 0.53 and 0.18 < v < 0.24:
        return 40, 40, 40
    if 0.10 < u < 0.24 and 0.22 < v < 0.42:
        return 9, 7.5, 6
    if 0.70 < u < 0.78 and 0.15 < v < 0.45:
        return 5, 7, 11
    if v < 0.08:
        return 0.5, 0.5, 0.5
    return (0.05, 0.055, 0.065) if v <= 0.5 else (0.13 - 0.06 * v, 0.11 - 0.05 * v, 0.095 - 0.05 * v)


def rgbe(color):
    mantissa, exponent = math.frexp(max(color))
    scale = 256 * mantissa / max(color)
    return *(int(c * scale) for c in color), exponent + 128


def runs(values):
    """One channel of a row of a Radiance picture."""
    at = 0
    while at < len(values):
        end = at + 1
        while end < len(values) and values[end] == values[at] and end - at < 127:
            end += 1
        yield 128 + end - at
        yield values[at]
        at = end


def hdr(path, width, height, color):
    rows = [[rgbe(color((x + 0.5) / width, (y + 0.5) / height)) for x in range(width)] for y in range(height)]
    path.write_bytes(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
                     + b"".join(bytes([2, 2, width >> 8, width & 255])
                                + b"".join(bytes(runs([p[k] for p in row])) for k in range(4)) for row in rows))


def waves(x, y, size):
    """Numbers 0 to 1 at the corners of cells, blended between them; it repeats every 128."""
    i, j = x // size, y // size
    s, t = (k % size / size for k in (x, y))
    s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
    corner = [[hashed("wave", size, (i + a) * size % 128, (j + b) * size % 128) for a in (0, 1)] for b in (0, 1)]
    upper, lower = (row[0] * (1 - s) + row[1] * s for row in corner)
    return upper * (1 - t) + lower * t


def rust(x, y):
    """White where there is rust."""
    depth = sum(waves(x, y, size) * size for size in (32, 16, 8, 4)) / 60
    return (int(min(max((depth - 0.5) * 14, 0), 1) * 255),) * 3


hdr(here / "studio.hdr", 128, 64, studio)
png(here / "crate.png", 96, 96, crate)
png(here / "tiles.png", 128, 128, tiles)
png(here / "leaf.png", 64, 64, leaf, 4)
for name, size, texel in (("bricks", 128, bricks), ("bricks-normal", 128, bricks_normal), ("plate", 128, plate),
                          ("plate-gloss", 128, plate_gloss), ("dents", 64, dents), ("sign", 96, sign)):
    png(here / f"{name}.png", size, size, texel)
png(here / "rust.png", 128, 128, rust)
png(here.parents[1] / "tests/images/scenes/cutout.png", 2, 1, cutout, 4)
