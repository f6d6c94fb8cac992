"""Which part of the surface lands first at each pixel of the film image."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

CHUNK = 1_000_000  # pairs of pixels and triangles that are computed at once


@dataclass(frozen=True)
class Raster:
    """Numbers of pixels (rows first), and the points of the surface that land there first, with their normals."""
    rows: int
    columns: int
    pixels: np.ndarray
    points: np.ndarray
    normals: np.ndarray

    def image(self) -> np.ndarray:
        """The point at each pixel (rows x columns x 3); NaN where there is none."""
        out = np.full((self.rows * self.columns, 3), np.nan, np.float32)
        out[self.pixels] = self.points
        return out.reshape(self.rows, self.columns, 3)


@dataclass(frozen=True)
class Triangles:
    """Points of a surface, their places on the film (mm from its middle to the right and up) and times of contact;
    triangles and their normals."""
    points: np.ndarray
    places: np.ndarray
    times: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray


def rasterised(given: Triangles, size_px: tuple[int, int], dpi: float) -> Raster:
    rows, columns = size_px
    triangles = given.triangles
    corners = (given.places * dpi / 25.4 * np.array([1, -1]) + np.array([columns, rows]) / 2 - 0.5)[triangles]
    size = np.ceil(np.ptp(corners, axis=1).max(axis=1)).astype(int) + 1
    found: list[tuple[np.ndarray, ...]] = []
    for pixels in np.unique(size):
        group = np.nonzero(size == pixels)[0]
        step = max(1, CHUNK // int(pixels) ** 2)
        for part in np.split(group, range(step, len(group), step)):
            pixel, owner, shares = covered(corners[part], int(pixels))
            inside = ((pixel >= 0) & (pixel < [columns, rows])).all(axis=1)
            owner, shares = part[owner[inside]], shares[inside]
            surface = (given.points[triangles[owner]] * shares[:, :, None]).sum(axis=1)
            times = (given.times[triangles[owner]] * shares).sum(axis=1)
            found.append((pixel[inside] @ [1, columns], surface, given.normals[owner], times))
    pixel, surface, normal, times = (np.concatenate(values) for values in zip(*found))
    order = np.lexsort((times, pixel))
    _, first = np.unique(pixel[order], return_index=True)
    chosen = order[first]
    return Raster(rows, columns, pixel[chosen], surface[chosen], normal[chosen])


def covered(corners: np.ndarray, size: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Pixels in triangles (n x 3 x 2) that are at most `size` pixels wide and high: column and row of the pixel, number
    of the triangle, and shares of its corners."""
    first = np.ceil(corners.min(axis=1))
    offsets = np.stack(np.meshgrid(np.arange(size), np.arange(size)), axis=2).reshape(-1, 2)
    pixels = first[:, None] + offsets[None]
    a, b, c = corners[:, None, 0], corners[:, None, 1], corners[:, None, 2]
    area = cross2(b - a, c - a)
    with np.errstate(invalid="ignore", divide="ignore"):
        of_b, of_c = cross2(pixels - a, c - a) / area, cross2(b - a, pixels - a) / area
    shares = np.stack([1 - of_b - of_c, of_b, of_c], axis=2)
    owner, which = np.nonzero((shares > -1e-9).all(axis=2))
    return pixels[owner, which].astype(int), owner, shares[owner, which]


def cross2(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]
