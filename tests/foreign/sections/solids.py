"""Building blocks of the bodies: points in mm, triangles counter-clockwise seen from outside."""
from __future__ import annotations

import pathlib
import sys

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "plan"))

import shapes
from shapes import Shape

CORNERS = np.array([(0, 0), (1, 0), (1, 1), (0, 1)])


def joined(parts: list[Shape]) -> Shape:
    """All parts in one mesh; nothing is merged."""
    starts = np.cumsum([0] + [len(points) for points, _ in parts])
    triangles = [faces + start for (_, faces), start in zip(parts, starts)]
    return np.concatenate([points for points, _ in parts]), np.concatenate(triangles)


def inverted(shape: Shape) -> Shape:
    return shape[0], shape[1][:, ::-1]


def moved(shape: Shape, by_mm: tuple[float, float, float]) -> Shape:
    return shape[0] + np.array(by_mm), shape[1]


def turned(shape: Shape, quaternion: np.ndarray) -> Shape:
    return shape[0] @ shapes.rotation(quaternion).T, shape[1]


def as_float32(points: np.ndarray) -> np.ndarray:
    """The points as a binary STL file contains them."""
    return points.astype("<f4").astype(float)


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Shape:
    points, triangles = shapes.box((1, 1, 1))
    return (points + 0.5) * (np.array(high) - low) + low, triangles


def ellipsoid(middle: tuple[float, float, float], radii: tuple[float, float, float], subdivisions: int,
              quaternion: np.ndarray | None = None) -> Shape:
    points, triangles = shapes.icosphere(1, subdivisions)
    turn = np.eye(3) if quaternion is None else shapes.rotation(quaternion)
    return (points * np.array(radii)) @ turn.T + np.array(middle), triangles


def frustum(start: np.ndarray, end: np.ndarray, radii_mm: tuple[float, float], sides: int) -> Shape:
    """A closed cylinder or cone between two points; the second radius may be 0."""
    axis = (end - start) / np.linalg.norm(end - start)
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    across /= np.linalg.norm(across)
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.outer(np.cos(angle), across) + np.outer(np.sin(angle), np.cross(axis, across))
    i, after = np.arange(sides), (np.arange(sides) + 1) % sides
    fan = np.stack([np.zeros(sides - 2, int), i[1:-1], i[2:]], axis=1)
    low = start + radii_mm[0] * ring
    if radii_mm[1] == 0:
        return np.concatenate([low, end[None]]), np.concatenate(
            [fan[:, ::-1], np.stack([i, after, np.full(sides, sides)], axis=1)])
    sides_of = [np.stack([i, after, after + sides], axis=1), np.stack([i, after + sides, i + sides], axis=1)]
    return np.concatenate([low, end + radii_mm[1] * ring]), np.concatenate([fan[:, ::-1], fan + sides, *sides_of])


def revolved(profile: np.ndarray, sides: int) -> Shape:
    """A profile of (r, z) turned about z, from the lower end on the axis outside up to the other end on the axis."""
    angle = 2 * np.pi * np.arange(sides) / sides
    ring = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    inner = profile[1:-1]
    points = np.concatenate([np.concatenate([r * ring, np.full((sides, 1), z)], axis=1) for r, z in inner]
                            + [[(0, 0, profile[0, 1]), (0, 0, profile[-1, 1])]])
    i, after = np.arange(sides), (np.arange(sides) + 1) % sides
    first, last, top = len(points) - 2, len(points) - 1, (len(inner) - 1) * sides
    triangles = [np.stack([after, i, np.full(sides, first)], axis=1),
                 np.stack([i + top, after + top, np.full(sides, last)], axis=1)]
    for k in range(len(inner) - 1):
        a, b = k * sides, (k + 1) * sides
        triangles += [np.stack([i + a, after + a, after + b], axis=1), np.stack([i + a, after + b, i + b], axis=1)]
    return points, np.concatenate(triangles)


def torus(big_mm: float, small_mm: float, around: int, along: int) -> Shape:
    u = 2 * np.pi * np.arange(around) / around
    v = 2 * np.pi * np.arange(along) / along
    r = big_mm + small_mm * np.cos(v)[None]
    height = np.broadcast_to(small_mm * np.sin(v), (around, along))
    points = np.stack([r * np.cos(u)[:, None], r * np.sin(u)[:, None], height], axis=2)
    return points.reshape(-1, 3), grid_triangles(around, along, True, True)


def sleeve(middle: tuple[float, float], radii: tuple[float, float], z: tuple[float, float], sides: int) -> Shape:
    """An upright tube that is open at both ends."""
    angle = 2 * np.pi * np.arange(sides) / sides
    (inner, outer), (low, high) = radii, z
    rows = [np.stack([middle[0] + r * np.cos(angle), middle[1] + r * np.sin(angle), np.full(sides, end)], axis=1)
            for r, end in ((outer, low), (outer, high), (inner, high), (inner, low))]
    return np.stack(rows, axis=1).reshape(-1, 3), grid_triangles(sides, 4, True, True)


def grid_triangles(rows: int, columns: int, rows_close: bool = False, columns_close: bool = False) -> np.ndarray:
    """Triangles of a grid of points, row by row; the last row or column may be joined to the first."""
    i = np.arange(rows if rows_close else rows - 1)[:, None]
    j = np.arange(columns if columns_close else columns - 1)[None]
    right, up = (i + 1) % rows, (j + 1) % columns
    a, b, c, d = (i * columns + j, right * columns + j, right * columns + up, i * columns + up)
    return np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])


