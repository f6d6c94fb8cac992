"""Claims about plans of known objects: functions of what was measured, without files or programs."""
from __future__ import annotations

from dataclasses import dataclass

import numpy as np

import closed_form
from ply import Mesh


@dataclass(frozen=True)
class Claim:
    what: str
    measured: float
    limit: float  # the largest value at which the claim holds

    @property
    def holds(self) -> bool:
        return bool(self.measured <= self.limit)  # False for NaN


@dataclass(frozen=True)
class Limits:
    """The largest errors of a sphere's plan."""
    seam_mm: float = 0.06
    seam_share: float = 1  # share of the seam's points that must be within seam_mm
    weight: float = 0.02
    mean_stretch: float = 0.005
    level: int = 3
    pixels_off: float = 0.01  # share of the pixels that may be further off than `level`


def columns(plan: Mesh, name: str) -> np.ndarray:
    """Columns name_1 ... name_K as points x dips."""
    count = sum(field.removeprefix(name + "_").isdigit() for field in plan.vertices.dtype.names)
    return np.stack([plan.vertices[f"{name}_{k + 1}"] for k in range(count)], axis=1).astype(float)


def worst(values: np.ndarray, share: float = 1) -> float:
    """The largest value, or the quantile; NaN, with which no claim holds, if there is none."""
    return float(np.quantile(values, share)) if values.size else float("nan")


def mean(values: np.ndarray, areas_mm2: np.ndarray) -> float:
    """Mean by area; NaN if there is none."""
    return float(np.average(values, weights=areas_mm2)) if areas_mm2.sum() > 0 else float("nan")


def point_areas_mm2(plan: Mesh) -> np.ndarray:
    """A third of the area of the triangles at each point."""
    a, b, c = (plan.points_mm[plan.triangles[:, i]] for i in range(3))
    third = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 6
    return np.bincount(plan.triangles.reshape(-1), np.repeat(third, 3), len(plan.vertices))


def seam_points_mm(plan: Mesh) -> np.ndarray:
    """Where the stretches of the two dips of an edge's ends cross, both linear along the edge."""
    edges = np.concatenate([plan.triangles[:, [0, 1]], plan.triangles[:, [1, 2]], plan.triangles[:, [2, 0]]])
    dip = plan.vertices["dip"][edges]
    edges, dip = (rows[(dip[:, 0] != dip[:, 1]) & (dip > 0).all(axis=1)] for rows in (edges, dip))
    stretch = columns(plan, "stretch")
    ends = np.arange(len(edges))
    first, second = stretch[edges[ends, 0]], stretch[edges[ends, 1]]
    own, other = dip[:, 0] - 1, dip[:, 1] - 1
    before = first[ends, own] - first[ends, other]
    after = second[ends, own] - second[ends, other]
    share = np.divide(before, before - after, out=np.full(len(edges), 0.5), where=before != after)
    points = plan.points_mm
    return points[edges[:, 0]] + np.clip(share, 0, 1)[:, None] * (points[edges[:, 1]] - points[edges[:, 0]])


def of_any_plan(plan: Mesh) -> list[Claim]:
    """Weights are shares, and a dip has none where its film does not arrive."""
    weights, stretch = columns(plan, "weight"), columns(plan, "stretch")
    reached = np.isfinite(stretch).any(axis=1)
    return [
        Claim("weights outside 0 to 1", float(max(-weights.min(), weights.max() - 1, 0)), 1e-9),
        Claim("weights of reached points do not sum to one", float(np.abs(weights[reached].sum(axis=1) - 1).max()), 1e-6),
        Claim("weight where no film arrives", float(weights[~np.isfinite(stretch)].max(initial=0)), 0),
    ]


def of_sphere(plan: Mesh, sphere: closed_form.Sphere, width_mm: float, limits: Limits) -> list[Claim]:
    """Two opposite dips of a sphere, the first with the lowest point at -z."""
    height = plan.points_mm[:, 2] / sphere.radius_mm
    latitude_mm = sphere.radius_mm * np.arcsin(np.clip(height, -1, 1))
    expected = np.stack([closed_form.weight(latitude_mm, width_mm), closed_form.weight(-latitude_mm, width_mm)], axis=1)
    out = of_any_plan(plan)
    out.append(Claim("seam off the equator, mm", worst(np.abs(seam_points_mm(plan)[:, 2]), limits.seam_share), limits.seam_mm))
    out.append(Claim("weights off", float(np.abs(columns(plan, "weight") - expected).max()), limits.weight))
    areas = point_areas_mm2(plan)
    for dip, side in ((1, 1), (2, -1)):
        own = plan.vertices["dip"] == dip
        exact = sphere.stretch(np.arccos(np.clip(-side * height[own], -1, 1)))
        ratio = mean(columns(plan, "stretch")[own, dip - 1], areas[own]) / mean(exact, areas[own])
        out.append(Claim(f"mean stretch of dip {dip} off, share", abs(ratio - 1), limits.mean_stretch))
        out.append(Claim(f"area of dip {dip} off a hemisphere, share",
                         abs(areas[own].sum() / (2 * np.pi * sphere.radius_mm ** 2) - 1), 0.02))
    return out


