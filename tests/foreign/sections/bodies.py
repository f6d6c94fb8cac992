#!/usr/bin/env python3
"""Generates the bodies that people export: doubled, overlapping, open, fine, huge. See ../README.md.

    bodies.py --list
    bodies.py NAME FILE.stl          or FILE.ply, with double precision
"""
from __future__ import annotations

import argparse
import pathlib
import sys
from dataclasses import dataclass, field, replace
from typing import Callable

import numpy as np

import solids  # also makes ../plan importable
import shapes
from shapes import Shape

import meshes

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
SOLID, LATTICE, HOLLOW, OPEN, BAD = "solid", "lattice", "hollow", "open", "bad"
SIZE_MM = 110.0


def turn(*steps: tuple[int, float]) -> np.ndarray:
    """The quaternion of turns about coordinate axes (axis, degrees), in order."""
    out = UPRIGHT
    for axis, degrees in steps:
        w, v = (q := shapes.about(axis, np.radians(degrees)))[0], q[1:]
        out = np.array([w * out[0] - v @ out[1:], *(w * out[1:] + out[0] * v + np.cross(v, out[1:]))])
    return out


@dataclass(frozen=True)
class Body:
    """A mesh, and how it is dipped.

    kind: solid, lattice (wider limits of time and memory), hollow (encloses nothing), open (no claim about the
    result, only about the end), bad (an extreme size).
    size_mm: largest side to which the mesh is scaled; None: model units are mm.
    shells: number of shells of the file, without doubled faces.
    solid: the same body as closed shells, if the mesh is open or its shells touch.
    """
    shape: Shape
    shells: int
    kind: str = SOLID
    rotation: np.ndarray = field(default_factory=lambda: UPRIGHT)
    size_mm: float | None = SIZE_MM
    film: str = "A4"
    solid: Shape | None = None
    suffix: str = ".stl"

    @property
    def scale(self) -> float:
        extent = self.shape[0].max(axis=0) - self.shape[0].min(axis=0)
        return 1.0 if self.size_mm is None else float(self.size_mm / extent.max())

    def posed(self, shape: Shape) -> Shape:
        """A shape of the body's file in frame F, apart from its height."""
        return solids.turned((shape[0] * self.scale, shape[1]), self.rotation)

    def pose(self) -> dict[str, list[float]]:
        """The pose with the middle of the bounding box over the middle of the film."""
        points = self.posed(self.shape)[0]
        middle = (points.min(axis=0) + points.max(axis=0)) / 2
        return {"rotation_wxyz": self.rotation.tolist(), "translation_mm": [-middle[0], -middle[1], 0.0]}


# Doubled faces

SPHERE_MM = 40.0
SPHERE_FILM_MM = 105.0


def doubled_sphere(small: bool, copy_inverted: bool, suffix: str) -> Body:
    """A sphere given twice."""
    sphere = shapes.icosphere(SPHERE_MM, 4 if small else 6)
    copy = solids.inverted(sphere) if copy_inverted else sphere
    return Body(solids.joined([sphere, copy]), 1, size_mm=2 * SPHERE_MM, film=f"circle:{SPHERE_FILM_MM:g}",
                suffix=suffix)


def voxels(small: bool) -> Body:
    """Cubes that are each given with all six faces, as exporters of block worlds do: inner walls are doubled, and the
    cubes share their points."""
    size = 6 if small else 12
    i = np.stack(np.meshgrid(*(np.arange(size),) * 3, indexing="ij"), axis=-1)
    from_middle = np.linalg.norm(i + 0.5 - size / 2, axis=-1)
    filled = from_middle < size / 2
    cubes = [solids.moved(solids.box((0, 0, 0), (1, 1, 1)), tuple(cell)) for cell in np.argwhere(filled).astype(float)]
    grid = [np.arange(size + 1.0)] * 3
    return Body(solids.joined(cubes), 1, rotation=turn((0, 14), (1, 9)), solid=solids.blocks(grid, filled))


# Overlapping shells

