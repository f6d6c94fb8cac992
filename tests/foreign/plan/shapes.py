"""Test objects: points in mm, triangles counter-clockwise seen from outside, and rotations as quaternions w, x, y, z."""
from __future__ import annotations

import numpy as np

Shape = tuple[np.ndarray, np.ndarray]


def icosphere(radius_mm: float, subdivisions: int) -> Shape:
    """A subdivided icosahedron: 2 + 10 * 4^n points. The axes are axes of its symmetry."""
    golden = (1 + 5 ** 0.5) / 2
    points = np.array([(-1, golden, 0), (1, golden, 0), (-1, -golden, 0), (1, -golden, 0), (0, -1, golden), (0, 1, golden),
                       (0, -1, -golden), (0, 1, -golden), (golden, 0, -1), (golden, 0, 1), (-golden, 0, -1),
                       (-golden, 0, 1)])
    triangles = np.array([(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2),
                          (10, 7, 6), (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5),
                          (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)])
    points = points / np.linalg.norm(points[0])
    for _ in range(subdivisions):
        points, triangles = divided(points, triangles)
    return radius_mm * points, triangles


def divided(points: np.ndarray, triangles: np.ndarray) -> Shape:
    """Splits each triangle into four, with the new points on the unit sphere."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    middles = points[unique].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    ab, bc, ca = (number.reshape(-1) + len(points)).reshape(3, -1)
    a, b, c = triangles.T
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([points, middles]), np.concatenate([np.stack(part, axis=1) for part in parts])


def box(size_mm: tuple[float, float, float]) -> Shape:
    """A box with its middle at the origin: 8 points, 12 triangles."""
    points = np.array([(x, y, z) for z in (-1, 1) for y in (-1, 1) for x in (-1, 1)]) * np.array(size_mm) / 2
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return points, np.array(triangles)


def about(axis: int, angle_rad: float) -> np.ndarray:
    """The quaternion of a turn about a coordinate axis."""
    out = np.array([np.cos(angle_rad / 2), 0.0, 0.0, 0.0])
    out[1 + axis] = np.sin(angle_rad / 2)
    return out


def between(start: np.ndarray, end: np.ndarray) -> np.ndarray:
    """The quaternion of the shortest turn from one direction to another, which is not the opposite one."""
    a, b = start / np.linalg.norm(start), end / np.linalg.norm(end)
    out = np.array([1 + a @ b, *np.cross(a, b)])
    return out / np.linalg.norm(out)


def about_line(line: np.ndarray, angle_rad: float) -> np.ndarray:
    """The quaternion of a turn about any line through the origin."""
    return np.array([np.cos(angle_rad / 2), *np.sin(angle_rad / 2) * line / np.linalg.norm(line)])


def after(second: np.ndarray, first: np.ndarray) -> np.ndarray:
    """The quaternion of one turn after another."""
    w, v = second[0], second[1:]
    return np.array([w * first[0] - v @ first[1:], *(w * first[1:] + first[0] * v + np.cross(v, first[1:]))])


def rotation(q: np.ndarray) -> np.ndarray:
    """The matrix of a unit quaternion."""
    w, x, y, z = q
    return np.array([(1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
                     (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
                     (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))])
