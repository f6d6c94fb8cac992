"""Reads and writes PNG files with 8 bits per channel (PNG specification, third edition)."""
from __future__ import annotations

import pathlib
import struct
import zlib

import numpy as np

CHANNELS = {0: 1, 2: 3, 4: 2, 6: 4}  # by colour type


def read(path: pathlib.Path) -> np.ndarray:
    """Returns rows x columns x channels, 0 to 255."""
    return decode(path.read_bytes(), str(path))


def decode(data: bytes, name: str) -> np.ndarray:
    """The same for the content of a file. The name is for messages."""
    if data[:8] != b"\x89PNG\r\n\x1a\n":
        raise ValueError(f"{name}: not a PNG file")
    at, packed, width, height, channels = 8, b"", 0, 0, 0
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + length]
        if kind == b"IHDR":
            width, height, depth, colour, _, _, interlace = struct.unpack(">IIBBBBB", body)
            if depth != 8 or interlace or colour not in CHANNELS:
                raise ValueError(f"{name}: depth {depth}, colour type {colour}, interlace {interlace}")
            channels = CHANNELS[colour]
        elif kind == b"IDAT":
            packed += body
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(packed), np.uint8).reshape(height, 1 + width * channels)
    return unfilter(rows[:, 0], rows[:, 1:].reshape(height, width, channels))


def write(path: pathlib.Path, image: np.ndarray) -> None:
    """Writes rows x columns x 3 channels, 0 to 255."""
    path.write_bytes(encode(image))


def encode(image: np.ndarray, level: int = -1) -> bytes:
    """The content of such a file. level: of zlib's compression."""
    height, width, _ = image.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), image.astype(np.uint8).reshape(height, -1)], axis=1)
    parts = [(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)), (b"IDAT", zlib.compress(rows.tobytes(), level)),
             (b"IEND", b"")]
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body)) for kind, body in parts)


def unfilter(kinds: np.ndarray, filtered: np.ndarray) -> np.ndarray:
    """Undoes the filters of the rows. A pixel needs those to its left, above, and above left, so the pixels of each
    diagonal from lower left to upper right are computed together."""
    height, width, channels = filtered.shape
    out = np.zeros((height + 1, width + 1, channels), np.int32)  # with a row above and a column at the left of zeros
    every_row = np.arange(height)
    for diagonal in range(height + width - 1):
        y = every_row[max(0, diagonal - width + 1):diagonal + 1]
        x = diagonal - y
        left, up, corner = out[y + 1, x], out[y, x + 1], out[y, x]
        kind = kinds[y][:, None]
        add = np.select([kind == 1, kind == 2, kind == 3, kind == 4],
                        [left, up, (left + up) // 2, paeth(left, up, corner)], 0)
        out[y + 1, x + 1] = (filtered[y, x] + add) & 255
    return out[1:, 1:].astype(np.uint8)


def paeth(left: np.ndarray, up: np.ndarray, corner: np.ndarray) -> np.ndarray:
    """The neighbour nearest to left + up - corner."""
    from_left, from_up = np.abs(up - corner), np.abs(left - corner)
    from_corner = np.abs(left + up - 2 * corner)
    is_left = (from_left <= from_up) & (from_left <= from_corner)
    return np.where(is_left, left, np.where(from_up <= from_corner, up, corner))