# Strokes as x0, y0, x1, y1 on a grid of 5 x 7. Strokes overlap and have faces in common planes, but no common corner.
LETTERS = {
    "H": [(0, 0, 1, 7), (4, 0, 5, 7), (0.5, 3, 4.5, 4)],
    "Y": [(0, 4, 1, 7), (4, 4, 5, 7), (0.5, 3.5, 4.5, 4.5), (2, 0, 3, 4.2)],
    "D": [(0, 0, 1, 7), (0.5, 0, 4.2, 1), (0.5, 6, 4.2, 7), (4, 0.5, 5, 6.5)],
    "R": [(0, 0, 1, 7), (0.5, 6, 4.5, 7), (4, 3.4, 5, 6.8), (0.5, 3, 4.5, 4), (3, 0, 4, 3.3)],
    "O": [(0, 0, 1, 7), (4, 0, 5, 7), (0.5, 0, 4.5, 1), (0.5, 6, 4.5, 7)],
    "P": [(0, 0, 1, 7), (0.5, 6, 4.5, 7), (4, 3.4, 5, 6.8), (0.5, 3, 4.5, 4)],
    "I": [(2, 0, 3, 7), (1, 0, 4, 1), (1, 6, 4, 7)],
    "N": [(0, 0, 1, 7), (4, 0, 5, 7), (0.5, 4, 2.5, 5.5), (2, 2.2, 4.5, 4.2)],
    "T": [(2, 0, 3, 7), (0, 6, 5, 7)],
}


def raised_text(small: bool) -> Body:
    """Letters of boxes that overlap each other, sunk into a plate."""
    lines = ["HP"] if small else ["HYDRO", "PRINT"]
    width = 6.5 * len(lines[0])
    parts = [solids.box((-1.5, -1.5, -2), (width, 9 * len(lines), 0))]
    for row, line in enumerate(reversed(lines)):
        for column, letter in enumerate(line):
            for x0, y0, x1, y1 in LETTERS[letter]:
                x, y = 6.5 * column, 9.0 * row
                parts.append(solids.box((x + x0, y + y0, -0.4), (x + x1, y + y1, 1.2)))
    return Body(solids.joined(parts), len(parts), rotation=turn((0, 168), (1, 7)))


def struts(small: bool) -> Body:
    """A cubic lattice of cylinders with bracing. Cylinders in a row overlap with their sides in common planes."""
    cells = 2 if small else 4
    sides, radius = (6, 0.1) if small else (12, 0.08)
    nodes = [np.array((x, y, z), float) for x in range(cells + 1) for y in range(cells + 1) for z in range(cells + 1)]
    ways = [np.eye(3)[axis] for axis in range(3)] + [np.array([1.0, 1.0, 1.0]), np.array([1.0, -1.0, 1.0])]
    parts = []
    for node in nodes:
        for way in ways:
            end = node + way
            if end.min() < 0 or end.max() > cells:
                continue
            beyond = 0.07 * way / np.linalg.norm(way)
            parts.append(solids.frustum(node - beyond, end + beyond, (radius, radius), sides))
    return Body(solids.joined(parts), len(parts), LATTICE, turn((0, 8), (1, 5)))


def hedgehog(small: bool) -> Body:
    """A ball with spikes that begin inside it."""
    count = 60 if small else 728
    k = np.arange(count) + 0.5
    height, angle = 1 - 2 * k / count, np.pi * (1 + 5 ** 0.5) * k
    out = np.stack([np.cos(angle) * np.sqrt(1 - height ** 2), np.sin(angle) * np.sqrt(1 - height ** 2), height], axis=1)
    length = 50 + 5 * np.random.default_rng(5).random(count)
    spikes = [solids.frustum(32 * way, far * way, (1.3, 0), 10) for way, far in zip(out, length)]
    ball = shapes.icosphere(35, 3 if small else 5)
    return Body(solids.joined([ball, *spikes]), 1 + count)


def helmet(small: bool) -> Body:
    """A bowl of overlapping curved plates, with rivets, a crest and a brim: 85 shells. Dipped dome first."""
    rows, per_row, cells = (2, 5, 3) if small else (4, 11, 12)
    parts = [solids.moved(solids.torus(50, 2.5, 24 if small else 96, 8 if small else 20), (0, 0, -1))]
    for row in range(rows):
        for column in range(per_row):
            parts.append(plate_of_helmet(row, column, rows, per_row, cells))
    rivets = 4 if small else 39
    for k in range(rivets):
        place = on_dome(50.8, np.radians(20 + 62 * ((k * 0.618) % 1)), 2 * np.pi * k / rivets)
        parts.append(solids.ellipsoid(tuple(place), (1.6, 1.6, 1.6), 1 if small else 2, turn((0, 7.0 * k))))
    parts.append(solids.ellipsoid((0, 0, 50), (4, 18, 4), 2 if small else 3))
    return Body(solids.joined(parts), len(parts), rotation=turn((0, 172), (1, 6)))


