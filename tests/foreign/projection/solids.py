"""Test objects: points in mm, triangles counter-clockwise seen from outside; their files; and rotations."""
from __future__ import annotations

import pathlib
from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Solid:
    """Points in mm (frame O) and triangles, as rows of three indices. No two points are at the same place."""
    points: np.ndarray
    triangles: np.ndarray

    @property
    def normals(self) -> np.ndarray:
        """Normals of the triangles, of length 1."""
        return normals_of(self.points, self.triangles)


def normals_of(points: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    """Normals of triangles, of length 1; NaN for triangles without area."""
    a, b, c = (points[triangles[:, i]] for i in range(3))
    cross = np.cross(b - a, c - a)
    with np.errstate(invalid="ignore", divide="ignore"):
        return cross / np.linalg.norm(cross, axis=1)[:, None]


# Icosphere

def icosphere(radius_mm: float, subdivisions: int) -> Solid:
    """A subdivided icosahedron, turned so that it has no symmetry with the coordinate axes."""
    golden = (1 + 5 ** 0.5) / 2
    signs = [(a, b) for a in (-1.0, 1.0) for b in (-golden, golden)]
    corners = np.array([np.roll((0.0, a, b), shift) for shift in range(3) for a, b in signs])
    points = corners / np.linalg.norm(corners[0])
    triangles = hull_triangles(points)
    for _ in range(subdivisions):
        points, triangles = divided(points, triangles)
    return Solid(rounded(radius_mm * points @ rotation(turn((1.0, 0.7, -0.4), 23.0)).T), triangles)


def hull_triangles(points: np.ndarray) -> np.ndarray:
    """The triangles of nearest neighbours of the icosahedron's twelve corners, facing outwards."""
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    near = (apart > 0) & (apart < 1.2)
    out = []
    for a in range(12):
        for b in range(a + 1, 12):
            for c in range(b + 1, 12):
                if near[a, b] and near[b, c] and near[a, c]:
                    outwards = np.linalg.det(points[[a, b, c]]) > 0
                    out.append((a, b, c) if outwards else (a, c, b))
    return np.array(out)


def divided(points: np.ndarray, triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Splits each triangle into four, with the new points on the unit sphere."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    middles = points[unique].sum(axis=1)
    middles /= np.linalg.norm(middles, axis=1)[:, None]
    ab, bc, ca = (number.reshape(-1) + len(points)).reshape(3, -1)
    a, b, c = triangles.T
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([points, middles]), np.concatenate([np.stack(part, axis=1) for part in parts])


# Bracket

LENGTH_MM, WIDTH_MM, HEIGHT_MM, THICKNESS_MM = 60.0, 40.0, 40.0, 8.0
HOLE_CORNERS = 24  # the normals of the holes' walls are then never at 45 degrees to the axes
BASE_HOLES = ((23.0, 21.0, 6.0), (46.0, 18.0, 5.0))  # x, y, radius
WALL_HOLES = ((19.0, 26.0, 5.0),)  # y, z, radius


def bracket() -> Solid:
    """An L-bracket: base and wall, with two holes through the base and one through the wall."""
    soup: list[np.ndarray] = []
    t = THICKNESS_MM
    base_outer = rectangle(0, 0, LENGTH_MM, WIDTH_MM)
    base_inner = rectangle(t, 0, LENGTH_MM, WIDTH_MM)
    soup.append(place(face(base_outer, BASE_HOLES), lambda x, y: (x, y, 0 * x), facing=(0, 0, -1)))
    soup.append(place(face(base_inner, BASE_HOLES), lambda x, y: (x, y, 0 * x + t), facing=(0, 0, 1)))
    wall_outer = rectangle(0, 0, WIDTH_MM, HEIGHT_MM)
    wall_inner = rectangle(0, t, WIDTH_MM, HEIGHT_MM)
    soup.append(place(face(wall_outer, WALL_HOLES), lambda y, z: (0 * y, y, z), facing=(-1, 0, 0)))
    soup.append(place(face(wall_inner, WALL_HOLES), lambda y, z: (0 * y + t, y, z), facing=(1, 0, 0)))
    profile = np.array([(0, 0), (LENGTH_MM, 0), (LENGTH_MM, t), (t, t), (t, HEIGHT_MM), (0, HEIGHT_MM)])
    soup.append(place(ears(profile), lambda x, z: (x, 0 * x, z), facing=(0, -1, 0)))
    soup.append(place(ears(profile), lambda x, z: (x, 0 * x + WIDTH_MM, z), facing=(0, 1, 0)))
    end = face(rectangle(0, 0, WIDTH_MM, t), ())
    soup.append(place(end, lambda y, z: (0 * y + LENGTH_MM, y, z), facing=(1, 0, 0)))
    top = face(rectangle(0, 0, t, WIDTH_MM), ())
    soup.append(place(top, lambda x, y: (x, y, 0 * x + HEIGHT_MM), facing=(0, 0, 1)))
    soup += [tube(hole, lambda x, y, w: (x, y, w)) for hole in BASE_HOLES]
    soup += [tube(hole, lambda y, z, w: (w, y, z)) for hole in WALL_HOLES]
    return weld(np.concatenate(soup))


def rectangle(x0: float, y0: float, x1: float, y1: float) -> np.ndarray:
    return np.array([(x0, y0), (x1, y0), (x1, y1), (x0, y1)])


def circle(x: float, y: float, radius: float) -> np.ndarray:
    angle = 2 * np.pi * np.arange(HOLE_CORNERS) / HOLE_CORNERS
    return np.stack([x + radius * np.cos(angle), y + radius * np.sin(angle)], axis=1)


def face(outline: np.ndarray, holes: tuple[tuple[float, float, float], ...]) -> np.ndarray:
    """Triangles (n x 3 x 2) of a polygon with round holes: each hole is joined to the outline by a slit."""
    for x, y, radius in sorted(holes):
        hole = circle(x, y, radius)[::-1]
        apart = np.linalg.norm(outline[:, None] - hole[None], axis=2)
        i, j = np.unravel_index(np.argmin(apart), apart.shape)
        outline = np.concatenate([outline[:i + 1], np.roll(hole, -j, axis=0), hole[j:j + 1], outline[i:]])
    return ears(outline)


def ears(polygon: np.ndarray) -> np.ndarray:
    """Triangulates a counter-clockwise polygon: cuts off corners that contain no other corner. Of these, it takes the
    corner with the shortest cut."""
    left = list(range(len(polygon)))
    out = []
    while len(left) > 3:
        found = [(cut, k) for k in range(len(left)) if (cut := ear_cut(polygon, left, k)) is not None]
        _, k = min(found)
        out.append((left[k - 1], left[k], left[(k + 1) % len(left)]))
        del left[k]
    out.append(tuple(left))
    return polygon[np.array(out)]


def ear_cut(polygon: np.ndarray, left: list[int], k: int) -> float | None:
    """Length of the cut behind corner k; None if it cannot be cut off."""
    a, b, c = (polygon[left[i % len(left)]] for i in (k - 1, k, k + 1))
    if cross2(b - a, c - b) <= 1e-9:
        return None
    others = polygon[left]
    same = [np.abs(others - corner).max(axis=1) < 1e-9 for corner in (a, b, c)]
    inside = [cross2(end - start, others - start) > -1e-9 for start, end in ((a, b), (b, c), (c, a))]
    return None if (np.all(inside, axis=0) & ~np.any(same, axis=0)).any() else float(np.linalg.norm(c - a))


def cross2(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    return a[..., 0] * b[..., 1] - a[..., 1] * b[..., 0]


def place(flat: np.ndarray, to_space, facing: tuple[float, float, float]) -> np.ndarray:
    """Triangles in space (n x 3 x 3), turned over where they do not face in the direction."""
    out = np.stack(to_space(flat[:, :, 0], flat[:, :, 1]), axis=2)
    wrong = np.cross(out[:, 1] - out[:, 0], out[:, 2] - out[:, 0]) @ np.array(facing) < 0
    out[wrong] = out[wrong][:, ::-1]
    return out


def tube(hole: tuple[float, float, float], to_space) -> np.ndarray:
    """The wall of a hole between 0 and the thickness, facing its axis."""
    rim = circle(*hole)
    middle = np.stack(to_space(hole[0], hole[1], THICKNESS_MM / 2))
    low, high = (np.stack(to_space(rim[:, 0], rim[:, 1], np.full(len(rim), w)), axis=1) for w in (0.0, THICKNESS_MM))
    low_next, high_next = np.roll(low, -1, axis=0), np.roll(high, -1, axis=0)
    halves = (low, low_next, high_next), (low, high_next, high)
    out = np.concatenate([np.stack(half, axis=1) for half in halves])
    normals = np.cross(out[:, 1] - out[:, 0], out[:, 2] - out[:, 0])
    outwards = ((middle - out.mean(axis=1)) * normals).sum(axis=1) < 0
    out[outwards] = out[outwards][:, ::-1]
    return out


def weld(soup: np.ndarray) -> Solid:
    """Joins corners at the same place (to 1e-5 mm)."""
    corners = rounded(soup.reshape(-1, 3))
    _, first, number = np.unique(np.round(corners, 5), axis=0, return_index=True, return_inverse=True)
    return Solid(corners[first], number.reshape(-1, 3))


def rounded(points: np.ndarray) -> np.ndarray:
    """The points as an STL file contains them."""
    return points.astype(np.float32).astype(float)


def open_edges(solid: Solid) -> int:
    """Number of edges without exactly one neighbour in the other direction."""
    directed = np.concatenate([solid.triangles[:, [0, 1]], solid.triangles[:, [1, 2]], solid.triangles[:, [2, 0]]])
    edges = [tuple(edge) for edge in directed.tolist()]
    known = set(edges)
    return len(edges) - len(known) + sum((b, a) not in known for a, b in known)


# Files

def read_cat(path: pathlib.Path, unit_mm: float) -> Solid:
    """Reads an OBJ file of triangles with y up. The solid has z up, and the former z at its front (-y)."""
    points, triangles = [], []
    for words in (line.split() for line in path.read_text(encoding="ascii").splitlines()):
        if words[:1] == ["v"]:
            x, y, z = (unit_mm * float(word) for word in words[1:4])
            points.append((x, -z, y))
        elif words[:1] == ["f"]:
            triangles.append([int(word.split("/")[0]) - 1 for word in words[1:]])
    return weld(np.array(points)[np.array(triangles)])


def write_stl(path: pathlib.Path, solid: Solid, binary: bool = True) -> None:
    corners = solid.points[solid.triangles].astype("<f4")
    normals = solid.normals.astype("<f4")
    if binary:
        rows = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
        rows["normal"], rows["corners"] = normals, corners
        path.write_bytes(b"binary".ljust(80) + np.array(len(rows), "<u4").tobytes() + rows.tobytes())
        return
    lines = ["solid shape"]
    for normal, triangle in zip(normals.tolist(), corners.tolist()):
        lines += ["facet normal " + words(normal), "outer loop", *("vertex " + words(corner) for corner in triangle),
                  "endloop", "endfacet"]
    path.write_text("\n".join([*lines, "endsolid shape"]) + "\n", encoding="ascii")


def words(numbers: list[float]) -> str:
    return " ".join(f"{number:.9g}" for number in numbers)


# Rotations

def turn(axis: tuple[float, float, float], degrees: float) -> np.ndarray:
    """Quaternion w, x, y, z of a turn about an axis."""
    half = np.radians(degrees) / 2
    return np.array([np.cos(half), *(np.sin(half) * np.array(axis) / np.linalg.norm(axis))])


def after(first: np.ndarray, second: np.ndarray) -> np.ndarray:
    """Quaternion of one turn after another."""
    w, v, x, y = second[0], second[1:], first[0], first[1:]
    return np.array([w * x - v @ y, *(w * y + x * v + np.cross(v, y))])


def rotation(q: np.ndarray) -> np.ndarray:
    """The matrix of a unit quaternion."""
    w, v = q[0], q[1:]
    across = np.array([(0, -v[2], v[1]), (v[2], 0, -v[0]), (-v[1], v[0], 0)])
    return np.eye(3) + 2 * w * across + 2 * across @ across
