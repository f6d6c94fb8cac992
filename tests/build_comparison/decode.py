"""Decodes PNG, PLY and OpenEXR artifacts, to describe differences better than by the first differing byte. Uses only the
standard library, reads only files of Hydroprint's programs, and raises ValueError for all others."""
import array
import itertools
import struct
import zlib

CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # number of channels of a PNG, by its colour type
PLY_TYPES = {"double": "d", "float": "f", "uchar": "B", "int": "i"}


def png_chunks(data):
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError("not a PNG file")
    at = 8
    while at < len(data):
        length, kind = struct.unpack_from(">I4s", data, at)
        yield kind, data[at + 8:at + 8 + length]
        at += length + 12


def paeth(left, up, corner):
    guess = left + up - corner
    return min((abs(guess - left), 0, left), (abs(guess - up), 1, up), (abs(guess - corner), 2, corner))[2]


def unfilter(kind, row, above, step):
    """Decodes one row of a PNG; `above` is the decoded previous row, `step` the bytes per pixel."""
    if kind == 0:
        return row
    if kind == 1:
        out = bytearray(len(row))
        for first in range(step):
            out[first::step] = bytes(value & 255 for value in itertools.accumulate(row[first::step]))
        return bytes(out)
    if kind == 2:
        return bytes((a + b) & 255 for a, b in zip(row, above))
    out = bytearray(row)
    for i, value in enumerate(row):
        left, corner = (out[i - step], above[i - step]) if i >= step else (0, 0)
        guess = (left + above[i]) // 2 if kind == 3 else paeth(left, above[i], corner)
        out[i] = (value + guess) & 255
    return bytes(out)


def read_png(data):
    """Returns width, height, bytes per pixel, the resolution chunk, and an iterator over the rows."""
    chunks = list(png_chunks(data))
    header = dict(chunks)
    width, height, depth, colour = struct.unpack(">IIBB", header[b"IHDR"][:10])
    if depth not in (8, 16):
        raise ValueError(f"{depth} bits per sample are not supported")
    step = CHANNELS[colour] * depth // 8
    raw = zlib.decompress(b"".join(content for kind, content in chunks if kind == b"IDAT"))

    def rows():
        stride, row = width * step, bytes(width * step)
        for start in range(0, len(raw), stride + 1):
            row = unfilter(raw[start], raw[start + 1:start + 1 + stride], row, step)
            yield row

    return width, height, step, header.get(b"pHYs"), rows()


def read_ply(data):
    """Returns the header's lines, the names of the vertices' properties, the vertices, and the triangles: 3, their corners,
    and other properties."""
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode().splitlines()
    vertices = next(int(line.split()[2]) for line in lines if line.startswith("element vertex"))
    scalars = [line.split()[1:] for line in lines if line.startswith("property") and "list" not in line]
    count = sum(line.startswith("property") for line in itertools.takewhile(lambda x: "element face" not in x, lines))
    of_vertices, of_faces = (struct.Struct(start + "".join(PLY_TYPES[kind] for kind, _ in part))
                             for start, part in (("<", scalars[:count]), ("<B3i", scalars[count:])))
    faces = end + vertices * of_vertices.size
    return (lines, [name for _, name in scalars[:count]], of_vertices.iter_unpack(data[end:faces]),
            of_faces.iter_unpack(data[faces:]))


def exr_header(data):
    if data[:4] != b"\x76\x2f\x31\x01":
        raise ValueError("not an OpenEXR file")
    at, attributes = 8, {}

    def text():
        nonlocal at
        end = data.index(b"\0", at)
        out, at = data[at:end].decode(), end + 1
        return out

    while name := text():
        text()  # its type
        size, = struct.unpack_from("<i", data, at)
        attributes[name] = data[at + 4:at + 4 + size]
        at += 4 + size
    return attributes, at


def exr_channels(attribute):
    names, at = [], 0
    while attribute[at]:
        end = attribute.index(b"\0", at)
        if struct.unpack_from("<i", attribute, end + 1)[0] != 2:
            raise ValueError("only channels of 32-bit floats are supported")
        names.append(attribute[at:end].decode())
        at = end + 17
    return names


def exr_block(packed, size):
    """Undoes OpenEXR's ZIP compression: deflate, byte differences, and two interleaved halves."""
    if len(packed) == size:
        return packed
    steps = zlib.decompress(packed)
    whole = bytes(value & 255 for value in
                  itertools.accumulate(steps, lambda before, step: before + step - 128))
    out = bytearray(size)
    half = (size + 1) // 2
    out[0::2], out[1::2] = whole[:half], whole[half:]
    return bytes(out)


def read_exr(data):
    """Returns the header's attributes and, by channel, all samples of a scan-line file of floats."""
    attributes, at = exr_header(data)
    if attributes["compression"] != b"\x03":
        raise ValueError("only ZIP compression of 16 lines is supported")
    left, bottom, right, top = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, top - bottom + 1
    channels = exr_channels(attributes["channels"])
    samples = {name: array.array("f") for name in channels}
    at += 8 * ((height + 15) // 16)
    for first in range(0, height, 16):
        _, length = struct.unpack_from("<ii", data, at)
        lines = min(16, height - first)
        block = exr_block(data[at + 8:at + 8 + length], lines * width * 4 * len(channels))
        for start, name in zip(range(0, len(block), 4 * width), itertools.cycle(channels)):
            samples[name].frombytes(block[start:start + 4 * width])
        at += 8 + length
    return attributes, samples
