"""The cases: an object, a pose, a paint, a film."""
from __future__ import annotations

import pathlib
from dataclasses import dataclass
from typing import Callable

import numpy as np

import solids
from definition import Layer, Paint
from landing import Film, round_film
from pictures import Picture, picture
from solids import Solid

CAT_UNIT_MM = 20.0  # the cat is then 69 mm high
PLAIN = picture("cat.png", 11)
TALL = picture("tall.png", 12, 400, 640)
GLASS = picture("glass.png", 13, 600, 480, transparent=True)

UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
OVER = solids.turn((1, 2, -1), 100)  # of balls: frames O and F differ much
ON_END = solids.after(solids.turn((1, 0, 0), 90),
                      solids.after(solids.turn((1, 0.4, 0), 12), solids.turn((0, 0, 1), 30)))
ON_SIDE = solids.after(solids.turn((1, 0, 0), 90),
                       solids.after(solids.turn((0.6, 1, 0), 9), solids.turn((0, 0, 1), -25)))


@dataclass(frozen=True)
class Case:
    name: str
    solid: str
    paint: Paint
    turn: np.ndarray | None = None  # quaternion; without one, no pose is given
    shift_mm: tuple[float, float] = (0.0, 0.0)  # of the middle of the bounding box, in frame F
    film: Film = round_film(140)
    depth_mm: float | None = None
    text: bool = False  # STL as text
    flags: tuple[str, ...] | None = None  # --texture and more, instead of --paint
    warning: str | None = None  # code of a warning that must be in the report

    @property
    def rotation(self) -> np.ndarray:
        return solids.rotation(UPRIGHT if self.turn is None else self.turn)

    @property
    def pictures(self) -> list[Picture]:
        return [layer.picture for layer in self.paint.layers if layer.picture]

    def pose(self, solid: Solid) -> dict:
        turned = solid.points @ self.rotation.T
        middle = (turned.min(axis=0) + turned.max(axis=0)) / 2
        x, y = np.array(self.shift_mm) - middle[:2]
        return {"rotation_wxyz": [float(value) for value in self.turn], "translation_mm": [float(x), float(y), 0.0]}


def of_film(turn: np.ndarray, direction: tuple[float, float, float], length: float = 1.0) -> tuple[float, ...]:
    """A direction of frame F in frame O, with four digits."""
    found = solids.rotation(turn).T @ np.array(direction)
    return tuple(round(float(value), 4) for value in length * found / np.linalg.norm(direction))


def one(**fields) -> Paint:
    """A paint of one layer."""
    return Paint((Layer(**fields),))


def over(base_colour: str, *layers: Layer) -> Paint:
    return Paint(layers, base_colour)


SPHERE = [
    Case("sphere-planar", "sphere", one(projection="planar", picture=PLAIN, position_mm=(6.0, -4.0, 11.0),
                                        direction=(0.5, 0.8, 0.6), up=(0.2, -0.3, 2.0), size_mm=64.0, turn_deg=25.0,
                                        mirror=True, repeat=True), OVER, (6, -4)),
    Case("sphere-planar-edge", "sphere",
         over("#1f4fa8", Layer("planar", TALL, size_mm=38.0, turn_deg=-100.0, opacity=0.6)), OVER),
    Case("sphere-dip", "sphere", one(picture=PLAIN), OVER, (-5, 7)),
    Case("sphere-dip-options", "sphere", one(projection="dip", picture=TALL, position_mm=(12.0, 5.0, -9.0),
                                             up=(0.9, 0.4, 0.3), size_mm=70.0, turn_deg=-40.0, mirror=True,
                                             repeat=True, opacity=0.8), OVER, film=Film("A3", 297, 420)),
    Case("sphere-cylindrical", "sphere", one(projection="cylindrical", picture=PLAIN, size_mm=92.0, turn_deg=70.0),
         OVER),
    Case("sphere-cylindrical-label", "sphere",
         over("#d8c020", Layer("cylindrical", GLASS, position_mm=(3.0, -2.0, 5.0), direction=(1.0, 0.3, 0.2),
                               up=(0.3, -0.2, 0.9), size_mm=130.0, turn_deg=-60.0, mirror=True, repeat=False)), OVER),
    Case("sphere-box", "sphere", one(projection="box", picture=PLAIN, size_mm=60.0), OVER),
    Case("sphere-box-options", "sphere",
         over("#204060", Layer("box", GLASS, position_mm=(5.0, 8.0, -3.0), direction=(0.4, 1.0, -0.3),
                               up=(0.1, 0.5, 1.0), size_mm=75.0, turn_deg=35.0, mirror=True, opacity=0.9,
                               blend_mm=16.0)), OVER, (3, 3)),
    Case("sphere-decal", "sphere",
         over("#c0d0e0", Layer("decal", PLAIN, position_mm=of_film(OVER, (0.25, 0.15, -0.95), 40.0),
                               direction=of_film(OVER, (-0.25, -0.15, 0.95)), up=(0.3, 1.0, 0.2), size_mm=50.0,
                               depth_mm=12.0, turn_deg=20.0, mirror=True, opacity=0.85)), OVER),
    Case("sphere-decal-default", "sphere",
         over("#305020", Layer("decal", TALL, direction=of_film(OVER, (0.8, 0.2, 0.5)))), OVER),
    Case("short-planar", "sphere", one(projection="planar", picture=PLAIN, size_mm=50.0, turn_deg=30.0), OVER,
         flags=("--project", "planar", "--project-size-mm", "50", "--project-turn-deg", "30")),
    Case("short-default", "sphere", one(picture=PLAIN), OVER, flags=(), warning="PICTURE_PROJECTED"),
    Case("short-no-pose", "sphere", one(projection="dip", picture=TALL, size_mm=45.0), None,
         flags=("--project", "dip", "--project-size-mm", "45")),
]

