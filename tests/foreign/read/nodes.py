"""The nodes of a glTF scene: which mesh is where."""
from __future__ import annotations

import numpy as np


def placed(document: dict, scene: dict) -> list[tuple[np.ndarray, int]]:
    """The meshes of a scene, each with the 4 x 4 matrix that takes its coordinates to those of the scene."""
    out: list[tuple[np.ndarray, int]] = []
    seen: set[int] = set()

    def visit(number: int, parent: np.ndarray) -> None:
        if number < 0 or number in seen:
            raise ValueError(f"node {number} is negative, or has two parents")
        seen.add(number)
        node = document["nodes"][number]
        matrix = parent @ local(node)
        if "mesh" in node:
            if node["mesh"] < 0:
                raise ValueError("a negative index")
            out.append((matrix, node["mesh"]))
        for child in node.get("children", []):
            visit(child, matrix)

    for root in scene["nodes"]:
        visit(root, np.eye(4))
    return out


def local(node: dict) -> np.ndarray:
    """The matrix of a node alone."""
    if "matrix" in node:
        matrix = np.array(node["matrix"], float).reshape(4, 4).T
    else:
        matrix = np.eye(4)
        matrix[:3, :3] = rotation(node.get("rotation", [0, 0, 0, 1])) * np.array(node.get("scale", [1, 1, 1]), float)
        matrix[:3, 3] = node.get("translation", [0, 0, 0])
    if not np.isfinite(matrix).all() or (matrix[3] != [0, 0, 0, 1]).any():
        raise ValueError("a node's matrix is not affine")
    return matrix


def rotation(xyzw: list[float]) -> np.ndarray:
    x, y, z, w = np.array(xyzw, float)
    if abs(x * x + y * y + z * z + w * w - 1) > 1e-3:
        raise ValueError("a node's rotation is not a unit quaternion")
    return np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