def on_dome(radius: np.ndarray | float, theta: np.ndarray | float, phi: np.ndarray | float) -> np.ndarray:
    """A place at an angle from the top of the dome."""
    return np.stack(np.broadcast_arrays(radius * np.sin(theta) * np.cos(phi), radius * np.sin(theta) * np.sin(phi),
                                        radius * np.cos(theta)), axis=-1)


def plate_of_helmet(row: int, column: int, rows: int, per_row: int, cells: int) -> Shape:
    """A plate that overlaps its neighbours by a sixth, at its own radius."""
    low, high = (3 + 87 * (row + share) / rows for share in (-1 / 6, 7 / 6))
    theta = np.radians(np.linspace(max(low, 3), min(high, 92), cells + 1))[:, None]
    phi = 2 * np.pi * (column + 0.4 * row + np.linspace(-1 / 6, 7 / 6, cells + 1)[None]) / per_row
    radius = 49 + 0.35 * ((column + 2 * row) % 3) + 0.05 * row
    return solids.shell_of_patch(on_dome(radius + 1.6, theta, phi), on_dome(radius, theta, phi))


def assembly(small: bool) -> Body:
    """A machine part of shells that touch or contain each other: plates, rows of pins, stacked washers, fins and
    sleeves of 0.001 mm. No corner is common. Dipped with the sleeves first."""
    columns = 4 if small else 8
    width = 12.0 * columns
    parts = [solids.box((0, 0, 0), (width, 60, 8))]
    for column in range(columns):
        x, sides = 12.0 * column, 24 if small else 48
        parts.append(solids.sleeve((x + 6, 42), (4.5, 4.501), (-24, 0), sides))
        parts += [cylinder((x + 6, 42), (low, low + 3), 3 - 0.2 * abs(low + 6), 24) for low in (-12, -9, -6, -3)]
        parts += [cylinder((x + 3 + 6 * k, 8), (-8 - k, k), 3, 16 + 8 * k) for k in range(2)]
        parts += [cylinder((x + 6, 42), (8, 12), radius, 24) for radius in (1, 2, 3, 4, 5)]
        parts += [solids.box((x + 3 * k, 16, -16), (x + 3 * k + 0.001 * 4 ** k, 30, 0)) for k in range(4)]
        parts += [solids.box((x + 3 * k, 10 + k, 8), (x + 3 * k + 3, 34 + k, 11 + k % 2)) for k in range(4)]
    return Body(solids.joined(parts), len(parts))


def cylinder(middle: tuple[float, float], z: tuple[float, float], radius: float, sides: int) -> Shape:
    low, high = (np.array([*middle, end], float) for end in z)
    return solids.frustum(low, high, (radius, radius), sides)


# Middle, radii, turn about x in degrees.
Ellipsoid = tuple[tuple[float, float, float], tuple[float, float, float], float]
BEAR: list[Ellipsoid] = [
    ((0, 0, 42), (24, 20, 28), 0), ((0, 0, 80), (18, 17, 17), 0), ((0, -15, 76), (8, 9, 7), 0),
    ((-13, 2, 94), (7, 4, 7), 0), ((13, 2, 94), (7, 4, 7), 0), ((-27, -4, 52), (8, 9, 17), 25),
    ((27, -4, 52), (8, 9, 17), 25), ((-13, -2, 14), (11, 12, 17), 0), ((13, -2, 14), (11, 12, 17), 0),
    ((-14, -10, 5), (9, 14, 7), 8), ((14, -10, 5), (9, 14, 7), 8), ((0, 20, 26), (6, 7, 6), 0),
    ((0, -8, 44), (18, 15, 20), 0),
]
FIGURE: list[Ellipsoid] = [  # without limbs, so that film reaches all of it
    ((0, 0, 36), (25, 23, 36), 0), ((0, 0, 72), (20, 19, 22), 0), ((0, -5, 34), (22, 20, 28), 0),
    ((0, 0, 56), (22, 21, 22), 0), ((0, 4, 28), (22, 20, 24), 0), ((9, 0, 40), (18, 18, 24), 0),
    ((-9, 0, 40), (18, 18, 24), 0), ((0, -3, 74), (18, 18, 18), 0),
]
ELLIPSOIDS = {"bear": BEAR, "figure": FIGURE}


