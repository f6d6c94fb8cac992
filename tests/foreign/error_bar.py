#!/usr/bin/env python3
"""Judges the stated error of the film map (`error_mm` in surface_map.ply). See README.md, `error bar`.

    error_bar.py MAP REFERENCE              two maps of one object at one pose; the second one in a finer setting
    error_bar.py --worker WORKER [--small]  runs `simulate` on bodies of its own
    error_bar.py --self-test                exact and falsified maps

A point is judged if MAP states a bound there and both maps have film there, except where the map jumps. These points are counted.
It jumps where an edge at the point is longer on the film than four times its length on the object and 0.05 mm, in either
map. Film that is compressed to a quarter has wrinkled, or comes from two places.
"""
from __future__ import annotations

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import unittest
from dataclasses import dataclass, replace
from typing import Iterator

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent / "sections"))
import solids  # first: makes plan importable
from bodies import turn
from claims import Claim

import closed_form
import ply
import shapes

SHARE = (0.90, 0.995)  # of the points that the stated error has to cover
MEDIAN_RATIO = 6.0  # stated by true
SMALL_MM = 0.02  # a quarter of a pixel at 300 dpi: a stated median below is small enough, however small the true one is
LEAST_JUDGED = 0.25  # share of the points with a bound
STRETCH_OFF = 0.02  # median relative difference of a singular value
JUMP_RATIO, JUMP_MM = 4.0, 0.05
TURN_RAD, TURNED_SHARE = np.radians(37), 0.95
TURN_BACK = np.array([(np.cos(TURN_RAD), -np.sin(TURN_RAD)), (np.sin(TURN_RAD), np.cos(TURN_RAD))])  # of rows (x, y)
FILM_MM = 105.0
EXACT_UP_TO_DEG, BOUND_UP_TO_DEG, UNBOUND = 150, 60, 0.01  # of a sphere, whose film does not tear below 60 degrees
TIGHT_MM, LOOSE_MM = 0.005, 0.05  # tolerances: the smallest one that is accepted, and one for the report


class NothingToJudge(Exception):
    """The worker did not run, or a map has no stated error."""


@dataclass
class Surface:
    """surface_map.ply. Film and all columns are NaN where no film arrives; the error is infinite without a bound."""
    points: np.ndarray
    triangles: np.ndarray
    film: np.ndarray
    stretch: np.ndarray
    stretch_min: np.ndarray
    error: np.ndarray

    @property
    def reached(self) -> np.ndarray:
        return np.isfinite(self.film).all(axis=1)

    @property
    def bounded(self) -> np.ndarray:
        return self.reached & np.isfinite(self.error)


def read(path: pathlib.Path) -> Surface:
    try:
        mesh = ply.read(path)
        x, y, *columns = (mesh.vertices[name].astype(float)
                          for name in ("film_x", "film_y", "stretch", "stretch_min", "error_mm"))
    except (OSError, ValueError, KeyError) as error:
        raise NothingToJudge(f"{path}: {error}") from error
    return Surface(mesh.points_mm, mesh.triangles, np.stack([x, y], axis=1), *columns)


def partners(points: np.ndarray, others: np.ndarray) -> np.ndarray:
    """For each point, the index of the other point at the same place, or -1. Maps may be subdivided differently."""
    if points.shape == others.shape and np.abs(points - others).max(initial=0) < 1e-9:
        return np.arange(len(points))
    place = np.unique(np.round(np.concatenate([others, points]), 6), axis=0, return_inverse=True)[1].reshape(-1)
    first = np.full(place.max(initial=0) + 1, -1)
    first[place[:len(others)]] = np.arange(len(others))
    return first[place[len(others):]]


def jumps(surface: Surface) -> np.ndarray:
    """Points at which the map jumps; see the rule at the top."""
    out = np.zeros(len(surface.points), bool)
    for corners in ([0, 1], [1, 2], [2, 0]):
        ends = surface.triangles[:, corners]
        film_mm, object_mm = (np.linalg.norm(places[ends[:, 1]] - places[ends[:, 0]], axis=1)
                              for places in (surface.film, surface.points))
        out[ends[film_mm > JUMP_RATIO * object_mm + JUMP_MM]] = True
    return out


