"""Prints made from the judge's own formulas, for its self-test: a map from the film to a ball, and film images."""
from __future__ import annotations

import numpy as np

import definition
from definition import Paint, Sites
from landing import Film, Landing, landing
from raster import Raster
from solids import Solid


def film_radius_mm(radius_mm: float, film_mm: float, theta_rad: np.ndarray) -> np.ndarray:
    """Where the film lands at an angle from the lowest point of a ball in the middle of a round film (field notes,
    section 2)."""
    k = np.sqrt((film_mm / radius_mm) ** 2 - 1)
    return film_mm * np.sqrt(-np.expm1(-2 / k * (np.arctan(1 / k) - np.arctan(np.cos(theta_rad) / k))))


def ball_landing(solid: Solid, fine: Solid, film: Film, rotation: np.ndarray) -> Landing:
    """The map of a ball's mesh: points of `fine`, a finer mesh of the same ball, on the triangles of the mesh."""
    points = onto(solid, fine.points)
    down = fine.points @ rotation.T
    radius = float(np.linalg.norm(fine.points[0]))
    theta = np.arccos(np.clip(-down[:, 2] / radius, -1, 1))
    r0 = film_radius_mm(radius, film.width_mm / 2, theta)
    around = down[:, :2] / np.maximum(np.hypot(down[:, 0], down[:, 1]), 1e-9)[:, None]
    places = np.where((theta < np.radians(150))[:, None], r0[:, None] * around, np.nan)
    return landing(points, places, theta, np.ones(len(points)), fine.triangles)


def onto(solid: Solid, points: np.ndarray) -> np.ndarray:
    """Moves points along their rays from the origin to the triangles that they meet."""
    a, b, c = (solid.points[solid.triangles[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    # The triangles of a convex solid around the origin: of their planes, a ray meets its own first.
    towards = (points / np.linalg.norm(points, axis=1)[:, None]) @ normal.T
    distance = np.where(towards > 0, (normal * a).sum(axis=1) / np.where(towards > 0, towards, 1), np.inf)
    return points * (distance.min(axis=1) / np.linalg.norm(points, axis=1))[:, None]


def film_image(raster: Raster, film: Film, dpi: float, paint: Paint, solid: Solid,
               rotation: np.ndarray) -> np.ndarray:
    """The film image of a paint, white elsewhere."""
    rows, columns = film.size_px(dpi)
    image = np.full((rows * columns, 3), 255, np.uint8)
    sites = Sites.on_triangles(raster.points, raster.normals)
    image[raster.pixels] = np.round(definition.colours(paint, solid, rotation, sites))
    return image.reshape(rows, columns, 3)