def of_ellipsoids(small: bool, name: str) -> Body:
    parts = [solids.ellipsoid(middle, radii, 3 if small else 4, turn((0, degrees)))
             for middle, radii, degrees in ELLIPSOIDS[name]]
    return Body(solids.joined(parts), len(parts), rotation=turn((0, 6), (1, 4)))


def within_ellipsoids(points: np.ndarray, name: str) -> np.ndarray:
    """Whether points of the surface (frame O, model units) are inside an ellipsoid other than the one they lie on, by
    more than a thousandth of its radii."""
    size = np.stack([np.linalg.norm((points - np.array(middle)) @ shapes.rotation(turn((0, degrees)))
                                    / np.array(radii), axis=1) for middle, radii, degrees in ELLIPSOIDS[name]], axis=1)
    size[np.arange(len(points)), np.argmin(np.abs(size - 1), axis=1)] = 1  # of the one they lie on
    return (size < 0.999).any(axis=1)


# One shell

HOLE_SEGMENTS = 64


def bracket(small: bool) -> Body:
    """An L-bracket of perforated plates, about 23,000 triangles: one hole in each cell of a grid."""
    base, wall, across = (3, 2, 2) if small else (7, 4, 8)
    thickness, cell = 6.0, 12.0
    xs = np.concatenate([[0.0], thickness + cell * np.arange(base + 1)])
    zs = np.concatenate([[0.0], thickness + cell * np.arange(wall + 1)])
    ys = cell * np.arange(across + 1.0)
    filled = np.zeros((base + 1, across, wall + 1), bool)
    filled[:, :, 0] = filled[0] = True
    soup = []
    for axis, side, cells in solids.cell_faces(filled):
        for index in cells:
            quad = solids.cell_corners([xs, ys, zs], axis, side, index)
            through = (axis == 2 and index[0] > 0) or (axis == 0 and index[2] > 0)
            soup.append(perforated(quad, axis, side, thickness) if through else quad[[[0, 1, 2], [0, 2, 3]]])
    return Body(solids.weld(np.concatenate(soup)), 1, rotation=turn((0, 11), (1, 24)))


def perforated(quad: np.ndarray, axis: int, side: int, thickness: float) -> np.ndarray:
    """A rectangle with a round hole, and on the lower side also the wall of the hole."""
    corners = quad if side else quad[::-1]
    middle, u, v = corners.mean(axis=0), np.eye(3)[(axis + 1) % 3], np.eye(3)[(axis + 2) % 3]
    angle = 2 * np.pi * np.arange(HOLE_SEGMENTS) / HOLE_SEGMENTS
    ring = middle + 4.2 * (np.outer(np.cos(angle), u) + np.outer(np.sin(angle), v))
    quarter = HOLE_SEGMENTS // 4
    after = np.roll(ring, -1, axis=0)
    out = []
    for k in range(4):
        corner = corners[(k + 2) % 4]  # the corner at 45 + 90 k degrees
        part = slice(k * quarter, (k + 1) * quarter)
        out.append(np.stack([np.broadcast_to(corner, (quarter, 3)), after[part], ring[part]], axis=1))
        out.append(np.stack([corner, corners[(k + 3) % 4], after[part][-1]])[None])
    face = np.concatenate(out)
    if side:
        return face
    depth = thickness * np.eye(3)[axis]
    walls = [np.stack([after, ring, ring + depth], axis=1), np.stack([after, ring + depth, after + depth], axis=1)]
    return np.concatenate([face[:, ::-1], *walls])


def gyroid(small: bool) -> Body:
    """A sheet of constant width around the gyroid, cut off by a box of 80 mm."""
    pitch, period = (4.0, 40.0) if small else (1.25, 20.0)
    size = 80.0
    line = pitch * (np.arange(round(size / pitch) + 3) - 1.0)
    a, b, c = (2 * np.pi / period * values for values in np.meshgrid(line, line, line, indexing="ij"))
    field_of = np.sin(a) * np.cos(b) + np.sin(b) * np.cos(c) + np.sin(c) * np.cos(a)
    from_sides = np.max(np.abs(np.stack(np.meshgrid(line, line, line, indexing="ij")) - size / 2), axis=0) - size / 2
    values = np.maximum((np.abs(field_of) - 0.45) * period / 9, from_sides + 0.3 * pitch)
    shape = solids.surface_net(values, pitch)
    return Body(shape, len(np.unique(meshes.shells(shape))), LATTICE, size_mm=size)