def singular_values(surface: Surface) -> tuple[np.ndarray, np.ndarray]:
    """Largest and smallest singular value of the map from film to object: of each triangle by eq. (6), and at a point the
    mean over the triangles around it. NaN if one of them has a corner without film, or has no area on the film."""
    p, q = surface.film[surface.triangles], surface.points[surface.triangles]
    a, b = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
    u, v = q[:, 1] - q[:, 0], q[:, 2] - q[:, 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        double_area = (a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0])[:, None]
        along_x, along_y = (u * b[:, 1:] - v * a[:, 1:]) / double_area, (v * a[:, :1] - u * b[:, :1]) / double_area
        xx, xy, yy = ((m * n).sum(axis=1) for m, n in ((along_x, along_x), (along_x, along_y), (along_y, along_y)))
        largest = np.sqrt((xx + yy + np.hypot(xx - yy, 2 * xy)) / 2)
        smallest = np.linalg.norm(np.cross(along_x, along_y), axis=1) / largest
        corners, size = surface.triangles.reshape(-1), len(surface.points)
        count = np.bincount(corners, minlength=size)
        means = [np.bincount(corners, np.repeat(values, 3), size) / count for values in (largest, smallest)]
    return tuple(np.where(np.isfinite(means).all(axis=0), means, np.nan))


def share_of(chosen: np.ndarray, among: np.ndarray) -> float:
    """NaN, with which no claim holds, if there is nothing to choose from."""
    return float((chosen & among).sum() / among.sum()) if among.any() else float("nan")


def median(values: np.ndarray) -> float:
    return float(np.median(values)) if values.size else float("nan")


def of_cover(off_mm: np.ndarray, error_mm: np.ndarray, share: tuple[float, float], truth: str) -> list[Claim]:
    """The stated errors cover the true ones, and are not much larger."""
    covered = share_of(off_mm <= error_mm, np.isfinite(off_mm))
    true_mm, stated_mm = median(off_mm), median(error_mm)
    ratio = stated_mm / true_mm if true_mm > 0 else float("nan")
    note = f"{stated_mm:.3g} mm stated, {true_mm:.3g} mm true, {len(off_mm)} points"
    claims = [Claim(f"share of points covered, {truth}", covered, share[0], at_least=True, note=note)]
    if stated_mm <= SMALL_MM:
        return claims
    return [*claims, Claim(f"share of points covered, {truth}", covered, share[1]),
            Claim(f"median stated error by true median, {truth}", ratio, MEDIAN_RATIO, note=note)]


def of_columns(surface: Surface) -> list[Claim]:
    """What the columns of one map promise, whatever the truth is."""
    error, largest, smallest = surface.error, surface.stretch, surface.stretch_min
    without_film = np.isnan(surface.film[:, 0])
    counts = {
        "points where only one of film_x and error_mm is NaN": np.isnan(error) != without_film,
        "points where only one of film_x and film_y is finite": without_film == surface.reached,
        "points with an error of zero or less": error <= 0,
        "points with stretch or stretch_min alone": np.isfinite(largest) != np.isfinite(smallest),
        "points with stretch_min above stretch, or not positive": (smallest > largest * (1 + 1e-6)) | (smallest <= 0),
    }
    out = [Claim(what, float(wrong.sum()), 0) for what, wrong in counts.items()]
    for name, stated, expected in zip(("stretch", "stretch_min"), (largest, smallest), singular_values(surface)):
        known = np.isfinite(stated) & np.isfinite(expected)
        out.append(Claim(f"{name} off the triangles' singular values, median share",
                         median(np.abs(stated[known] / expected[known] - 1)), STRETCH_OFF, note=f"{known.sum()} points"))
    return out


def of_maps(surface: Surface, reference: Surface, share: tuple[float, float]) -> list[Claim]:
    """The map against one of a finer setting, and its columns."""
    partner = partners(surface.points, reference.points)
    both = surface.bounded & (partner >= 0) & reference.reached[partner]
    off = np.linalg.norm(surface.film - reference.film[partner], axis=1)
    apart = both & (jumps(surface) | jumps(reference)[partner])
    judged = both & ~apart
    note = f"no bound at {share_of(~surface.bounded, surface.reached):.3g} of the points; left out: {apart.sum()} at jumps"
    return [Claim("share of bounded points that are judged", share_of(judged, surface.bounded), LEAST_JUDGED, True, note),
            *of_cover(off[judged], surface.error[judged], share, "reference"), *of_columns(surface)]


