"""Where the film lands: the points of surface_map.ply, which of them can be judged, and colours of the film image."""
from __future__ import annotations

from dataclasses import dataclass
from typing import Callable

import numpy as np

from definition import Sites
from raster import Raster, Triangles, cross2, rasterised
from solids import normals_of

STRETCH = 3.0  # points where the film is stretched more are left out
THETA_DEG = 120.0
NEAR_FILM_MM, FAR_SPACE_MM = 1.5, 6.0  # points so near on the film must not be so far apart in space
NEAR_PX, FAR_AT_PIXEL_MM = 2, 4.0  # likewise for points inside of triangles
FILM_EDGE_MM = 3.0
CODES_PER_MM = 40.0  # largest change of the expected colour along the film


@dataclass(frozen=True)
class Film:
    """Shape of the film, centred in frame F: a circle or a rectangle."""
    option: str
    width_mm: float
    height_mm: float
    is_round: bool = False

    def to_edge_mm(self, places: np.ndarray) -> np.ndarray:
        if self.is_round:
            return self.width_mm / 2 - np.hypot(*places.T)
        return (np.array([self.width_mm, self.height_mm]) / 2 - np.abs(places)).min(axis=1)

    def size_px(self, dpi: float) -> tuple[int, int]:
        """Rows and columns of the film image."""
        return round(self.height_mm / 25.4 * dpi), round(self.width_mm / 25.4 * dpi)


def round_film(radius_mm: float) -> Film:
    return Film(f"circle:{radius_mm:g}", 2 * radius_mm, 2 * radius_mm, True)


@dataclass(frozen=True)
class Landing:
    """Points of the surface (frame O), the places of the film that land there (NaN: none), times of contact, and
    triangles. No two points are at the same place."""
    points: np.ndarray
    film: np.ndarray
    times: np.ndarray
    stretch: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray

    @property
    def reached(self) -> np.ndarray:
        return np.isfinite(self.film).all(axis=1)

    @property
    def sites(self) -> Sites:
        return Sites(self.points, self.triangles.reshape(-1), np.repeat(self.normals, 3, axis=0))

    def touched(self, of_triangle: np.ndarray) -> np.ndarray:
        """Points of which any triangle has the flag."""
        out = np.zeros(len(self.points), bool)
        out[self.triangles[of_triangle].reshape(-1)] = True
        return out


def landing(points: np.ndarray, film: np.ndarray, times: np.ndarray, stretch: np.ndarray,
            triangles: np.ndarray) -> Landing:
    """Joins points at the same place. If film lands on only some of them, or from different places, it counts as
    none."""
    _, first, number = np.unique(np.round(points, 4), axis=0, return_index=True, return_inverse=True)
    number = number.reshape(-1)
    order = np.argsort(number, kind="stable")
    starts = np.searchsorted(number[order], np.arange(len(first)))
    low, high = (extreme.reduceat(film[order], starts, axis=0) for extreme in (np.minimum, np.maximum))  # NaN wins
    agreed = np.where((high - low <= 0.3).all(axis=1)[:, None], (low + high) / 2, np.nan)
    joined = number[triangles]
    normals = normals_of(points[first], joined)
    proper = np.isfinite(normals).all(axis=1)
    return Landing(points[first], agreed, times[first], stretch[first], joined[proper], normals[proper])


def largest_stretch(found: Landing) -> tuple[np.ndarray, np.ndarray]:
    """Largest singular value of the map from film to surface in each triangle, and whether the triangle is folded over:
    its film, seen from above, must run clockwise, as the film's lower side is on the surface."""
    p, f = found.points[found.triangles], found.film[found.triangles]
    one, two = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    length = np.linalg.norm(one, axis=1)
    x = (one * two).sum(axis=1) / length
    y = np.sqrt(np.maximum((two ** 2).sum(axis=1) - x ** 2, 0))
    film_one, film_two = f[:, 1] - f[:, 0], f[:, 2] - f[:, 0]
    area = cross2(film_one, film_two)
    with np.errstate(invalid="ignore", divide="ignore"):
        # Columns of [one two] [film_one film_two]^-1 in the plane of the triangle
        a, b = length * film_two[:, 1] - x * film_one[:, 1], x * film_one[:, 0] - length * film_two[:, 0]
        c, d = -y * film_one[:, 1], y * film_one[:, 0]
        total, product = (a * a + b * b + c * c + d * d) / area ** 2, (a * d - b * c) / area ** 2
        largest = np.sqrt((total + np.sqrt(np.maximum(total ** 2 - 4 * product ** 2, 0))) / 2)
        return largest, ~(area < 0)