LOWEST = np.array([0.0, 0.0, -1.0])


def film_grid_mm(shape: tuple[int, ...], dpi: float) -> tuple[np.ndarray, np.ndarray]:
    """x of the columns' and y of the rows' middles; the film's middle is the origin."""
    rows, columns_px = shape[:2]
    pitch_mm = 25.4 / dpi
    return (np.arange(columns_px) + 0.5 - columns_px / 2) * pitch_mm, (rows / 2 - np.arange(rows) - 0.5) * pitch_mm


def of_sphere_film(image: np.ndarray, dpi: float, sphere: closed_form.Sphere, width_mm: float, limits: Limits,
                   pole: np.ndarray = LOWEST) -> list[Claim]:
    """A film of a sphere in plain red: red times the weight, over white. pole: see closed_form."""
    rows, columns_px = image.shape[:2]
    x_mm, y_mm = film_grid_mm(image.shape, dpi)
    x_mm, y_mm = x_mm[None, :], y_mm[:, None]
    ink = closed_form.weight(sphere.beyond_mm(x_mm, y_mm, pole), width_mm)
    expected = np.stack([np.full_like(ink, 255), 255 * (1 - ink), 255 * (1 - ink)], axis=2)
    r_mm = np.hypot(x_mm, y_mm)
    inside = (r_mm > 1) & (r_mm < sphere.film_radius_mm(np.radians(110)))
    off = np.abs(image[:, :, :3].astype(float) - expected).max(axis=2)[inside]
    size_px = round(2 * sphere.film_mm * dpi / 25.4)
    return [
        Claim("size of the film image off, pixels", float(max(abs(rows - size_px), abs(columns_px - size_px))), 0),
        Claim(f"share of pixels more than {limits.level} levels off", float((off > limits.level).mean()),
              limits.pixels_off),
    ]


def of_cube(plan: Mesh, side_mm: float) -> list[Claim]:
    """Two opposite dips of a cube on its corner, the first with the corner at (-, -, -) lowest."""
    points, dip, half_mm = plan.points_mm, plan.vertices["dip"], side_mm / 2
    areas = point_areas_mm2(plan)
    out = of_any_plan(plan)
    out.append(Claim("share of the surface that no dip reaches", areas[dip == 0].sum() / areas.sum(), 0.001))
    inner = (np.abs(points) < half_mm - 2).sum(axis=1) == 2  # of a face, away from its edges
    low = (points < -half_mm + 1e-6).any(axis=1)
    wrong = inner & (dip != np.where(low, 1, 2))
    out.append(Claim("share of the faces' inner points with the wrong dip", wrong.sum() / inner.sum(), 0))
    seam = seam_points_mm(plan)
    out.append(Claim("seam off the zigzag, mm", worst(to_zigzag_mm(seam, half_mm)), 1))
    out.append(Claim("corners of the zigzag without seam", float(missed_corners(seam, half_mm)), 0))
    return out


def zigzag(half_mm: float) -> np.ndarray:
    """The six edges that touch neither (-, -, -) nor (+, +, +), as 6 x 2 ends, mm."""
    corners = [(1, -1, -1), (1, 1, -1), (-1, 1, -1), (-1, 1, 1), (-1, -1, 1), (1, -1, 1)]
    ring = half_mm * np.array(corners, float)
    return np.stack([ring, np.roll(ring, -1, axis=0)], axis=1)


def to_zigzag_mm(points: np.ndarray, half_mm: float) -> np.ndarray:
    """Distance of each point from the nearest of the six edges."""
    ends = zigzag(half_mm)
    along = (ends[:, 1] - ends[:, 0]) / (2 * half_mm)
    from_start = points[:, None, :] - ends[None, :, 0]
    share_mm = np.clip((from_start * along).sum(axis=2), 0, 2 * half_mm)
    return np.linalg.norm(from_start - share_mm[:, :, None] * along, axis=2).min(axis=1)


def missed_corners(seam: np.ndarray, half_mm: float) -> int:
    """Number of corners of the zigzag further than 3 mm from all points of the seam."""
    corners = zigzag(half_mm)[:, 0]
    return int((np.linalg.norm(corners[:, None] - seam[None], axis=2).min(axis=1) > 3).sum())


def of_plate(plan: Mesh, size_mm: tuple[float, float, float], width_mm: float) -> list[Claim]:
    """A thin plate, dipped with one large face down, then with the other. Points further from the rim than the width of
    the blend are printed by one dip alone: paths lead around the rim, never through the plate."""
    points, weights = plan.points_mm, columns(plan, "weight")
    to_rim_mm = np.minimum(size_mm[0] / 2 - np.abs(points[:, 0]), size_mm[1] / 2 - np.abs(points[:, 1]))
    inner = to_rim_mm > width_mm + 4  # dips may share a strip at the rim
    low = points[:, 2] < 0
    own = np.where(low, weights[:, 0], weights[:, 1])[inner]
    return of_any_plan(plan) + [
        Claim("points of the faces' middles missing", float(inner.sum() < 200), 0),
        Claim("weight of the face's own dip below one", float(1 - own.min(initial=1)), 1e-6),
    ]
