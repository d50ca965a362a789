"""EXR pictures of 16-bit floats, ZIP-compressed, in scan lines: the references. The names of channels
are in alphabetical order in the file."""

import struct
import zlib

HALF, ZIP, LINES = 1, 3, 16  # lines of a block
MAGIC = b"\x76\x2f\x31\x01\x02\x00\x00\x00"


def attribute(name, kind, value):
    return b"%s\0%s\0%s%s" % (name, kind, struct.pack("<I", len(value)), value)


def read_attributes(data):
    """The attributes as name to bytes, and where the header ends."""
    if data[:8] != MAGIC:
        raise ValueError("not an EXR file of one part in scan lines")
    found, at = {}, 8
    while data[at]:
        name, kind, _ = data[at:at + 600].split(b"\0", 2)
        at += len(name) + len(kind) + 2
        size = struct.unpack_from("<I", data, at)[0]
        found[name.decode()] = data[at + 4:at + 4 + size]
        at += 4 + size
    return found, at + 1


def channel_names(text):
    names = []
    while text[0]:
        name, rest = text.split(b"\0", 1)
        if struct.unpack_from("<I", rest)[0] != HALF:
            raise ValueError("channels must be 16-bit floats")
        names.append(name.decode())
        text = rest[16:]
    return names


def pack(raw):
    """ZIP: the bytes of even places before those of odd, each as its difference to the one before."""
    parted = raw[0::2] + raw[1::2]
    differences = bytes([parted[0]]) + bytes(
        (b - a + 128) & 255 for a, b in zip(parted, parted[1:]))
    packed = zlib.compress(differences, 9)
    return packed if len(packed) < len(raw) else raw


def unpack(block, size):
    if len(block) == size:
        return block
    parted = bytearray(zlib.decompress(block))
    for i in range(1, size):
        parted[i] = (parted[i] + parted[i - 1] - 128) & 255
    raw, half = bytearray(size), (size + 1) // 2
    raw[0::2], raw[1::2] = parted[:half], parted[half:]
    return bytes(raw)


def read_exr(path):
    """(width, height), a list of values for each channel's name with the top row first, and the
    attributes as name to bytes."""
    with open(path, "rb") as file:
        data = file.read()
    found, at = read_attributes(data)
    left, top, right, bottom = struct.unpack("<4i", found["dataWindow"])
    if found["compression"][0] != ZIP:
        raise ValueError(path + ": not compressed as ZIP")
    width, height, names = right - left + 1, bottom - top + 1, channel_names(found["channels"])
    pictures = {name: [] for name in names}
    blocks = (height + LINES - 1) // LINES
    for offset in struct.unpack_from("<%dQ" % blocks, data, at):
        y, size = struct.unpack_from("<iI", data, offset)
        count = min(LINES, bottom + 1 - y) * width * len(names)
        block = unpack(data[offset + 8:offset + 8 + size], 2 * count)
        values = struct.unpack("<%de" % count, block)
        for i in range(0, count, width):
            pictures[names[i // width % len(names)]].extend(values[i:i + width])
    return (width, height), pictures, found


def write_exr(path, size, pictures, attributes=b""):
    """What read_exr reads."""
    width, height = size
    names = sorted(pictures)
    window = struct.pack("<4i", 0, 0, width - 1, height - 1)
    channels = b"".join(b"%s\0%s" % (n.encode(), struct.pack("<4i", HALF, 0, 1, 1)) for n in names)
    head = MAGIC + b"".join([
        attribute(b"channels", b"chlist", channels + b"\0"),
        attribute(b"compression", b"compression", bytes([ZIP])),
        attribute(b"dataWindow", b"box2i", window), attribute(b"displayWindow", b"box2i", window),
        attribute(b"lineOrder", b"lineOrder", b"\0"),
        attribute(b"pixelAspectRatio", b"float", struct.pack("<f", 1)),
        attribute(b"screenWindowCenter", b"v2f", bytes(8)),
        attribute(b"screenWindowWidth", b"float", struct.pack("<f", 1)), attributes, b"\0"])
    blocks, offsets = b"", []
    for top in range(0, height, LINES):
        rows = range(top, min(top + LINES, height))
        values = [v for y in rows for n in names for v in pictures[n][y * width:(y + 1) * width]]
        block = pack(struct.pack("<%de" % len(values), *values))
        offsets.append(len(head) + 8 * ((height + LINES - 1) // LINES) + len(blocks))
        blocks += struct.pack("<iI", top, len(block)) + block
    with open(path, "wb") as file:
        file.write(head + struct.pack("<%dQ" % len(offsets), *offsets) + blocks)
