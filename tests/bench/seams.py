#!/usr/bin/env python3
"""The row `seams` of README.md: colours at the seams of two misplaced dips of spot, with blending and without.

Prints the figures as one JSON object. Uses the readers and formulas of tests/foreign/plan.
"""
from __future__ import annotations

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
from dataclasses import dataclass

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "foreign/plan"))
import claims  # noqa: E402
import colour  # noqa: E402
import ply  # noqa: E402
import png  # noqa: E402
import shapes  # noqa: E402

SCALE = 50.0
BLENDS_MM = {"blended": 5.0, "unblended": 0.1}
NEAR_MM = 2 * BLENDS_MM["blended"]
VISIBLE = 20.0  # CIEDE2000
CALM = 2.0  # largest stretch
DARK = np.full(3, 0.2)  # as the darkest patches of spot
SEED = 20261127
FILM = ["--model", "stokes", "--ink-passes", "0", "--dpi", "100"]
SIDES = [shapes.about(1, np.pi / 2), shapes.about(1, np.radians(-80))]  # on its two sides, one tilted by 10 degrees


@dataclass(frozen=True)
class Object:
    """A mesh in mm with the wanted colour of each point, 0 to 1."""
    points_mm: np.ndarray
    triangles: np.ndarray
    colours: np.ndarray

    @property
    def middle_mm(self) -> np.ndarray:
        return (self.points_mm.min(axis=0) + self.points_mm.max(axis=0)) / 2


@dataclass(frozen=True)
class Pose:
    """Object to film; the worker chooses z, so that the object is above the film."""
    rotation: np.ndarray
    xy_mm: np.ndarray

    def written(self) -> dict:
        return {"rotation_wxyz": self.rotation.tolist(), "translation_mm": [*self.xy_mm.tolist(), 0]}


def read_textured(obj: pathlib.Path, picture: np.ndarray) -> tuple[Object, np.ndarray, np.ndarray]:
    """Reads an OBJ file of triangles and divides each into four, so that the points are close enough to see a gap. Returns
    also the texture coordinates and those of the corners, as rows of three indices."""
    rows = [line.split() for line in obj.read_text().splitlines() if line]
    points = np.array([row[1:4] for row in rows if row[0] == "v"], float)
    uv = np.array([row[1:3] for row in rows if row[0] == "vt"], float)
    faces = np.array([[corner.split("/")[:2] for corner in row[1:4]] for row in rows if row[0] == "f"], int) - 1
    points, triangles = halved(points, faces[:, :, 0])
    uv, corners = halved(uv, faces[:, :, 1])
    of_point = np.zeros(len(points), int)
    of_point[triangles] = corners
    return Object(SCALE * points, triangles, sampled(picture / 255, uv[of_point])), uv, corners


def halved(points: np.ndarray, triangles: np.ndarray) -> shapes.Shape:
    """Splits each triangle into four at the middles of its edges."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    unique, number = np.unique(edges, axis=0, return_inverse=True)
    ab, bc, ca = (number.reshape(-1) + len(points)).reshape(3, -1)
    a, b, c = triangles.T
    parts = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return (np.concatenate([points, points[unique].mean(axis=1)]),
            np.concatenate([np.stack(part, axis=1) for part in parts]))


def sampled(picture: np.ndarray, uv: np.ndarray) -> np.ndarray:
    """Bilinear; v points up."""
    size = np.array(picture.shape[1::-1])
    place = np.clip(np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1) * size - 0.5, 0, size - 1.001)
    (left, top), (right, low) = place.astype(int).T, (place % 1).T[:, :, None]
    upper = picture[top, left] * (1 - right) + picture[top, left + 1] * right
    lower = picture[top + 1, left] * (1 - right) + picture[top + 1, left + 1] * right
    return (upper * (1 - low) + lower * low)[:, :3]


def write_textured(path: pathlib.Path, made: Object, uv: np.ndarray, corners: np.ndarray) -> None:
    """Writes an OBJ file in units of the original model."""
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in (made.points_mm / SCALE).tolist()]
    rows += [f"vt {u!r} {v!r}" for u, v in uv.tolist()]
    rows += ["f " + " ".join(f"{p + 1}/{t + 1}" for p, t in zip(*face)) for face in zip(made.triangles, corners)]
    path.write_text("\n".join(rows) + "\n", encoding="ascii")


def moved(pose: Pose, middle_mm: np.ndarray, rng: np.random.Generator, sd_mm: float, turn_deg: float) -> Pose:
    """Shifts a pose by a normal amount in x and y, and turns it about a random line through the object's middle."""
    rotation = shapes.after(shapes.about_line(rng.normal(size=3), np.radians(turn_deg)), pose.rotation)
    stays = (shapes.rotation(pose.rotation) - shapes.rotation(rotation)) @ middle_mm
    return Pose(rotation, pose.xy_mm + stays[:2] + rng.normal(scale=sd_mm, size=2))


