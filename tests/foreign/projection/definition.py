"""The definition of a paint, from the comments of `Paint` and `PaintLayer` in proto/hydroprint/v1/spec.proto: places on
the picture, weights and colours at sites on a surface. Points are in frame O in mm; light is linear, from 0 to 1."""
from __future__ import annotations

import dataclasses
from dataclasses import dataclass

import numpy as np

from pictures import Picture
from solids import Solid

CHUNK = 400_000  # point-edge pairs that are computed at once


@dataclass(frozen=True)
class Layer:
    """A PaintLayer; None stands for a field that is not set."""
    projection: str | None = None
    picture: Picture | None = None
    colour: str | None = None
    position_mm: tuple[float, ...] | None = None
    direction: tuple[float, ...] | None = None
    up: tuple[float, ...] | None = None
    size_mm: float | None = None
    depth_mm: float | None = None
    turn_deg: float | None = None
    mirror: bool = False
    repeat: bool | None = None
    opacity: float | None = None
    blend_mm: float | None = None

    @property
    def kind(self) -> str:
        """The projection, for meshes without texture coordinates."""
        return self.projection or "dip"

    @property
    def repeats(self) -> bool:
        return self.kind in ("cylindrical", "box") if self.repeat is None else self.repeat

    @property
    def aspect(self) -> float:
        return self.picture.aspect if self.picture else 1.0

    def json(self) -> dict:
        """The layer in paint.json."""
        set_fields = {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}
        out = {name: value for name, value in set_fields.items() if value is not None and value is not False}
        if self.repeat is not None:
            out["repeat"] = self.repeat
        if self.picture:
            out["picture"] = self.picture.name
        return out


@dataclass(frozen=True)
class Paint:
    layers: tuple[Layer, ...]
    base_colour: str | None = None

    def json(self) -> dict:
        out: dict = {"layers": [layer.json() for layer in self.layers]}
        return out | ({"base_colour": self.base_colour} if self.base_colour else {})


@dataclass(frozen=True)
class Sites:
    """Points of a surface. Each has one or more triangles, given by their normals: row i is of point `owner[i]`."""
    points: np.ndarray
    owner: np.ndarray
    normals: np.ndarray

    @staticmethod
    def on_triangles(points: np.ndarray, normals: np.ndarray) -> "Sites":
        """Points inside of triangles: one normal for each point."""
        return Sites(points, np.arange(len(points)), normals)

    def any(self, flags: np.ndarray) -> np.ndarray:
        """Whether any of a point's triangles has the flag."""
        out = np.zeros(len(self.points), bool)
        out[self.owner[flags]] = True
        return out


@dataclass(frozen=True)
class Frame:
    """The directions r (right), u (up) and d (direction of view) of a layer, and the size (along r, u, d) and middle of
    the bounding box whose sides have these directions."""
    r: np.ndarray
    u: np.ndarray
    d: np.ndarray
    size: np.ndarray
    middle: np.ndarray

    @property
    def axes(self) -> np.ndarray:
        return np.stack([self.r, self.u, self.d])


def unit(vector: np.ndarray) -> np.ndarray:
    return vector / np.linalg.norm(vector)


def part_at_right_angles(vector: np.ndarray, to: np.ndarray) -> np.ndarray:
    """The part of a vector at right angles to a unit vector, with length 1."""
    return unit(vector - (vector @ to) * to)


def frame_of(layer: Layer, solid: Solid, rotation: np.ndarray) -> Frame:
    """`rotation` takes directions of frame O to frame F at the start of the (first) dip."""
    front = layer.kind in ("cylindrical", "box")
    d = unit(np.array(layer.direction or ((0.0, 1.0, 0.0) if front else (0.0, 0.0, 1.0))))
    if layer.kind == "dip":
        d = np.array([0.0, 0.0, 1.0])
    along_z = abs(d[2]) > np.cos(np.radians(1))
    up = np.array(layer.up or ((0.0, 1.0, 0.0) if along_z else (0.0, 0.0, 1.0)))
    if layer.kind == "cylindrical":
        u = unit(up)
        d = part_at_right_angles(d, u)
    else:
        u = part_at_right_angles(up, d)
    axes = np.stack([np.cross(d, u), u, d])
    if layer.kind == "dip":
        axes = axes @ rotation  # from F to O: rotation^T times each axis
    along = solid.points @ axes.T
    low, high = along.min(axis=0), along.max(axis=0)
    return Frame(*axes, high - low, (low + high) / 2 @ axes)


def cylinder_radius_mm(frame: Frame) -> float:
    return max(frame.size[0], frame.size[2]) / 2


def size_mm(layer: Layer, frame: Frame) -> tuple[float, float]:
    """Width and height of the picture on the object."""
    if layer.kind == "cylindrical":
        around = 2 * np.pi * cylinder_radius_mm(frame)
        width = layer.size_mm or around
        if layer.repeats:
            width = around / max(1, np.floor(around / width + 0.5))
    else:
        width = layer.size_mm or fitted_width_mm(layer, frame)
    return width, width / layer.aspect


