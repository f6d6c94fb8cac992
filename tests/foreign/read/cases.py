"""The reading cases of ../shared/cases: a sphere of four coloured quadrants in many files. Each case.json lists runs of
`simulate`."""
from __future__ import annotations

import json
import pathlib
import re
from dataclasses import dataclass

import numpy as np

import closed_form
import png
import scene
from scene import Scene

FOLDER = pathlib.Path(__file__).resolve().parents[4] / "shared/cases"
READING = set(range(1, 30)) - {27, 28}
FILM_MM = 60.0
FLAGS = ("--film", f"circle:{FILM_MM:g}", "--dpi", "60", "--model", "stokes", "--depth-mm", "14", "--threads", "1")
OF_INSPECT = ("--mesh", "--scale")
OF_SIMULATE = ("--artifacts",)  # without it, `simulate` refuses models that have no colours
QUADRANTS = {"++": (1, 1), "-+": (-1, 1), "--": (-1, -1), "+-": (1, -1)}
MIDDLE_MM, APART_MM = 8.5, 1.5  # on the film, along x and y

# A model without colours cannot be printed, but it can be read and shown: this refusal is about the film. All other
# refusals of runs that only name a model are about reading the model and its textures.
ABOUT_THE_FILM = re.compile("the film would stay blank")


@dataclass(frozen=True)
class Run:
    name: str
    folder: pathlib.Path  # where the program is started
    flags: dict[str, str]  # of `simulate`, without FLAGS

    @property
    def for_inspect(self) -> list[str]:
        return [word for flag, value in self.flags.items() if flag in OF_INSPECT for word in (flag, value)]

    @property
    def for_simulate(self) -> list[str]:
        return [word for pair in self.flags.items() for word in pair] + list(FLAGS)


def read(folder: pathlib.Path) -> tuple[list[Run], list[str]]:
    """The runs to judge, and a line for each skipped one."""
    runs, skipped = [], []
    for path in sorted(folder.glob("*/case.json")):
        case = json.loads(path.read_text(encoding="utf-8"))
        if not path.parent.name[:2].isdigit() or int(path.parent.name[:2]) not in READING or case["kind"] != "worker":
            continue
        for each in case["runs"]:
            name = f"{path.parent.name} | {each['name']}"
            flags = dict(zip(each["args"][::2], each["args"][1::2]))
            others = set(flags) - {*OF_INSPECT, *OF_SIMULATE}
            if others:
                skipped.append(f"{name}: not the model's own colours ({', '.join(sorted(others))})")
                continue
            runs.append(Run(name, path.parent, flags))
            if "--artifacts" in flags:
                skipped.append(f"{name}: colours, because the run makes no film.png; the rest is judged")
    return runs, skipped


def film_places(signs: tuple[int, int]) -> np.ndarray:
    """Nine points in the middle of a quadrant of the film, mm from its centre."""
    steps = MIDDLE_MM + APART_MM * np.array([-1, 0, 1])
    return np.array([(signs[0] * x, signs[1] * y) for x in steps for y in steps])


def film_colours(path: pathlib.Path) -> dict[str, np.ndarray]:
    """The median colour of each quadrant of film.png; its first row is at the largest y."""
    image = png.read(path)
    out = {}
    for name, signs in QUADRANTS.items():
        shares = (film_places(signs) * [1, -1] / FILM_MM + 1) / 2
        column, row = (shares * [image.shape[1], image.shape[0]]).astype(int).T
        out[name] = np.median(image[row, column, :3].astype(float), axis=0)
    return out


def landed_mm(film_mm: np.ndarray, radius_mm: float) -> np.ndarray:
    """Where points of the film land on a sphere in its middle, as (x, y) from the sphere's centre."""
    distance = np.linalg.norm(film_mm, axis=1)
    theta = closed_form.Sphere(radius_mm, FILM_MM).theta_rad(distance)
    return film_mm * (radius_mm * np.sin(theta) / distance)[:, None]


def model_colours(model: Scene) -> dict[str, np.ndarray]:
    """The median colour seen from below where the same points of the film land on the sphere: the middle of its bounding
    box is above the centre of the film."""
    low, high = model.box
    radius = (high[0] - low[0]) / 2
    out = {}
    for name, signs in QUADRANTS.items():
        landed = landed_mm(film_places(signs), radius)
        hits = scene.lowest_hits(model, (low[:2] + high[:2]) / 2 + landed)
        out[name] = np.median(scene.shown(model, hits), axis=0)  # NaN if a ray meets nothing
    return out
