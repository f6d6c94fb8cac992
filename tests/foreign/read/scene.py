"""Coloured triangles: where rays and points meet them, and the colour that is shown there."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import light


@dataclass(frozen=True)
class Texture:
    image: np.ndarray  # rows x columns x channels, 0 to 255
    wraps: tuple[str, str]  # along u and v: repeat, clamp, mirror
    nearest: bool  # do not blend texels


@dataclass(frozen=True)
class Material:
    factor: np.ndarray  # linear red, green, blue
    texture: Texture | None
    texcoord: int = 0  # which set of texture coordinates


@dataclass(frozen=True)
class Scene:
    """Values of the three corners of each triangle."""
    corners: np.ndarray  # triangles x 3 x 3, mm
    uv: np.ndarray  # triangles x 3 x 2; NaN without a texture
    colour: np.ndarray  # triangles x 3 x 3, linear light
    material: np.ndarray  # number of each triangle's material
    materials: list[Material]

    @property
    def box(self) -> tuple[np.ndarray, np.ndarray]:
        """Smallest and largest coordinates, mm."""
        return self.corners.min(axis=(0, 1)), self.corners.max(axis=(0, 1))

    @property
    def diagonal_mm(self) -> float:
        low, high = self.box
        return float(np.linalg.norm(high - low))


@dataclass(frozen=True)
class Places:
    """Points on a scene: a triangle (-1: no such point) and the weights of its corners."""
    triangle: np.ndarray
    weights: np.ndarray

    def points(self, scene: Scene) -> np.ndarray:
        return np.einsum("nc,ncx->nx", self.weights, scene.corners[self.triangle])


def concatenated(parts: list[Scene], materials: list[Material]) -> Scene:
    columns = (np.concatenate([getattr(part, name) for part in parts]) for name in ("corners", "uv", "colour", "material"))
    return Scene(*columns, materials)


def shown(scene: Scene, places: Places) -> np.ndarray:
    """sRGB (0 to 255) of each place: the product of factor, texture and vertex colour in linear light. NaN for no place."""
    out = np.einsum("nc,ncx->nx", places.weights, scene.colour[places.triangle])
    uv = np.einsum("nc,ncx->nx", places.weights, scene.uv[places.triangle])
    used = scene.material[places.triangle]
    for number in np.unique(used):
        rows, material = used == number, scene.materials[number]
        out[rows] *= material.factor
        if material.texture is not None:
            texture = material.texture
            out[rows] *= light.sampled(texture.image, texture.wraps, texture.nearest, uv[rows])
    return np.where(places.triangle[:, None] >= 0, light.levels(out), np.nan)


def random_places(scene: Scene, count: int, random: np.random.Generator) -> Places:
    """Evenly distributed over the area."""
    a, b, c = scene.corners.transpose(1, 0, 2)
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    triangle = random.choice(len(area), count, p=area / area.sum())
    return Places(triangle, random.dirichlet((1, 1, 1), count))


def lowest_hits(scene: Scene, xy: np.ndarray) -> Places:
    """Where rays from far below, upwards through each (x, y), first meet the scene (Moeller and Trumbore 1997)."""
    a, b, c = scene.corners.transpose(1, 0, 2)
    ab, ac, up = b - a, c - a, np.array([0.0, 0.0, 1.0])
    across = np.cross(up, ac)
    determinant = np.einsum("ij,ij->i", ab, across)
    triangle, weights = np.full(len(xy), -1), np.zeros((len(xy), 3))
    with np.errstate(divide="ignore", invalid="ignore"):  # upright triangles are not met
        for n, (x, y) in enumerate(xy):
            start = np.array([x, y, scene.box[0][2] - 1]) - a
            over = np.cross(start, ab)
            v = np.einsum("ij,ij->i", start, across) / determinant
            w = over[:, 2] / determinant
            height = np.einsum("ij,ij->i", ac, over) / determinant
            height = np.where((v >= -1e-9) & (w >= -1e-9) & (v + w <= 1 + 1e-9), height, np.inf)
            first = int(np.argmin(np.where(np.isnan(height), np.inf, height)))
            if np.isfinite(height[first]):
                triangle[n], weights[n] = first, (1 - v[first] - w[first], v[first], w[first])
    return Places(triangle, weights)


def nearest(scene: Scene, points: np.ndarray, reach_mm: float) -> tuple[Places, np.ndarray]:
    """The nearest place to each point, and its distance in mm; infinite if it is further away than reach_mm."""
    middle = scene.corners.mean(axis=1)
    radius = np.linalg.norm(scene.corners - middle[:, None], axis=2).max(axis=1)
    order = np.argsort(middle[:, 0])
    sorted_x, most = middle[order, 0], reach_mm + radius.max()
    triangle, weights, distance = np.full(len(points), -1), np.zeros((len(points), 3)), np.full(len(points), np.inf)
    for n, point in enumerate(points):
        near = order[np.searchsorted(sorted_x, point[0] - most):np.searchsorted(sorted_x, point[0] + most, "right")]
        near = near[np.abs(middle[near, 1] - point[1]) <= most]
        near = near[np.linalg.norm(middle[near] - point, axis=1) <= reach_mm + radius[near]]
        if len(near) == 0:
            continue
        found = closest_weights(scene.corners[near], point)
        apart = np.linalg.norm(np.einsum("nc,ncx->nx", found, scene.corners[near]) - point, axis=1)
        best = int(np.argmin(apart))
        if apart[best] <= reach_mm:
            triangle[n], weights[n], distance[n] = near[best], found[best], apart[best]
    return Places(triangle, weights), distance


def closest_weights(corners: np.ndarray, point: np.ndarray) -> np.ndarray:
    """Weights of the corners at each triangle's closest point: within the triangle, or on its closest edge."""
    candidates = []
    for i, j in ((0, 1), (1, 2), (2, 0)):
        start, edge = corners[:, i], corners[:, j] - corners[:, i]
        length = np.einsum("ij,ij->i", edge, edge)
        part = np.clip(np.einsum("ij,ij->i", point - start, edge) / np.where(length > 0, length, 1), 0, 1)
        weights = np.zeros((len(corners), 3))
        weights[:, i], weights[:, j] = 1 - part, part
        candidates.append(weights)
    ab, ac, ap = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0], point - corners[:, 0]
    normal = np.cross(ab, ac)
    area = np.einsum("ij,ij->i", normal, normal)
    area = np.where(area > 0, area, np.inf)
    v, w = (np.einsum("ij,ij->i", np.cross(p, q), normal) / area for p, q in ((ap, ac), (ab, ap)))
    within = np.stack([1 - v - w, v, w], axis=1)
    inside = (within >= 0).all(axis=1) & np.isfinite(area)
    candidates.append(np.where(inside[:, None], within, candidates[0]))
    apart = [np.linalg.norm(np.einsum("nc,ncx->nx", each, corners) - point, axis=1) for each in candidates]
    return np.stack(candidates)[np.argmin(apart, axis=0), np.arange(len(corners))]