def shell_of_patch(outer: np.ndarray, inner: np.ndarray) -> Shape:
    """A closed shell between two grids of points (rows x columns x 3); `outer` is counter-clockwise from outside."""
    rows, columns = outer.shape[:2]
    count = rows * columns
    number = np.arange(count).reshape(rows, columns)
    face = grid_triangles(rows, columns)
    rim = np.concatenate([number[:-1, 0], number[-1, :-1], number[:0:-1, -1], number[0, :0:-1]])
    after = np.roll(rim, -1)
    walls = [np.stack([after, rim, rim + count], axis=1), np.stack([after, rim + count, after + count], axis=1)]
    points = np.concatenate([outer.reshape(-1, 3), inner.reshape(-1, 3)])
    return points, np.concatenate([face, face[:, ::-1] + count, *walls])


# Bodies of filled cells

def cell_faces(filled: np.ndarray) -> list[tuple[int, int, np.ndarray]]:
    """The faces between filled and empty cells, for each axis and side (0: low, 1: high): rows of cell indices."""
    padded = np.pad(filled, 1)
    out = []
    for axis in range(3):
        for side, shift in ((0, 1), (1, -1)):
            bare = padded & ~np.roll(padded, shift, axis)
            out.append((axis, side, np.argwhere(bare) - 1))
    return out


def cell_corners(axes: list[np.ndarray], axis: int, side: int, cell: np.ndarray) -> np.ndarray:
    """The four corners of one face of a cell, counter-clockwise seen from outside."""
    others = [(axis + 1) % 3, (axis + 2) % 3]
    out = np.empty((4, 3))
    out[:, axis] = axes[axis][cell[axis] + side]
    for k, other in enumerate(others):
        out[:, other] = axes[other][cell[other] + CORNERS[:, k]]
    return out if side else out[::-1]


def blocks(axes: list[np.ndarray], filled: np.ndarray) -> Shape:
    """The surface of filled cells between the coordinates of three axes, as one welded mesh."""
    quads = [cell_corners(axes, axis, side, cell) for axis, side, cells in cell_faces(filled) for cell in cells]
    return weld(np.concatenate([quad[[[0, 1, 2], [0, 2, 3]]] for quad in quads]))


def weld(soup: np.ndarray) -> Shape:
    """Joins equal corners (to 1e-6 mm) of triangles (n x 3 x 3)."""
    corners = soup.reshape(-1, 3)
    _, first, number = np.unique(np.round(corners, 6), axis=0, return_index=True, return_inverse=True)
    return corners[first], number.reshape(-1, 3)


# Surfaces of scalar fields

def surface_net(values: np.ndarray, pitch_mm: float) -> Shape:
    """The surface where values on a grid change from negative (inside) to positive, by surface nets: one point per cell
    with a change, at the mean of the crossings of its edges. The values at the outermost points must be positive."""
    inside = values < 0
    total = np.zeros(tuple(n - 1 for n in values.shape) + (3,))
    count = np.zeros(total.shape[:3], int)
    quads = []
    for axis in range(3):
        add_crossings(values, inside, axis, total, count)
    number = np.cumsum(count.reshape(-1) > 0).reshape(count.shape) - 1
    used = count > 0
    points = (total[used] / count[used][:, None]) * pitch_mm
    for axis in range(3):
        quads += quads_across(inside, axis, number)
    quad = np.concatenate(quads)
    return points, np.concatenate([quad[:, [0, 1, 2]], quad[:, [0, 2, 3]]])


def along(array: np.ndarray, axis: int, start: int, stop: int | None) -> np.ndarray:
    index = [slice(None)] * array.ndim
    index[axis] = slice(start, stop)
    return array[tuple(index)]


def add_crossings(values: np.ndarray, inside: np.ndarray, axis: int, total: np.ndarray, count: np.ndarray) -> None:
    """Adds the places of the sign changes on the edges along an axis to the four cells around each."""
    change = along(inside, axis, 0, -1) != along(inside, axis, 1, None)
    place = np.argwhere(change)
    low, high = along(values, axis, 0, -1)[change], along(values, axis, 1, None)[change]
    where = place.astype(float)
    where[:, axis] += low / (low - high)
    for u, v in CORNERS:
        cell = place.copy()
        cell[:, (axis + 1) % 3] -= u
        cell[:, (axis + 2) % 3] -= v
        np.add.at(total, tuple(cell.T), where)
        np.add.at(count, tuple(cell.T), 1)


def quads_across(inside: np.ndarray, axis: int, number: np.ndarray) -> list[np.ndarray]:
    """The quadrilaterals between the points of the four cells around each edge with a change."""
    out = []
    for from_inside in (True, False):
        change = along(inside, axis, 0, -1) != along(inside, axis, 1, None)
        change &= along(inside, axis, 0, -1) == from_inside
        place = np.argwhere(change)
        corners = []
        for u, v in CORNERS - 1:
            cell = place.copy()
            cell[:, (axis + 1) % 3] += u
            cell[:, (axis + 2) % 3] += v
            corners.append(number[tuple(cell.T)])
        quad = np.stack(corners, axis=1)
        out.append(quad if from_inside else quad[:, ::-1])
    return out


# Checks

def volume_mm3(shape: Shape) -> float:
    a, b, c = (shape[0][shape[1][:, i]] for i in range(3))
    return float((a * np.cross(b, c)).sum() / 6)


def unpaired_edges(shape: Shape) -> int:
    """Number of edges that are not used as often in one direction as in the other."""
    triangles = shape[1]
    directed = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    sign = np.where(directed[:, 0] < directed[:, 1], 1, -1)
    _, number = np.unique(np.sort(directed, axis=1), axis=0, return_inverse=True)
    return int((np.bincount(number.reshape(-1), sign) != 0).sum())