BRACKET = [
    Case("bracket-planar", "bracket", one(projection="planar", picture=PLAIN), ON_END, (4, -6), text=True),
    Case("bracket-planar-front", "bracket", one(projection="planar", picture=TALL, direction=(-0.4, 1.0, 0.7),
                                                size_mm=48.0, repeat=True, turn_deg=200.0), ON_END),
    Case("bracket-dip", "bracket", one(projection="dip", picture=PLAIN, size_mm=55.0, repeat=True, mirror=True,
                                       turn_deg=15.0), ON_END),
    Case("bracket-cylindrical", "bracket", one(projection="cylindrical", picture=TALL, direction=(1.0, 0.2, 0.3),
                                               up=(0.0, 1.0, 0.0), size_mm=70.0, turn_deg=100.0, mirror=True), ON_END),
    Case("bracket-box", "bracket", one(projection="box", picture=PLAIN), ON_END, text=True),
    Case("bracket-box-edge", "bracket",
         over("#804040", Layer("box", TALL, direction=(0.3, 1.0, 0.2), up=(-0.1, 0.1, 1.0), size_mm=34.0, repeat=False,
                               turn_deg=-20.0, opacity=0.7, blend_mm=9.0)), ON_END),
    Case("bracket-layers", "bracket",
         over("#e0e0d0", Layer("box", PLAIN, size_mm=66.0, blend_mm=7.0),
              Layer("decal", GLASS, position_mm=(55.0, 20.0, 6.0), direction=(-0.9, 0.5, 0.2), size_mm=56.0,
                    turn_deg=-35.0),
              Layer("decal", colour="#1f4fa8", direction=(0.7, 0.4, 0.3), size_mm=16.0, turn_deg=45.0, opacity=0.5)),
         ON_END),
]

CAT = [
    Case("cat-planar", "cat", one(projection="planar", picture=PLAIN, direction=(0.0, 1.0, 0.0)), ON_SIDE,
         depth_mm=11.0),
    Case("cat-dip", "cat", one(picture=PLAIN, up=(0.5, 1.0, 0.0)), ON_SIDE, (5, 5), depth_mm=11.0),
    Case("cat-cylindrical", "cat", one(projection="cylindrical", picture=PLAIN, size_mm=80.0, turn_deg=170.0), ON_SIDE,
         depth_mm=11.0),
    Case("cat-box", "cat", one(projection="box", picture=TALL, size_mm=55.0), ON_SIDE, depth_mm=11.0),
    Case("cat-decal", "cat",
         over("#f0c080", Layer("decal", GLASS, position_mm=(0.0, -8.0, 33.0), direction=(0.0, 1.0, 0.0), size_mm=40.0,
                               depth_mm=16.0)), ON_SIDE, depth_mm=11.0),
]

FULL = SPHERE + BRACKET + CAT

SMALL_FILM = round_film(90)
SMALL = [
    Case("small-planar", "ball", one(projection="planar", picture=PLAIN, direction=(0.5, 0.8, 0.6), size_mm=34.0,
                                     turn_deg=25.0, mirror=True, repeat=True), OVER, film=SMALL_FILM),
    Case("small-dip", "ball", one(picture=PLAIN, up=(0.9, 0.4, 0.3), turn_deg=-40.0), OVER, (3, -4),
         film=SMALL_FILM),
    Case("small-cylindrical", "ball", one(projection="cylindrical", picture=PLAIN, size_mm=56.0, turn_deg=70.0), OVER,
         film=SMALL_FILM),
    Case("small-box", "ball",
         over("#204060", Layer("box", GLASS, direction=(0.4, 1.0, -0.3), size_mm=45.0, blend_mm=9.0)), OVER,
         film=SMALL_FILM),
    Case("small-decal", "ball",
         over("#305020", Layer("decal", TALL, direction=of_film(OVER, (0.8, 0.2, 0.5)), opacity=0.8)), OVER,
         film=SMALL_FILM),
    Case("small-short", "ball", one(picture=PLAIN), OVER, film=SMALL_FILM, flags=(), warning="PICTURE_PROJECTED"),
]

SOLIDS: dict[str, Callable[[pathlib.Path], Solid | None]] = {
    "sphere": lambda cat: solids.icosphere(40, 4),
    "ball": lambda cat: solids.icosphere(25, 3),
    "bracket": lambda cat: solids.bracket(),
    "cat": lambda cat: solids.read_cat(cat, CAT_UNIT_MM) if cat.is_file() else None,
}
