"""Areas of level sections of a body made of closed shells that may overlap.

A level plane is crossed by parallel rays. Along a ray, a shell is entered and left in turn (parity), so orientation and
nesting of faces do not matter. The body is the union of the insides of all shells.
"""
from __future__ import annotations

import numpy as np

from solids import Shape

import meshes

RAYS = 1200
DIRECTION_RAD = 0.4321  # oblique to the faces of most bodies, which makes the error of the sum one of second order


class Sections:
    """The sections of a mesh in frame F, where z is up."""

    def __init__(self, shape: Shape) -> None:
        (self.points, triangles), shell = meshes.prepared(shape)
        heights = self.points[:, 2][triangles]
        self.low, self.high = heights.min(axis=1), heights.max(axis=1)
        self.bottom, self.top = float(self.low.min()), float(self.high.max())
        self.triangles, self.shell = triangles, shell

    def area_mm2(self, depth_mm: float) -> float:
        """The area of the section at a height above the lowest point."""
        return self.area_and_gaps(depth_mm)[0]

    def area_and_gaps(self, depth_mm: float) -> tuple[float, int]:
        """Also the number of rays that enter a shell without leaving it, which is 0 for closed shells."""
        level = self.bottom + depth_mm
        crossed = (self.low < level) & (self.high >= level)
        ends = crossings(self.points, self.triangles[crossed], level)
        cosine, sine = np.cos(DIRECTION_RAD), np.sin(DIRECTION_RAD)
        return union_of_spans(ends @ np.array([(cosine, sine), (-sine, cosine)]), self.shell[crossed])

    def range_mm2(self, depth_mm: float, around_mm: float) -> tuple[float, float]:
        """The smallest and largest area at a depth and just below and above it: level faces are steps."""
        found = [self.area_mm2(depth_mm + shift) for shift in (-around_mm, 0, around_mm)]
        return min(found), max(found)


def crossings(points: np.ndarray, triangles: np.ndarray, level: float) -> np.ndarray:
    """The two ends (n x 2 x 2) of each triangle's section. Points at the level count as above it."""
    above = points[:, 2][triangles] >= level
    alone = np.where(above.sum(axis=1) == 1, np.argmax(above, axis=1), np.argmin(above, axis=1))
    rows = np.arange(len(triangles))
    corner = triangles[rows, alone]
    ends = []
    for step in (1, 2):
        other = triangles[rows, (alone + step) % 3]
        a, b = points[np.minimum(corner, other)], points[np.maximum(corner, other)]  # the same for both neighbours
        share = (level - a[:, 2]) / (b[:, 2] - a[:, 2])
        ends.append(a[:, :2] + share[:, None] * (b - a)[:, :2])
    return np.stack(ends, axis=1).reshape(-1, 2, 2)


def union_of_spans(ends: np.ndarray, shell: np.ndarray) -> tuple[float, int]:
    """Area inside at least one shell, summed along rays of constant y, and the number of rays with an odd crossing."""
    if not len(ends):
        return 0.0, 0
    low, high = ends[:, :, 1].min(), ends[:, :, 1].max()
    if high <= low:
        return 0.0, 0
    apart = (high - low) / RAYS
    first = np.ceil((ends[:, :, 1] - low) / apart - 0.5).astype(int)  # the first ray at or after each end
    start, stop = first.min(axis=1), first.max(axis=1)
    count = stop - start
    segment = np.repeat(np.arange(len(ends)), count)
    ray = np.arange(count.sum()) - np.repeat(np.cumsum(count) - count - start, count)
    a, b = ends[segment, 0], ends[segment, 1]
    share = (low + (ray + 0.5) * apart - a[:, 1]) / (b[:, 1] - a[:, 1])
    x = a[:, 0] + share * (b[:, 0] - a[:, 0])
    return spans(ray, shell[segment], x, apart)


def spans(ray: np.ndarray, shell: np.ndarray, x: np.ndarray, apart: float) -> tuple[float, int]:
    key = ray * (int(shell.max(initial=0)) + 1) + shell
    order = np.lexsort((x, key))
    key, ray, x = key[order], ray[order], x[order]
    _, start, count = np.unique(key, return_index=True, return_counts=True)
    whole = np.repeat(count % 2 == 0, count)
    ray, x = ray[whole], x[whole]
    if not len(x):
        return 0.0, int((count % 2).sum())
    width = float(x.max() - x.min()) + 1
    place = x - x.min() + ray * width  # all rays in a row
    enters, leaves = place[0::2], place[1::2]
    order = np.argsort(enters, kind="stable")
    enters, leaves = enters[order], np.maximum.accumulate(leaves[order])
    covered = np.concatenate([[-1.0], leaves[:-1]])
    return float(np.maximum(leaves - np.maximum(enters, covered), 0).sum() * apart), int((count % 2).sum())