def comb(small: bool) -> Body:
    """A comb with its teeth down, as one shell."""
    teeth = 12 if small else 60
    width = 110 / (2 * teeth - 1)
    xs = width * np.arange(2 * teeth)
    filled = np.zeros((2 * teeth - 1, 1, 2), bool)
    filled[:, 0, 1] = True
    filled[0::2, 0, 0] = True
    shape = solids.blocks([xs, np.array([0.0, 4.0]), np.array([0.0, 30.0, 42.0])], filled)
    return Body(shape, 1, rotation=turn((0, 5), (1, 3)))


def noisy_scan(small: bool) -> Body:
    """A scanned lump: noise on every point, and a few holes."""
    rng = np.random.default_rng(11)
    points, triangles = shapes.icosphere(1, 4 if small else 6)
    lump = np.ones(len(points))
    for _ in range(12):
        way, size = rng.normal(size=3), rng.uniform(0.05, 0.12)
        lump += size * np.exp(-8 * (1 - points @ (way / np.linalg.norm(way))))
    noise = rng.normal(0, 0.4 if small else 0.25, len(points))
    points = points * (48 * lump + noise)[:, None]
    ways = rng.normal(size=(5, 3))
    ways /= np.linalg.norm(ways, axis=1)[:, None]
    middle = points[triangles].mean(axis=1)
    middle /= np.linalg.norm(middle, axis=1)[:, None]
    hole = (middle @ ways.T > np.cos(np.radians(5 if small else 3))).any(axis=1)
    return Body((points, triangles[~hole]), 1, solid=(points, triangles))


def cup(small: bool) -> Body:
    """A cup, mouth down and tilted."""
    round_off = [(3 * np.sin(t), 3 - 3 * np.cos(t)) for t in np.linspace(0, np.pi / 2, 6)]
    outside = [(0.0, 0.0), (20.0, 0.0), *((27 + x, y) for x, y in round_off), (36.0, 80.0)]
    inside = [(33.0, 80.0), (27.5, 5.0), (0.0, 5.0)]
    profile = np.array(outside + inside)
    shape = solids.revolved(refined(profile, 8.0 if small else 1.5), 32 if small else 160)
    return Body(shape, 1, rotation=turn((0, 158), (1, 6)))


def refined(line: np.ndarray, longest: float) -> np.ndarray:
    """Divides the pieces of a line."""
    out = [line[0]]
    for a, b in zip(line[:-1], line[1:]):
        count = int(np.ceil(np.linalg.norm(b - a) / longest))
        out += [a + (b - a) * (k + 1) / count for k in range(count)]
    return np.array(out)


def plate_edge(_: bool) -> Body:
    """A plate that meets the water with a long level edge."""
    return Body(solids.box((0, 0, 0), (120, 80, 4)), 1, rotation=turn((0, 17.5)))


def level_box(_: bool) -> Body:
    """A box that meets the water with a face."""
    return Body(solids.box((0, 0, 0), (60, 40, 30)), 1, size_mm=60)


def inside_out(_: bool) -> Body:
    """A box whose faces all point inwards."""
    return Body(solids.inverted(solids.box((0, 0, 0), (60, 40, 30))), 1, rotation=turn((0, 20), (1, 15)), size_mm=60)


def gap(small: bool) -> Body:
    """Two balls one above the other: sections between them are empty."""
    balls = [solids.ellipsoid((0, 0, z), (15, 15, 15), 3 if small else 4) for z in (0, 45)]
    return Body(solids.joined(balls), 2, size_mm=75)


# Bodies that enclose nothing, and extreme sizes

def flat_plate(_: bool) -> Body:
    """A flat plate without thickness, both sides given."""
    u, v = np.meshgrid(np.linspace(0, 60, 13), np.linspace(0, 40, 9), indexing="ij")
    side = np.stack([u, v, 0 * u], axis=2).reshape(-1, 3), solids.grid_triangles(13, 9)
    return Body(solids.joined([side, solids.inverted(side)]), 1, HOLLOW, turn((0, 35), (1, 10)))