def others_nearby(found: Landing, reached: np.ndarray) -> np.ndarray:
    """Points for which another part of the surface lands nearby on the film, and earlier."""
    index = np.nonzero(reached)[0]
    index = index[np.argsort(found.film[index, 0], kind="stable")]
    film, points, times = found.film[index], found.points[index], found.times[index]
    out = np.zeros(len(found.points), bool)
    for step in range(1, len(index)):
        apart = film[step:] - film[:-step]
        near_x = apart[:, 0] < NEAR_FILM_MM
        if not near_x.any():
            break
        far = np.linalg.norm(points[step:] - points[:-step], axis=1) > FAR_SPACE_MM
        bad = near_x & (np.hypot(*apart.T) < NEAR_FILM_MM) & far
        later = times[step:] >= times[:-step]
        out[index[step:][bad & later]] = True
        out[index[:-step][bad & ~later]] = True
    return out


def raster_of(found: Landing, film: Film, dpi: float) -> Raster:
    whole = found.reached[found.triangles].all(axis=1)
    given = Triangles(found.points, found.film, found.times, found.triangles[whole], found.normals[whole])
    return rasterised(given, film.size_px(dpi), dpi)


def others_at_pixels(found: Landing, raster: Raster, dpi: float) -> np.ndarray:
    """Points near which, even inside of a large triangle, another part of the surface lands first on the film."""
    reached = found.reached
    places = np.where(reached[:, None], found.film, 0) * dpi / 25.4
    column = np.floor(places[:, 0] + raster.columns / 2).astype(int)
    row = np.floor(raster.rows / 2 - places[:, 1]).astype(int)
    first = raster.image()
    out = np.zeros(len(found.points), bool)
    for down in range(-NEAR_PX, NEAR_PX + 1):
        for right in range(-NEAR_PX, NEAR_PX + 1):
            y, x = np.clip(row + down, 0, raster.rows - 1), np.clip(column + right, 0, raster.columns - 1)
            out |= np.linalg.norm(first[y, x] - found.points, axis=1) > FAR_AT_PIXEL_MM  # False for NaN
    return reached & out


def left_out(found: Landing, film: Film, dpi: float, rotation: np.ndarray) -> dict[str, np.ndarray]:
    """Points that cannot be judged, for each reason. `rotation` takes frame O to frame F."""
    reached = found.reached
    stretch, folded = largest_stretch(found)
    theta_deg = np.degrees(np.arccos(np.clip(-(found.normals @ rotation.T)[:, 2], -1, 1)))
    whole = reached[found.triangles].all(axis=1)
    with np.errstate(invalid="ignore"):
        return {
            "not reached": ~reached,
            "reach ends": found.touched(~whole),
            "theta": found.touched(theta_deg > THETA_DEG),
            "stretch": found.touched(whole & (stretch > 1.2 * STRETCH)) | (found.stretch > STRETCH),
            "folded": found.touched(whole & folded),
            "overlap": others_nearby(found, reached) | others_at_pixels(found, raster_of(found, film, dpi), dpi),
            "film edge": ~(film.to_edge_mm(found.film) > FILM_EDGE_MM),
        }


def changes_fast(found: Landing, expected: np.ndarray, decals: np.ndarray) -> np.ndarray:
    """Points at edges along which the expected colour changes fast on the film, except edges at which a decal ends.
    `decals`: points x decals, whether it is shown."""
    out = np.zeros(len(found.points), bool)
    for i, j in ((0, 1), (1, 2), (2, 0)):
        one, two = found.triangles[:, i], found.triangles[:, j]
        change = np.abs(expected[one] - expected[two]).max(axis=1)
        change[(decals[one] != decals[two]).any(axis=1)] = 0
        with np.errstate(invalid="ignore"):
            fast = change > 3 + CODES_PER_MM * np.linalg.norm(found.film[one] - found.film[two], axis=1)
        out[one[fast]] = out[two[fast]] = True
    return out


# Film image