def combined(layers: list[np.ndarray]) -> np.ndarray:
    """Amounts of ink of all layers add up."""
    return np.clip(1 - sum(1 - layer for layer in layers), 0, 1)


class Worker:
    """Runs hydroprint-worker on one object, in a folder."""

    def __init__(self, program: pathlib.Path, folder: pathlib.Path, made: Object, texture: pathlib.Path):
        self.program, self.folder, self.made, self.texture = program, folder, made, texture
        self.mesh = folder / "spot.obj"

    def run(self, verb: str, name: str, *options: object) -> pathlib.Path:
        out = self.folder / name
        command = [self.program, verb, "--mesh", self.mesh, *options, "--threads", 2, "--out", out]
        done = subprocess.run([str(part) for part in command], capture_output=True, text=True, check=False)
        if done.returncode != 0:
            raise RuntimeError(f"{verb} ended with {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")
        return out

    def plan(self, name: str, blend_mm: float, poses: list[Pose]) -> pathlib.Path:
        dips = self.folder / "dips.json"
        dips.write_text(json.dumps([pose.written() | {"depth_mm": "full"} for pose in poses]))
        return self.run("plan", name, "--texture", self.texture, "--scale", SCALE, "--immersions", dips, *FILM, "--blend-mm",
                        blend_mm)

    def pose_file(self, pose: Pose) -> pathlib.Path:
        path = self.folder / "pose.json"
        path.write_text(json.dumps(pose.written()))
        return path

    def film_of_dip(self, plan: pathlib.Path, number: int, pose: Pose) -> pathlib.Path:
        return self.run("simulate", "dip", "--texture", self.texture, "--plan", plan, "--immersion", number, "--pose",
                        self.pose_file(pose))

    def landed(self, film: pathlib.Path, pose: Pose) -> np.ndarray:
        """Colours of a film on the points of the object, 0 to 1; white where none lands."""
        out = self.run("predict", "landed", "--film-image", film, "--scale", SCALE, "--pose", self.pose_file(pose), *FILM)
        points = ply.read(out / "landed.ply")
        own = points.vertices[:len(self.made.points_mm)]
        if np.abs(points.points_mm[:len(own)] - self.made.points_mm).max() > 1e-3:
            raise RuntimeError("landed.ply does not begin with the points of the mesh")
        rgb = np.stack([own[channel] for channel in ("red", "green", "blue")], axis=1) / 255
        return np.where(own["landed"][:, None] > 0, rgb, 1.0)


@dataclass(frozen=True)
class Place:
    """The points that are judged, and their areas."""
    chosen: np.ndarray
    areas_mm2: np.ndarray
    calm: np.ndarray  # of the judged points: no film is stretched more than CALM there
    dip: np.ndarray  # of all points

    @staticmethod
    def of(plan: ply.Mesh, made: Object) -> Place:
        """Points that a dip prints, near the seam."""
        count = len(made.points_mm)
        seam = claims.seam_points_mm(plan)
        seam = seam[np.isfinite(seam).all(axis=1)]  # without those at the end of a film's reach
        near = np.concatenate([np.linalg.norm(part[:, None] - seam[None], axis=2).min(axis=1) <= NEAR_MM
                               for part in np.array_split(made.points_mm, 100)])
        dip = plan.vertices["dip"][:count]
        vertices = np.zeros(count, [(axis, "f8") for axis in "xyz"])
        for axis, values in zip("xyz", made.points_mm.T):
            vertices[axis] = values
        areas = claims.point_areas_mm2(ply.Mesh(vertices, made.triangles))
        chosen = near & (dip > 0)
        calm = (claims.columns(plan, "stretch")[:count][chosen] < CALM).all(axis=1)
        return Place(chosen, areas[chosen], calm, dip)