def largest_side_mm(layer: Layer, frame: Frame) -> float:
    """L: the larger side of the bounding box in the picture's plane; of all sides for "box"."""
    return max(frame.size) if layer.kind == "box" else max(frame.size[:2])


def fitted_width_mm(layer: Layer, frame: Frame) -> float:
    side = largest_side_mm(layer, frame)
    width_is_shorter = layer.aspect < 1
    width_is_fitted = width_is_shorter != (layer.kind == "decal")
    return side if width_is_fitted else side * layer.aspect


def relative_to_position(layer: Layer, frame: Frame, points: np.ndarray) -> np.ndarray:
    """q.r, q.u and q.d of the points."""
    position = np.array(layer.position_mm) if layer.position_mm else frame.middle
    return (points - position) @ frame.axes.T


def places_mm(layer: Layer, frame: Frame, points: np.ndarray) -> list[np.ndarray]:
    """Places s, t of the points on the picture as projected, before its turn: one array (points x 2), or three for
    "box", along r, u and d."""
    r, u, d = relative_to_position(layer, frame, points).T
    if layer.kind == "cylindrical":
        phi = np.arctan2(r, -d)
        return [np.stack([phi * cylinder_radius_mm(frame), u], axis=1)]
    if layer.kind == "box":
        return [np.stack(pair, axis=1) for pair in ((d, u), (r, d), (r, u))]
    return [np.stack([r, u], axis=1)]


def on_picture_mm(layer: Layer, frame: Frame, points: np.ndarray) -> list[np.ndarray]:
    """Places on the picture itself, in mm from its middle to its right and up: turn and mirror are undone."""
    turn = np.radians(layer.turn_deg or 0)
    out = []
    for place in places_mm(layer, frame, points):
        s, t = place.T
        if layer.kind == "cylindrical":
            radius = cylinder_radius_mm(frame)
            phi = s / radius - turn
            right, up = radius * (phi - 2 * np.pi * np.ceil((phi - np.pi) / (2 * np.pi))), t  # from -pi to pi
        else:
            right, up = s * np.cos(turn) + t * np.sin(turn), t * np.cos(turn) - s * np.sin(turn)
        out.append(np.stack([-right if layer.mirror else right, up], axis=1))
    return out


def picture_coordinates(layer: Layer, frame: Frame, points: np.ndarray) -> list[np.ndarray]:
    """u = 1/2 + s / width, v = 1/2 + t / height (points x 2), before the picture repeats or its edge continues; three
    arrays for "box"."""
    return [0.5 + place / np.array(size_mm(layer, frame)) for place in on_picture_mm(layer, frame, points)]


# Box

def axis_of(normals: np.ndarray, frame: Frame) -> np.ndarray:
    """0, 1, 2: the axis r, u or d with which each normal encloses the smallest angle."""
    return np.argmax(np.abs(normals @ frame.axes.T), axis=1)


def axis_edges(solid: Solid, frame: Frame, axis: int) -> np.ndarray:
    """Edges (n x 2 x 3) at which triangles of an axis meet others."""
    return solid.points[axis_edge_ends(solid, axis_of(solid.normals, frame), axis)]


def axis_edge_ends(solid: Solid, axis_of_triangle: np.ndarray, axis: int) -> np.ndarray:
    own = np.tile(axis_of_triangle == axis, 3)
    triangles = solid.triangles
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    number = number.reshape(-1)
    owned = np.bincount(number, own, len(unique)) > 0
    foreign = np.bincount(number, ~own, len(unique)) > 0
    return unique[owned & foreign]


