"""Reads and writes PLY files."""
from __future__ import annotations

import pathlib
from dataclasses import dataclass

import numpy as np

TYPES = {"char": "i1", "uchar": "u1", "short": "<i2", "ushort": "<u2", "int": "<i4", "uint": "<u4", "float": "<f4",
         "double": "<f8", "int8": "i1", "uint8": "u1", "int16": "<i2", "uint16": "<u2", "int32": "<i4",
         "uint32": "<u4", "float32": "<f4", "float64": "<f8"}


@dataclass
class Mesh:
    """Vertices as a structured array (x, y, z and others), triangles as rows of three indices."""
    vertices: np.ndarray
    triangles: np.ndarray

    @property
    def points_mm(self) -> np.ndarray:
        return np.stack([self.vertices[axis] for axis in "xyz"], axis=1).astype(float)


def read(path: pathlib.Path) -> Mesh:
    """Reads a binary, little-endian file with vertices and triangles."""
    data = path.read_bytes()
    end = data.index(b"end_header\n") + len(b"end_header\n")
    lines = data[:end].decode("ascii").splitlines()
    if lines[0] != "ply" or "format binary_little_endian 1.0" not in lines:
        raise ValueError(f"{path}: not a binary little-endian PLY file")
    counts: dict[str, int] = {}
    fields: dict[str, list[tuple[str, str]]] = {}
    for words in (line.split() for line in lines):
        if words[0] == "element":
            counts[words[1]] = int(words[2])
            fields[words[1]] = []
        elif words[0] == "property":
            fields[list(counts)[-1]].append((words[-1], " ".join(words[1:-1])))
    if list(counts) != ["vertex", "face"]:
        raise ValueError(f"{path}: the elements are {list(counts)}, not vertex and face")
    vertex = np.dtype([(name, TYPES[kind]) for name, kind in fields["vertex"]])
    vertices = np.frombuffer(data, vertex, counts["vertex"], end)
    (_, kind), *others = fields["face"]
    _, length, index = kind.split()
    face = np.dtype([("n", TYPES[length]), ("index", TYPES[index], 3)] + [(name, TYPES[kind]) for name, kind in others])
    start = end + vertex.itemsize * counts["vertex"]
    faces = np.frombuffer(data, face, counts["face"], start)
    if start + face.itemsize * counts["face"] != len(data) or np.any(faces["n"] != 3):
        raise ValueError(f"{path}: the file's size does not fit triangles")
    return Mesh(vertices, faces["index"].astype(np.int64))


def write_coloured(path: pathlib.Path, points: np.ndarray, triangles: np.ndarray, rgb: tuple[int, int, int]) -> None:
    """Writes a mesh whose vertices all have one colour, as text."""
    rows = [f"{x!r} {y!r} {z!r} {rgb[0]} {rgb[1]} {rgb[2]}" for x, y, z in points.tolist()]
    faces = [f"3 {a} {b} {c}" for a, b, c in triangles.tolist()]
    head = ["ply", "format ascii 1.0", f"element vertex {len(rows)}"]
    head += [f"property double {axis}" for axis in "xyz"]
    head += [f"property uchar {channel}" for channel in ("red", "green", "blue")]
    head += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    path.write_text("\n".join(head + rows + faces) + "\n", encoding="ascii")