def exact_film(points: np.ndarray, radius_mm: float) -> tuple[np.ndarray, np.ndarray]:
    """Contact angle and film point of places on a sphere around the origin, in the middle of a round film; frame F."""
    theta = np.arccos(np.clip(-points[:, 2] / np.linalg.norm(points, axis=1), -1, 1))
    across = points[:, :2] / np.maximum(np.linalg.norm(points[:, :2], axis=1), 1e-9)[:, None]
    return theta, closed_form.Sphere(radius_mm, FILM_MM).film_radius_mm(theta)[:, None] * across


def of_exact(surface: Surface, rotation: np.ndarray, radius_mm: float, share: tuple[float, float]) -> list[Claim]:
    """The map of a sphere against the exact one."""
    theta, exact = exact_film(surface.points @ rotation.T, radius_mm)
    on_sphere = np.abs(np.linalg.norm(surface.points, axis=1) - radius_mm) < 1e-3  # the worker divides large triangles
    judged = surface.bounded & on_sphere & (theta <= np.radians(EXACT_UP_TO_DEG))
    off = np.linalg.norm(surface.film - exact, axis=1)
    return [Claim(f"share of points up to {BOUND_UP_TO_DEG} degrees without a bound",
                  share_of(~surface.bounded, on_sphere & (theta <= np.radians(BOUND_UP_TO_DEG))), UNBOUND),
            *of_cover(off[judged], surface.error[judged], share, "exact map")]


def of_turned(surface: Surface, turned: Surface) -> list[Claim]:
    """The same body in a round film, turned with its place about the film's middle."""
    partner = partners(surface.points, turned.points)
    off = np.linalg.norm(surface.film - turned.film[partner] @ TURN_BACK, axis=1)
    judged = surface.bounded & (partner >= 0) & turned.bounded[partner] & ~jumps(surface) & ~jumps(turned)[partner]
    share = share_of(off <= surface.error + turned.error[partner], judged)
    return [Claim("share of points within both stated errors, turned", share, TURNED_SHARE, True,
                  f"median difference {median(off[judged]):.3g} mm, {judged.sum()} points")]


def of_tight(surface: Surface, report: dict) -> list[Claim]:
    """The report says that a tolerance was not reached."""
    above = share_of(surface.error > TIGHT_MM, surface.bounded)
    warned = any("tolerance" in f"{warning['code']} {warning['message']}".lower() for warning in report["run"]["warnings"])
    wrong = float(above > 0.05 and not warned)
    return [Claim("tolerance exceeded without a warning", wrong, 0, note=f"exceeded at {above:.3g} of the points")]


def stated_95_mm(report: dict) -> float:
    """The 95 % error: the one value whose keys contain `error` and `95`; NaN if there is not exactly one."""
    pairs = [*report.items(), *((f"{block}.{key}", value) for block, rows in report.items() if isinstance(rows, dict)
                                for key, value in rows.items())]
    found = [float(value) for key, value in pairs if "error" in key and "95" in key]
    return found[0] if len(found) == 1 else float("nan")


@dataclass(frozen=True)
class Body:
    """A closed mesh, mm, and its pose. radius_mm: of a sphere in the middle of the film."""
    shape: shapes.Shape
    rotation: np.ndarray
    place_mm: tuple[float, float] = (0.0, 0.0)
    film: str = f"circle:{FILM_MM:g}"
    radius_mm: float | None = None

    def turned(self) -> Body:
        """Turned about the middle of the film."""
        place = complex(*self.place_mm) * np.exp(1j * TURN_RAD)
        rotation = shapes.after(shapes.about(2, TURN_RAD), self.rotation)
        return replace(self, rotation=rotation, place_mm=(place.real, place.imag))