def errors_of_draw(worker: Worker, plans: dict[str, pathlib.Path], measured: list[Pose], true: list[Pose],
                   place: Place) -> dict[str, np.ndarray]:
    """CIEDE2000 at the judged points, for each width of the blend: of the picture, and of a plain dark one, which has no
    misplaced edges. `picture`: if each point had only the complete film of its own dip, which has no seam to blend."""
    films: dict[str, list[np.ndarray]] = {name: [] for name in plans}
    complete, weights = [], []
    for number, (seen, real) in enumerate(zip(measured, true), 1):
        masks = []
        for name, plan in plans.items():
            dip = worker.film_of_dip(plan, number, seen)
            films[name].append(worker.landed(dip / "film.png", real))
            masks.append(png.read(dip / "mask.png")[:, :, 0])
        complete.append(worker.landed(dip / "complete.png", real))
        png.write(worker.folder / "masks.png", 255 - np.stack([*masks, masks[0]], axis=2))  # the weights as ink, a channel each
        weights.append(1 - worker.landed(worker.folder / "masks.png", real))
    own = np.where((place.dip == 1)[:, None], *complete)
    out = {"picture": differences(own, worker.made.colours, place)}
    for channel, name in enumerate(plans):
        out[name] = differences(combined(films[name]), worker.made.colours, place)
        plain = [1 - weight[:, channel, None] * (1 - DARK) for weight in weights]
        out[f"plain_{name}"] = differences(combined(plain), np.broadcast_to(DARK, plain[0].shape[:1] + (3,)), place)
    return out


def differences(found: np.ndarray, wanted: np.ndarray, place: Place) -> np.ndarray:
    return colour.ciede2000(colour.lab(found[place.chosen]), colour.lab(wanted[place.chosen]))


def figures(errors: dict[str, np.ndarray], place: Place) -> dict[str, float]:
    """Shares of the area over all draws, which are rows of each array. seam_share: without the points where the picture
    itself is visibly misplaced. calm_share: of the calm points."""
    areas = np.broadcast_to(place.areas_mm2, errors["picture"].shape)
    misplaced = errors["picture"] > VISIBLE
    out = {"share_picture": share(misplaced, areas)}
    for name in (prefix + blend for prefix in ("", "plain_") for blend in BLENDS_MM):
        found = errors[name]
        order = np.argsort(found, axis=None)
        reached = np.cumsum(areas.reshape(-1)[order]) / areas.sum()
        out |= {f"share_{name}": share(found > VISIBLE, areas),
                f"p95_{name}": float(found.reshape(-1)[order][np.searchsorted(reached, 0.95)]),
                f"max_{name}": float(found.max())}
        if name in BLENDS_MM:
            out[f"seam_share_{name}"] = share((found > VISIBLE) & ~misplaced, areas)
        else:
            out[f"calm_share_{name}"] = share(found[:, place.calm] > VISIBLE, areas[:, place.calm])
    for kind in ("share", "seam_share", "share_plain", "calm_share_plain"):
        blended = out[f"{kind}_blended"]
        out[f"{kind}_ratio"] = out[f"{kind}_unblended"] / blended if blended > 0 else float("inf")
    return out


def share(chosen: np.ndarray, areas_mm2: np.ndarray) -> float:
    return float(areas_mm2[chosen].sum() / areas_mm2.sum())


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("worker", type=pathlib.Path)
    parser.add_argument("spot", type=pathlib.Path, help="folder of the model")
    parser.add_argument("--draws", type=int, default=20)
    parser.add_argument("--error", type=float, default=1, help="factor of the errors of the poses")
    return parser.parse_args()


def main() -> None:
    options = arguments()
    texture = options.spot / "spot_texture.png"
    made, uv, corners = read_textured(options.spot / "spot_triangulated.obj", png.read(texture))
    rng = np.random.default_rng(SEED)
    found: dict[str, list[np.ndarray]] = {}
    with tempfile.TemporaryDirectory() as folder:
        worker = Worker(options.worker, pathlib.Path(folder), made, texture)
        write_textured(worker.mesh, made, uv, corners)
        nominal = [Pose(rotation, -(shapes.rotation(rotation) @ made.middle_mm)[:2]) for rotation in SIDES]
        plans = {name: worker.plan(name, blend_mm, nominal) for name, blend_mm in BLENDS_MM.items()}
        place = Place.of(ply.read(plans["blended"] / "plan.ply"), made)
        for _ in range(options.draws):
            measured = [moved(pose, made.middle_mm, rng, 1.0, abs(rng.normal())) for pose in nominal]
            true = [moved(pose, made.middle_mm, rng, 0.5 * options.error, 0.5 * options.error) for pose in measured]
            for name, errors in errors_of_draw(worker, plans, measured, true, place).items():
                found.setdefault(name, []).append(errors)
    print(json.dumps({"row": "seams", **figures({name: np.stack(errors) for name, errors in found.items()}, place),
                      "draws": options.draws, "points": int(place.chosen.sum()), "area_mm2": float(place.areas_mm2.sum())}))


if __name__ == "__main__":
    main()
