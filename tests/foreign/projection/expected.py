"""Writes expected places on the pictures, as input for other tests (of a page's shader)."""
from __future__ import annotations

import json
import pathlib

import numpy as np

import definition
import solids
from cases import BRACKET, SMALL, Case
from definition import Layer, Sites
from solids import Solid

POINTS = 200
OBJECTS = {"bracket": solids.bracket, "ball": lambda: solids.icosphere(25, 2)}
ABOUT = ("u = 1/2 + s / width_mm and v = 1/2 + t / height_mm of points in frame O, before the picture repeats or its "
         "edge continues; v is up. The rotation takes frame O to frame F. Only the first layer of each paint is here. "
         "For box, uv and weights are for the axes r, u and d. The sides of the bounding box have the directions r, u, "
         "d; these, its middle and the position are in frame O. The normals are those of the points' triangles.")


def sample(solid: Solid, rng: np.random.Generator) -> Sites:
    """Points inside of triangles, uniform by area."""
    a, b, c = (solid.points[solid.triangles[:, i]] for i in range(3))
    area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
    which = rng.choice(len(area), POINTS, p=area / area.sum())
    s, t = np.sqrt(rng.uniform(0, 1, POINTS)), rng.uniform(0, 1, POINTS)
    points = ((1 - s)[:, None] * a[which] + (s * (1 - t))[:, None] * b[which] + (s * t)[:, None] * c[which])
    return Sites.on_triangles(points, solid.normals[which])


def numbers(values: np.ndarray) -> list:
    return np.round(values, 9).tolist()


def of_layer(layer: Layer, solid: Solid, rotation: np.ndarray, sites: Sites) -> dict:
    frame = definition.frame_of(layer, solid, rotation)
    width, height = definition.size_mm(layer, frame)
    uv = definition.picture_coordinates(layer, frame, sites.points)
    out = {
        "r": numbers(frame.r), "u": numbers(frame.u), "d": numbers(frame.d),
        "box_size_mm": numbers(frame.size), "box_middle_mm": numbers(frame.middle),
        "position_mm": numbers(np.array(layer.position_mm) if layer.position_mm else frame.middle),
        "width_mm": round(float(width), 9), "height_mm": round(float(height), 9), "repeats": layer.repeats,
        "points_mm": numbers(sites.points), "normals": numbers(sites.normals),
        "uv": numbers(np.stack(uv, axis=1) if layer.kind == "box" else uv[0]),
    }
    if layer.kind == "cylindrical":
        out["radius_mm"] = round(float(definition.cylinder_radius_mm(frame)), 9)
    if layer.kind == "box":
        out["blend_mm"] = round(float(definition.blend_mm(layer, frame)), 9)
        out["weights"] = numbers(definition.box_weights(layer, solid, frame, sites))
    if layer.kind == "decal":
        out["shown"] = definition.decal_shown(layer, frame, sites).tolist()
    return out


def of_case(case: Case, solid: Solid, rng: np.random.Generator) -> dict:
    layer = case.paint.layers[0]
    picture = {"width_px": layer.picture.width_px, "height_px": layer.picture.height_px}
    found = of_layer(layer, solid, case.rotation, sample(solid, rng))
    return {"name": case.name, "object": case.solid, "projection": layer.kind, "layer": layer.json(),
            "picture": picture, "rotation_wxyz": numbers(case.turn), **found}


def write(path: pathlib.Path, seed: int) -> None:
    found = {name: make() for name, make in OBJECTS.items()}
    objects = {name: {"points_mm": numbers(solid.points), "triangles": solid.triangles.tolist(),
                      "normals": numbers(solid.normals)} for name, solid in found.items()}
    cases = []
    for number, case in enumerate(case for case in BRACKET + SMALL if case.flags is None):
        cases.append(of_case(case, found[case.solid], np.random.default_rng([seed, number])))
    text = json.dumps({"about": ABOUT, "seed": seed, "objects": objects, "cases": cases})
    path.write_text(text + "\n", encoding="ascii")