def board(steps: int) -> shapes.Shape:
    """80 x 60 x 8 mm with fillets of 2 mm, as CAD exports it: the flat faces are two triangles each."""
    half, fillet = np.array([40.0, 30.0, 4.0]), 2.0
    out = fillet * np.tan(np.linspace(0, np.pi / 4, steps))
    lines = [np.concatenate([-out[::-1] - side, side + out]) for side in half - fillet]
    points, triangles = solids.blocks(lines, np.ones((2 * steps - 1,) * 3, bool))
    core = np.clip(points, fillet - half, half - fillet)
    return core + fillet * (points - core) / np.linalg.norm(points - core, axis=1)[:, None], triangles


def body_of(name: str, seed: int, small: bool) -> Body:
    rng = np.random.default_rng(seed)
    level, azimuth, a, b = 4 if small else 5, rng.uniform(0, 360), rng.uniform(8, 16), rng.uniform(18, 30)
    tilted = turn((2, azimuth), (0, b), (1, a))
    d, triangles = shapes.icosphere(1, level)
    if name == "box":  # a superellipsoid
        radii_mm = ((d / np.array([30.0, 22.0, 15.0])) ** 4).sum(axis=1) ** -0.25
        return Body((d * radii_mm[:, None], triangles), tilted, (8.0, -5.0), "A4")
    if name == "blob":  # spherical harmonics of degrees 2 to 5: Legendre polynomials about random axes
        axes, heights = rng.normal(size=(4, 3)), np.diag(rng.uniform(0.06, 0.12, 4))
        cosines = d @ (axes / np.linalg.norm(axes, axis=1)[:, None]).T
        lumps = sum(np.polynomial.legendre.legval(cosines[:, i], [0, 0, *heights[i]]) for i in range(4))
        return Body((d * (26 + 26 * lumps)[:, None], triangles), tilted, (10.0, 6.0))
    if name == "board":  # standing, a corner first
        return Body(board(3 if small else 5), turn((0, 90), (1, a), (0, a / 2), (2, azimuth)))
    if name == "ring":  # closes around film
        return Body(solids.torus(28, 9, 96, 32), turn((0, 15 + b), (2, azimuth)), film="A4")
    if name == "beside":
        return Body((30 * d, triangles), tilted, (a + 8, -b))
    radius_mm = 12.0 if small else 40.0  # the triangles differ from the sphere by much less than the map's errors
    return Body(shapes.icosphere(radius_mm, level + 1), tilted, radius_mm=radius_mm)


BODIES = ("box", "board", "blob", "ring", "beside", "sphere")
SMALL, TURNED = ("box", "blob", "sphere"), ("board", "blob", "beside")  # TURNED: in a round film


def simulate(options: argparse.Namespace, body: Body, model: str, folder: pathlib.Path,
             *more: str) -> subprocess.CompletedProcess:
    mesh, pose = folder.with_suffix(".obj"), folder.with_suffix(".json")
    rows = [f"v {x!r} {y!r} {z!r}" for x, y, z in body.shape[0].tolist()]
    mesh.write_text("\n".join(rows + [f"f {a} {b} {c}" for a, b, c in (body.shape[1] + 1).tolist()]) + "\n")
    pose.write_text(json.dumps({"rotation_wxyz": body.rotation.tolist(), "translation_mm": [*body.place_mm, 0]}))
    command = [options.worker, "simulate", "--mesh", mesh, "--pose", pose, "--film", body.film, "--model", model,
               "--artifacts", "map", "--threads", "1", "--out", folder, *more,
               *(["--ink-passes", "0"] if body.radius_mm and model == "sheet" else [])]
    try:
        return subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise NothingToJudge(f"{options.worker}: {error.strerror}") from error


def run(options: argparse.Namespace, body: Body, model: str, folder: pathlib.Path, *more: str) -> tuple[Surface, dict]:
    """Returns the map and the report."""
    done = simulate(options, body, model, folder, *more)
    if done.returncode != 0:
        raise NothingToJudge(f"{folder}: exit status {done.returncode}: {done.stderr.strip()}")
    return read(folder / "surface_map.ply"), json.loads((folder / "report.json").read_text())