def codes_at(image: np.ndarray, dpi: float, places: np.ndarray) -> np.ndarray:
    """Bilinear between the pixels (places x 3). Row 0 is at the largest y; the image is centred on the film."""
    rows, columns = image.shape[:2]
    column = places[:, 0] * dpi / 25.4 + columns / 2 - 0.5
    row = rows / 2 - 0.5 - places[:, 1] * dpi / 25.4
    left = np.clip(np.floor(column), 0, columns - 2).astype(int)
    top = np.clip(np.floor(row), 0, rows - 2).astype(int)
    right_share, low_share = (column - left)[:, None], (row - top)[:, None]
    pixels = image[:, :, :3]
    upper = pixels[top, left] * (1 - right_share) + pixels[top, left + 1] * right_share
    lower = pixels[top + 1, left] * (1 - right_share) + pixels[top + 1, left + 1] * right_share
    return upper * (1 - low_share) + lower * low_share


# Pairs of points on both sides of a seam

@dataclass(frozen=True)
class Pairs:
    """Sites on both sides of a seam, and their places on the film."""
    sides: tuple[Sites, Sites]
    film: tuple[np.ndarray, np.ndarray]


def across_edges(found: Landing, usable: np.ndarray, apart_mm: float,
                 differ: Callable[[np.ndarray, np.ndarray], np.ndarray]) -> Pairs:
    """Pairs across the middles of edges between triangles whose normals differ in a certain way."""
    first, second, opposite, triangle = edge_sides(found.triangles)
    normals = found.normals[triangle]
    ok = usable[np.concatenate([first, second, opposite])].all(axis=0) & differ(normals[0], normals[1])
    places = []
    for side in range(2):
        start, end, third = first[0, ok], second[0, ok], opposite[side, ok]
        edge = found.points[end] - found.points[start]
        edge /= np.linalg.norm(edge, axis=1)[:, None]
        inwards = found.points[third] - found.points[start]
        height = np.linalg.norm(inwards - (inwards * edge).sum(axis=1)[:, None] * edge, axis=1)
        share = np.minimum(apart_mm / 2 / height, 0.5)[:, None]
        places.append([(1 - share) * (values[start] + values[end]) / 2 + share * values[third]
                       for values in (found.points, found.film)])
    sides = tuple(Sites.on_triangles(places[side][0], normals[side][ok]) for side in range(2))
    return Pairs(sides, (places[0][1], places[1][1]))


def edge_sides(triangles: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """For each edge with two triangles (2 x edges): its ends, the third points of both triangles, and the triangles."""
    ends = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    third = np.concatenate([triangles[:, 2], triangles[:, 0], triangles[:, 1]])
    owner = np.tile(np.arange(len(triangles)), 3)
    edges = np.sort(ends, axis=1)
    order = np.lexsort(edges.T)
    same = (edges[order[1:]] == edges[order[:-1]]).all(axis=1)
    one, two = order[:-1][same], order[1:][same]
    both = np.stack([one, two])
    return edges[both, 0], edges[both, 1], third[both], owner[both]


def across_angle(found: Landing, usable: np.ndarray, apart_mm: float, angle_rad: np.ndarray) -> Pairs:
    """Pairs along edges, on both sides of the places where the angle jumps from pi to -pi."""
    triangles = found.triangles
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    normals = np.tile(found.normals, (3, 1))
    start, end = edges.T
    jump = angle_rad[end] - angle_rad[start]
    ok = (np.abs(jump) > np.pi) & (np.abs(np.abs(jump) - 2 * np.pi) < 1) & usable[edges].all(axis=1) & (start < end)
    start, end, jump, normals = start[ok], end[ok], jump[ok], normals[ok]
    unwrapped = jump - 2 * np.pi * np.sign(jump)
    crossing = (-np.sign(jump) * np.pi - angle_rad[start]) / unwrapped
    half = apart_mm / 2 / np.linalg.norm(found.points[end] - found.points[start], axis=1)
    sides, film = [], []
    for sign in (-1, 1):
        share = np.clip(crossing + sign * half, 0, 1)[:, None]
        sides.append(Sites.on_triangles(found.points[start] * (1 - share) + found.points[end] * share, normals))
        film.append(found.film[start] * (1 - share) + found.film[end] * share)
    return Pairs((sides[0], sides[1]), (film[0], film[1]))