def moebius(_: bool) -> Body:
    """A strip with one side."""
    count, u = 120, 2 * np.pi * np.arange(120) / 120
    w = np.linspace(-12, 12, 9)[None]
    r = 40 + w * np.cos(u / 2)[:, None]
    points = np.stack([r * np.cos(u)[:, None], r * np.sin(u)[:, None], w * np.sin(u / 2)[:, None]], axis=2)
    triangles = solids.grid_triangles(count, 9)
    last, first = (count - 1) * 9 + np.arange(9), np.arange(9)[::-1]
    joint = [np.stack([last[:-1], first[:-1], first[1:]], 1), np.stack([last[:-1], first[1:], last[1:]], 1)]
    return Body((points.reshape(-1, 3), np.concatenate([triangles, *joint])), 1, HOLLOW, turn((0, 30)))


def one_triangle(_: bool) -> Body:
    return Body((np.array([(0.0, 0, 0), (60, 0, 10), (20, 50, 30)]), np.array([(0, 1, 2)])), 1, HOLLOW)


def inner_faces(_: bool) -> Body:
    """The inside of a room: a floor and four walls that face inwards, and no outside."""
    shape = solids.inverted(solids.box((0, 0, 0), (60, 40, 30)))
    lid = (shape[0][shape[1]][:, :, 2] == 30).all(axis=1)
    return Body((shape[0], shape[1][~lid]), 1, OPEN, turn((0, 20), (1, 15)), 60)


def sized(largest_mm: float, suffix: str) -> Body:
    """A ball of a size that is far from usual ones."""
    return Body(shapes.icosphere(largest_mm / 2, 3), 1, BAD, size_mm=None, suffix=suffix)


BODIES: dict[str, Callable[[bool], Body]] = {
    "doubled": lambda small: doubled_sphere(small, True, ".stl"),
    "doubled-same": lambda small: doubled_sphere(small, False, ".ply"),
    "voxels": voxels,
    "text": raised_text,
    "bracket": bracket,
    "gyroid": gyroid,
    "struts": struts,
    "comb": comb,
    "hedgehog": hedgehog,
    "scan": noisy_scan,
    "helmet": helmet,
    "assembly": assembly,
    "bear": lambda small: of_ellipsoids(small, "bear"),
    "figure": lambda small: of_ellipsoids(small, "figure"),
    "cup": cup,
    "plate-edge": plate_edge,
    "level-box": level_box,
    "gap": gap,
    "inside-out": inside_out,
    "flat-plate": flat_plate,
    "moebius": moebius,
    "inner-faces": inner_faces,
    "triangle": one_triangle,
    "ten-metres": lambda _: sized(10000, ".stl"),
    "hundredth": lambda _: sized(0.01, ".ply"),
}
QUICK = [name for name in BODIES if name not in ("gyroid", "struts", "hedgehog", "scan", "helmet")]


def body(name: str, small: bool = False) -> Body:
    """A body with its points as the file contains them."""
    out = BODIES[name](small)
    if out.suffix == ".stl":
        rounded = solids.as_float32(out.shape[0]), out.shape[1]
        solid = None if out.solid is None else (solids.as_float32(out.solid[0]), out.solid[1])
        out = replace(out, shape=rounded, solid=solid)
    return out


def list_bodies(small: bool) -> None:
    for name in BODIES:
        one = body(name, small)
        size = "as in the file" if one.size_mm is None else f"{one.size_mm:g} mm"
        print(f"{name:13} {len(one.shape[1]):7,} triangles {one.shells:5} shells  {one.kind:8} {size:15} {one.film}")


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("name", nargs="?", choices=BODIES, metavar="NAME", help="the body; --list shows the names")
    parser.add_argument("file", nargs="?", type=pathlib.Path, metavar="FILE", help="an .stl or .ply file to write")
    parser.add_argument("--small", action="store_true", help="a coarse version")
    parser.add_argument("--list", action="store_true", help="list the bodies")
    options = parser.parse_args()
    if options.list:
        list_bodies(options.small)
    elif options.file is None:
        parser.error("NAME and FILE are required")
    else:
        try:
            meshes.write(options.file, body(options.name, options.small).shape)
        except (OSError, ValueError) as error:
            parser.error(str(error))
    return 0


if __name__ == "__main__":
    sys.exit(main())