def of_bad_input(options: argparse.Namespace, body: Body, folder: pathlib.Path) -> Iterator[Claim]:
    for value in ("0", "nan", "0.004", "-1"):
        out = folder / f"bad{value.replace('.', '_')}"
        done = simulate(options, body, "stokes", out, "--tolerance-mm", value)
        lines = done.stderr.strip().splitlines()
        refused = done.returncode in (2, 3) and len(lines) == 1 and "--tolerance-mm" in lines[0] and not out.exists()
        yield Claim(f"--tolerance-mm {value} not refused in one line that names it, without a folder", float(not refused), 0,
                    note=f"exit status {done.returncode}, {' / '.join(lines)}")


def judge_maps(options: argparse.Namespace) -> Iterator[Claim]:
    yield from of_maps(*map(read, options.maps), options.share)


def judge_body(options: argparse.Namespace, name: str, model: str, folder: pathlib.Path) -> Iterator[Claim]:
    folder.mkdir(parents=True)
    body = body_of(name, options.seed, options.small)
    surface, report = run(options, body, model, folder / "map")
    if not (body.radius_mm and options.small):  # the exact map is the better reference
        reference, tight = run(options, body, model, folder / "reference", "--tolerance-mm", f"{TIGHT_MM:g}")
        yield from of_maps(surface, reference, options.share)
        yield from of_tight(reference, tight)
    if body.radius_mm:
        yield from of_exact(surface, shapes.rotation(body.rotation), body.radius_mm, options.share)
    if name in TURNED:
        yield from of_turned(surface, run(options, body.turned(), model, folder / "turned")[0])
    if name == "blob":
        loose = run(options, body, model, folder / "loose", "--tolerance-mm", f"{LOOSE_MM:g}")[1]
        yield Claim(f"95 % error in the report at --tolerance-mm {LOOSE_MM:g}", stated_95_mm(loose["flow"]),
                    stated_95_mm(report["flow"]))
        yield from of_bad_input(options, body, folder)


def synthetic() -> tuple[Surface, Surface]:
    """The exact map of a sphere with errors that its bound of 2.3 sigma covers at 93 % of the points, and a finer one."""
    rng = np.random.default_rng(7)
    points, triangles = shapes.icosphere(40, 4)
    theta, film = exact_film(points, 40)
    sigma = np.where(theta < np.radians(140), 0.004 * (1 + theta), np.nan)

    def surface(factor: float) -> Surface:
        noise = factor * sigma[:, None] * rng.normal(size=film.shape)
        out = Surface(points, triangles, film + noise, sigma, sigma, 2.3 * factor * sigma)
        return replace(out, **dict(zip(("stretch", "stretch_min"), singular_values(out))))
    return surface(1), surface(0.1)


def failed(found: list[Claim]) -> str:
    return "; ".join(claim.what for claim in found if not claim.holds)


