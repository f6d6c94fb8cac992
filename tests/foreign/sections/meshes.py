"""Reads and writes meshes, joins equal points, and finds shells. STL: 80 bytes, a count, and 50 bytes per triangle."""
from __future__ import annotations

import pathlib

import numpy as np

from solids import Shape

import ply

STL = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
PLY_FACE = np.dtype([("n", "u1"), ("index", "<i4", 3)])


def write(path: pathlib.Path, shape: Shape) -> None:
    """Writes a binary STL file, or a binary PLY file with coordinates of double precision."""
    writers = {".stl": write_stl, ".ply": write_ply}
    if path.suffix not in writers:
        raise ValueError(f"{path}: the name must end in .stl or .ply")
    writers[path.suffix](path, shape)


def write_stl(path: pathlib.Path, shape: Shape) -> None:
    rows = np.zeros(len(shape[1]), STL)
    rows["corners"] = shape[0][shape[1]]
    a, b, c = (rows["corners"][:, i].astype(float) for i in range(3))
    cross = np.cross(b - a, c - a)
    length = np.linalg.norm(cross, axis=1)[:, None]
    rows["normal"] = np.divide(cross, length, out=np.zeros_like(cross), where=length > 0)
    path.write_bytes(b"binary".ljust(80) + np.array(len(rows), "<u4").tobytes() + rows.tobytes())


def write_ply(path: pathlib.Path, shape: Shape) -> None:
    points, triangles = shape
    head = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}",
            *(f"property double {axis}" for axis in "xyz"), f"element face {len(triangles)}",
            "property list uchar int vertex_indices", "end_header"]
    faces = np.zeros(len(triangles), PLY_FACE)
    faces["n"], faces["index"] = 3, triangles
    body = points.astype("<f8").tobytes() + faces.tobytes()
    path.write_bytes(("\n".join(head) + "\n").encode("ascii") + body)


def read(path: pathlib.Path) -> Shape:
    """Reads a file of write(); equal points are joined."""
    if path.suffix == ".ply":
        mesh = ply.read(path)
        return welded(mesh.points_mm[mesh.triangles])
    data = path.read_bytes()
    count = int(np.frombuffer(data, "<u4", 1, 80)[0])
    if len(data) != 84 + count * STL.itemsize:
        raise ValueError(f"{path}: {len(data)} bytes do not fit {count} triangles")
    return welded(np.frombuffer(data, STL, count, 84)["corners"].astype(float))


def welded(corners: np.ndarray) -> Shape:
    """Joins corners (triangles x 3 x 3) whose coordinates are equal."""
    flat = np.ascontiguousarray(corners.reshape(-1, 3)) + 0.0  # turns -0 into 0
    keys = flat.view([("x", float), ("y", float), ("z", float)]).reshape(-1)
    _, first, number = np.unique(keys, return_index=True, return_inverse=True)
    return flat[first], number.reshape(-1, 3)


def without_doubles(shape: Shape) -> Shape:
    """Keeps one of several triangles with the same three points, whichever way round, and drops those with less than
    three points."""
    corners = np.sort(shape[1], axis=1)
    real = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])
    _, first = np.unique(corners[real], axis=0, return_index=True)
    return shape[0], shape[1][real][np.sort(first)]


def shells(shape: Shape) -> np.ndarray:
    """The number of the shell of each triangle: shells share no point."""
    label = np.arange(len(shape[0]))
    triangles = shape[1]
    while True:
        least = label[triangles].min(axis=1)
        before = label.copy()
        for i in range(3):
            np.minimum.at(label, triangles[:, i], least)
        label = label[label]
        if (label == before).all():
            return np.unique(label[triangles[:, 0]], return_inverse=True)[1].reshape(-1)


def prepared(shape: Shape) -> tuple[Shape, np.ndarray]:
    """The mesh without doubled triangles, and the shell of each triangle."""
    single = without_doubles(shape)
    return single, shells(single)