def distances_mm(points: np.ndarray, edges: np.ndarray) -> np.ndarray:
    """Distance in space of each point from the nearest edge; infinite without edges."""
    out = np.full(len(points), np.inf)
    if not len(edges):
        return out
    start, along = edges[:, 0], edges[:, 1] - edges[:, 0]
    squared = (along ** 2).sum(axis=1)
    step = max(1, CHUNK // len(edges))
    for first in range(0, len(points), step):
        part = points[first:first + step]
        ahead = part @ along.T - (start * along).sum(axis=1)
        share = np.clip(ahead / squared, 0, 1)
        # |p - start - share along|^2 in products of matrices, which need less memory than an array of vectors
        from_start = (part ** 2).sum(axis=1)[:, None] - 2 * part @ start.T + (start ** 2).sum(axis=1)
        apart = from_start - 2 * share * ahead + share ** 2 * squared
        out[first:first + step] = np.sqrt(np.maximum(apart.min(axis=1), 0))
    return out


def blend_mm(layer: Layer, frame: Frame) -> float:
    return layer.blend_mm or largest_side_mm(layer, frame) / 10


def smooth(distance_mm: np.ndarray, width_mm: float) -> np.ndarray:
    x = np.maximum(0, 1 - distance_mm / width_mm)
    return x ** 2 * (3 - 2 * x)


def box_weights(layer: Layer, solid: Solid, frame: Frame, sites: Sites) -> np.ndarray:
    """Weights of the axes r, u and d at each point (points x 3); they sum to one."""
    axis_of_normal = axis_of(sites.normals, frame)
    raw = np.empty((len(sites.points), 3))
    for axis in range(3):
        own = sites.any(axis_of_normal == axis)
        distance = np.zeros(len(sites.points))
        distance[~own] = distances_mm(sites.points[~own], axis_edges(solid, frame, axis))
        raw[:, axis] = smooth(distance, blend_mm(layer, frame))
    return raw / raw.sum(axis=1)[:, None]


# Decal

def decal_clearance_mm(layer: Layer, frame: Frame, points: np.ndarray) -> np.ndarray:
    """How far each point is inside the picture's size and the depth, in the directions right, up and along d; negative
    outside."""
    size = np.array(size_mm(layer, frame))
    place, = on_picture_mm(layer, frame, points)
    depth = layer.depth_mm or np.inf
    along = relative_to_position(layer, frame, points)[:, 2]
    return np.minimum((size / 2 - np.abs(place)).min(axis=1), depth / 2 - np.abs(along))


def faces_against(normals: np.ndarray, frame: Frame) -> np.ndarray:
    return normals @ frame.d < 0


def decal_shown(layer: Layer, frame: Frame, sites: Sites) -> np.ndarray:
    inside = decal_clearance_mm(layer, frame, sites.points) >= 0
    return inside & sites.any(faces_against(sites.normals, frame))


def decals_shown(paint: Paint, solid: Solid, rotation: np.ndarray, sites: Sites) -> np.ndarray:
    """Points x decals."""
    decals = [layer for layer in paint.layers if layer.kind == "decal"]
    shown = [decal_shown(layer, frame_of(layer, solid, rotation), sites) for layer in decals]
    return np.stack(shown, axis=1) if shown else np.zeros((len(sites.points), 0), bool)


# Colours

def to_linear(codes: np.ndarray) -> np.ndarray:
    """Linear light of sRGB codes from 0 to 255 (IEC 61966-2-1)."""
    c = codes / 255
    return np.where(c <= 0.04045, c / 12.92, ((np.maximum(c, 0) + 0.055) / 1.055) ** 2.4)


def to_codes(linear: np.ndarray) -> np.ndarray:
    """sRGB codes from 0 to 255, not rounded."""
    light = np.clip(linear, 0, 1)
    return 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def colour_codes(text: str) -> np.ndarray:
    return np.array([int(text[i:i + 2], 16) for i in (1, 3, 5)], float)


def sample(layer: Layer, coordinates: np.ndarray) -> np.ndarray:
    """Colour times alpha, and alpha, at places on the picture (points x 4)."""
    if layer.picture is None:
        codes = np.tile(colour_codes(layer.colour or "#ffffff"), (len(coordinates), 1))
    else:
        u, v = coordinates.T
        codes = layer.picture.codes(*((u, v) if layer.repeats else layer.picture.edge_continued(u, v)))
    alpha = codes[:, 3:] / 255 if codes.shape[1] == 4 else np.ones((len(codes), 1))
    return np.concatenate([to_linear(codes[:, :3]) * alpha, alpha], axis=1)


def layer_colours(layer: Layer, solid: Solid, rotation: np.ndarray, sites: Sites) -> np.ndarray:
    """Colour times alpha, and alpha, of a layer at sites (points x 4)."""
    frame = frame_of(layer, solid, rotation)
    colours = [sample(layer, place) for place in picture_coordinates(layer, frame, sites.points)]
    if layer.kind == "box":
        weights = box_weights(layer, solid, frame, sites)
        out = sum(weights[:, axis, None] * colours[axis] for axis in range(3))
    else:
        out = colours[0]
    if layer.kind == "decal":
        out = out * decal_shown(layer, frame, sites)[:, None]
    return out * (1.0 if layer.opacity is None else layer.opacity)


def colours(paint: Paint, solid: Solid, rotation: np.ndarray, sites: Sites) -> np.ndarray:
    """sRGB codes at sites (points x 3), not rounded."""
    out = np.tile(to_linear(colour_codes(paint.base_colour or "#ffffff")), (len(sites.points), 1))
    for layer in paint.layers:
        above = layer_colours(layer, solid, rotation, sites)
        out = out * (1 - above[:, 3:]) + above[:, :3]
    return to_codes(out)


def unsure(paint: Paint, solid: Solid, rotation: np.ndarray, sites: Sites, margin_mm: float) -> np.ndarray:
    """Points where a decal ends: near its edges or, within these, where not all of a point's triangles clearly face the
    same way."""
    out = np.zeros(len(sites.points), bool)
    for layer in paint.layers:
        if layer.kind != "decal":
            continue
        frame = frame_of(layer, solid, rotation)
        towards = sites.normals @ frame.d
        clearance = decal_clearance_mm(layer, frame, sites.points)
        on_silhouette = sites.any(towards < 1e-3) & sites.any(towards > -1e-3)
        out |= (np.abs(clearance) < margin_mm) | (on_silhouette & (clearance > 0))
    return out