class SelfTest(unittest.TestCase):
    def test_good_map_holds_and_falsified_ones_are_seen(self):
        good, finer = synthetic()
        first, last = (np.arange(len(good.points)) == place for place in (good.reached.argmax(), good.reached.argmin()))
        for what, bad in {
            "": {},
            "covered, reference": {"error": good.error / 2},
            "covered, exact map": {"film": good.film + 0.1},
            "median stated error by true median, exact map": {"error": 20 * good.error},
            "without a bound": {"error": good.error + np.inf},
            "zero or less": {"error": np.where(first, 0, good.error)},
            "film_x and error_mm": {"error": np.where(first, np.nan, good.error)},
            "only one of film_x and error_mm": {"error": np.where(last, 1, good.error)},
            "film_y": {"film": np.where(first[:, None] & [False, True], np.nan, good.film)},
            "stretch_min above stretch": {"stretch": good.stretch_min, "stretch_min": good.stretch},
            "alone": {"stretch_min": np.where(first, np.nan, good.stretch_min)},
            "stretch off": {"stretch": 1.03 * good.stretch},
            "stretch_min off": {"stretch_min": 0.97 * good.stretch_min},
        }.items():
            with self.subTest(what):
                surface = replace(good, **bad)
                found = failed(of_maps(surface, finer, SHARE) + of_exact(surface, np.eye(3), 40, SHARE))
                self.assertEqual(bool(found), bool(bad), found)
                self.assertIn(what, found)

    def test_singular_values_are_those_of_the_closed_form(self):
        surface, exact = synthetic()[0], closed_form.Sphere(40, FILM_MM)
        theta = np.clip(exact_film(surface.points, 40)[0], 0.1, 2.4)
        around = 40 * np.sin(theta) / exact.film_radius_mm(theta)
        self.assertLess(np.nanmedian(np.abs(surface.stretch / exact.stretch(theta) - 1)), 0.01)
        self.assertLess(np.nanmedian(np.abs(surface.stretch_min / around - 1)), 0.01)

    def test_jumps_and_partners_are_found(self):
        surface = synthetic()[0]
        self.assertEqual(jumps(surface).sum(), 0)
        surface.film[surface.points[:, 0] > 0] += 30
        self.assertTrue(0 < np.abs(surface.points[jumps(surface), 0]).max() < 5)
        order = np.random.default_rng(7).permutation(len(surface.points))[:1000]
        self.assertTrue((partners(surface.points[order], surface.points) == order).all())
        self.assertEqual((partners(surface.points, surface.points[order]) >= 0).sum(), 1000)

    def test_turned_map_is_turned_back_and_report_is_read_by_names(self):
        surface, other = synthetic()
        self.assertEqual(failed(of_turned(surface, replace(other, film=other.film @ TURN_BACK.T))), "")
        self.assertIn("turned", failed(of_turned(surface, other)))
        self.assertEqual(stated_95_mm({"stretch": {"p95": 2.0}, "error_mm": {"p50": 0.1, "p95": 0.3}}), 0.3)
        self.assertTrue(np.isnan(stated_95_mm({"stretch": {"p95": 2.0}})))

    def test_bodies_are_closed_and_face_outwards(self):
        for name in BODIES:
            shape = body_of(name, 1, True).shape
            self.assertEqual(solids.unpaired_edges(shape), 0, name)
            self.assertGreater(solids.volume_mm3(shape), 5e3, name)
            self.assertEqual(len(shape[0]) - len(shape[1]) // 2, 0 if name == "ring" else 2, name)


def show(case: str, found: Iterator[Claim]) -> int:
    """Prints claims as they come. Returns the exit status."""
    status = 0
    try:
        for claim in found:
            status |= not claim.holds
            print(f"{'ok  ' if claim.holds else 'FAIL'}  {case}: {claim}", flush=True)
    except NothingToJudge as error:
        print(f"{case}: nothing to judge: {error}", file=sys.stderr, flush=True)
        return 2
    return status


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description="Judges the stated error of the film map. See README.md, `error bar`.")
    parser.add_argument("maps", nargs="*", type=pathlib.Path, metavar="MAP REFERENCE", help="two files surface_map.ply")
    parser.add_argument("--worker", type=pathlib.Path, help="the program hydroprint-worker")
    parser.add_argument("--small", action="store_true", help="three coarse bodies under Stokes flow")
    parser.add_argument("--model", choices=("stokes", "sheet"), help="only this model")
    parser.add_argument("--body", choices=BODIES, action="append", help="only this body; may be repeated")
    parser.add_argument("--seed", type=int, default=1, help="of lumps, tilts and places (default 1)")
    parser.add_argument("--share", type=float, nargs=2, default=SHARE, metavar=("LEAST", "MOST"), help="of points covered")
    parser.add_argument("--keep", type=pathlib.Path, metavar="DIR", help="new folder for the files of the runs")
    parser.add_argument("--self-test", action="store_true", help="judge exact and falsified maps")
    options = parser.parse_args()
    if [bool(options.maps), bool(options.worker), options.self_test].count(True) != 1 or len(options.maps) not in (0, 2):
        parser.error("give two maps, or --worker, or --self-test")
    return options


def main() -> int:
    options = arguments()
    if options.self_test:
        unittest.main(argv=[sys.argv[0]])  # exits
    if options.maps:
        return show(str(options.maps[0]), judge_maps(options))
    models = [options.model] if options.model else ["stokes"] if options.small else ["stokes", "sheet"]
    names = options.body or (SMALL if options.small else BODIES)
    with tempfile.TemporaryDirectory() as folder:
        root = options.keep or pathlib.Path(folder)
        return max(show(f"{name}, {model}", judge_body(options, name, model, root / f"{name}-{model}"))
                   for model in models for name in names)


if __name__ == "__main__":
    sys.exit(main())
