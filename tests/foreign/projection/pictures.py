"""Test pictures: sums of a few sines with whole periods, so that they tile. Their colours are known at every place, not
only at the pixels."""
from __future__ import annotations

import pathlib
import struct
import zlib
from dataclasses import dataclass

import numpy as np

# Waves of each channel: whole periods to the right and up, and amplitude in sRGB codes. Phases come from the seed.
WAVES = ((1, 0, 24.0), (0, 1, 22.0), (1, 1, 10.0), (2, -1, 8.0))
MIDDLE = 130.0
MIDDLE_ALPHA, ALPHA_SHARE = 150.0, 1.3  # alpha from 67 to 233 of 255


@dataclass(frozen=True)
class Picture:
    """A picture with a file name, a size in pixels and phases (3 or 4 channels x waves)."""
    name: str
    width_px: int
    height_px: int
    phases: np.ndarray

    @property
    def aspect(self) -> float:
        return self.width_px / self.height_px

    def codes(self, u: np.ndarray, v: np.ndarray) -> np.ndarray:
        """Points x channels, 0 to 255: sRGB codes and, of pictures with transparency, alpha."""
        right, up, amplitude = np.array(WAVES).T
        angle = 2 * np.pi * (u[:, None] * right + v[:, None] * up)
        out = np.stack([np.sin(angle + phases) @ amplitude for phases in self.phases], axis=1)
        out[:, 3:] = MIDDLE_ALPHA + ALPHA_SHARE * out[:, 3:]
        out[:, :3] += MIDDLE
        return out

    def edge_continued(self, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Places beyond the middles of the outermost pixels are moved there."""
        half_u, half_v = 0.5 / self.width_px, 0.5 / self.height_px
        return np.clip(u, half_u, 1 - half_u), np.clip(v, half_v, 1 - half_v)

    def pixels(self) -> np.ndarray:
        """Rows x columns x channels; row 0 is at the top."""
        u = (np.arange(self.width_px) + 0.5) / self.width_px
        v = 1 - (np.arange(self.height_px) + 0.5) / self.height_px
        uu, vv = (values.reshape(-1) for values in np.meshgrid(u, v))
        return np.round(self.codes(uu, vv)).astype(np.uint8).reshape(self.height_px, self.width_px, -1)


def picture(name: str, seed: int, width_px: int = 768, height_px: int = 512, transparent: bool = False) -> Picture:
    phases = np.random.default_rng(seed).uniform(0, 2 * np.pi, (4 if transparent else 3, len(WAVES)))
    return Picture(name, width_px, height_px, phases)


def write_png(path: pathlib.Path, pixels: np.ndarray) -> None:
    """Writes 8 bits per channel: RGB or, with four channels, RGBA."""
    height, width, channels = pixels.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # each row begins with its filter, 0: none
    rows[:, 1:] = pixels.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, {3: 2, 4: 6}[channels], 0, 0, 0)
    chunks = [(b"IHDR", header), (b"sRGB", b"\0"), (b"IDAT", zlib.compress(rows.tobytes(), 6)), (b"IEND", b"")]
    out = b"\x89PNG\r\n\x1a\n"
    for kind, body in chunks:
        out += struct.pack(">I", len(body)) + kind + body + struct.pack(">I", zlib.crc32(kind + body))
    path.write_bytes(out)
