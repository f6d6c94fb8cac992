#!/usr/bin/env python3
"""Judges the plans of hydroprint-worker against closed forms. See ../README.md."""
from __future__ import annotations

import argparse
import dataclasses
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

import claims
import closed_form
import ply
import png
import shapes
import turned

FILM_MM = 105.0
WIDTH_MM = 5.0
RED = (255, 0, 0)
TURN_OVER = shapes.about(0, np.pi)
TILTED = np.array([2.0, 1.0, 1.0])  # the line of the turn of `--turned`: neither vertical nor horizontal


class WorkerFailed(Exception):
    """The worker did not make a plan."""


def run_plan(worker: pathlib.Path, folder: pathlib.Path, shape: shapes.Shape, rotations: list[np.ndarray], dpi: int,
             more: tuple[str, ...] = ()) -> pathlib.Path:
    """Makes a plan of a plain red shape with full dips under Stokes flow. Returns its folder."""
    folder.mkdir()
    ply.write_coloured(folder / "shape.ply", *shape, RED)
    dips = [{"rotation_wxyz": q.tolist(), "translation_mm": [0, 0, 0], "depth_mm": "full"} for q in rotations]
    (folder / "dips.json").write_text(json.dumps(dips))
    command = [str(worker), "plan", "--mesh", str(folder / "shape.ply"), "--immersions", str(folder / "dips.json"),
               "--film", f"circle:{FILM_MM:g}", "--model", "stokes", "--ink-passes", "0", "--dpi", str(dpi),
               "--blend-mm", f"{WIDTH_MM:g}", "--out", str(folder / "plan"), *more]
    run(command)
    return folder / "plan"


def run(command: list[str]) -> None:
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise WorkerFailed(f"{command[0]}: {error.strerror}") from error
    if done.returncode != 0:
        raise WorkerFailed(f"{command[1]}: exit status {done.returncode}: {done.stderr.strip()}")


def run_second_dip(worker: pathlib.Path, folder: pathlib.Path, name: str, rotation: np.ndarray | None) -> pathlib.Path:
    """Computes dip 2 of the plan in a folder of run_plan() for another pose, or for the planned one by default. Returns
    the folder of its artifacts."""
    pose = folder / f"{name}.json"
    command = [str(worker), "simulate", "--mesh", str(folder / "shape.ply"), "--plan", str(folder / "plan"),
               "--immersion", "2", "--out", str(folder / name)]
    if rotation is not None:
        pose.write_text(json.dumps({"rotation_wxyz": rotation.tolist(), "translation_mm": [0, 0, 0]}))
        command += ["--pose", str(pose)]
    run(command)
    return folder / name


def judge_sphere(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    """A sphere whose equator is made of edges."""
    limits = claims.Limits(0.24, 1, 0.08, 0.02, 12) if options.small else claims.Limits()
    return sphere_claims(options, folder, np.eye(3), limits)


def judge_turned_sphere(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    """A sphere whose equator runs through its triangles."""
    limits = claims.Limits(0.24, 0.95, 0.08, 0.02, 12) if options.small else claims.Limits(seam_share=0.95)
    turn = shapes.rotation(shapes.between(np.array([3.0, 1.0, 2.0]), np.array([0.0, 0.0, 1.0])))
    return sphere_claims(options, folder, turn, limits)


def sphere_claims(options: argparse.Namespace, folder: pathlib.Path, turn: np.ndarray,
                  limits: claims.Limits) -> list[claims.Claim]:
    """The small mesh has edges twice as long, so that errors of second order are four times as large."""
    sphere = closed_form.Sphere(40, FILM_MM)
    dpi = 100 if options.small else 300
    points, triangles = shapes.icosphere(sphere.radius_mm, 4 if options.small else 5)
    plan = run_plan(options.worker, folder, (points @ turn.T, triangles), [shapes.about(0, 0), TURN_OVER], dpi)
    out = claims.of_sphere(ply.read(plan / "plan.ply"), sphere, WIDTH_MM, limits)
    if options.images:
        out += claims.of_sphere_film(png.read(plan / "film-1.png"), dpi, sphere, WIDTH_MM, limits)
    return out


def judge_cube(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    side_mm = 50.0
    upright = shapes.between(np.ones(3), np.array([0.0, 0.0, 1.0]))
    upside_down = shapes.between(np.ones(3), np.array([0.0, 0.0, -1.0]))
    plan = run_plan(options.worker, folder, shapes.box((side_mm,) * 3), [upright, upside_down], 72)
    return claims.of_cube(ply.read(plan / "plan.ply"), side_mm)


def judge_plate(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    size_mm = (60.0, 60.0, 1.5)
    tilt_rad = np.radians(20)
    rotations = [shapes.about(0, tilt_rad), shapes.about(0, tilt_rad + np.pi)]
    plan = run_plan(options.worker, folder, shapes.box(size_mm), rotations, 72)
    return claims.of_plate(ply.read(plan / "plan.ply"), size_mm, WIDTH_MM)


def judge_threads(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    points, triangles = shapes.icosphere(1, 3)
    shape = points * np.array([30.0, 22.0, 16.0]), triangles
    rotations = [shapes.about(1, 0.4), shapes.about(0, 2.5)]
    folder.mkdir()
    plans = [run_plan(options.worker, folder / n, shape, rotations, 72, ("--threads", n)) for n in ("1", "2", "8")]
    out = []
    for name in ("plan.json", "plan.ply", "mask-1.png", "film-1.png", "film-2.png", "combined.png"):
        contents = {(plan / name).read_bytes() for plan in plans}
        out.append(claims.Claim(f"{name} depends on the number of threads", float(len(contents) - 1), 0))
    return out


def judge_turned_dip(options: argparse.Namespace, folder: pathlib.Path) -> list[claims.Claim]:
    """Dip 2 of a sphere's plan at a pose that is turned from the planned one, and at the planned one."""
    limits, seam_mm, dpi = (claims.Limits(level=12), 0.24, 100) if options.small else (claims.Limits(), 0.1, 300)
    sphere = closed_form.Sphere(40, FILM_MM)
    shape = shapes.icosphere(sphere.radius_mm, 4 if options.small else 5)
    plan = run_plan(options.worker, folder, shape, [shapes.about(0, 0), TURN_OVER], dpi)
    rotation = shapes.after(shapes.about_line(TILTED, np.radians(options.turned)), TURN_OVER)
    dip = run_second_dip(options.worker, folder, "measured", rotation)
    images = turned.Images(*(png.read(dip / f"{name}.png") for name in ("film", "complete", "mask")))
    pole = shapes.rotation(rotation) @ np.array([0.0, 0.0, 1.0])
    out = turned.of_turned_dip(images, dpi, sphere, pole, WIDTH_MM, limits, seam_mm)
    out += turned.of_warnings(warnings_of(dip), options.turned)
    planned = png.read(plan / "film-2.png")
    for name, pose in (("planned", TURN_OVER), ("default", None)):
        dip = run_second_dip(options.worker, folder, name, pose)
        for claim in turned.of_same_film(png.read(dip / "film.png"), planned) + turned.of_warnings(warnings_of(dip), 0):
            out.append(dataclasses.replace(claim, what=f"{name} pose: {claim.what}"))
    return out


def warnings_of(folder: pathlib.Path) -> list[dict]:
    return json.loads((folder / "report.json").read_text())["run"]["warnings"]


CASES = {"sphere": judge_sphere, "turned": judge_turned_sphere, "cube": judge_cube, "plate": judge_plate, "threads": judge_threads}


def turn_deg(text: str) -> float:
    angle = float(text)
    if not 0 < angle <= turned.MOST_TURN_DEG:
        raise argparse.ArgumentTypeError(f"must be above 0 and at most {turned.MOST_TURN_DEG:g}")
    return angle


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worker", type=pathlib.Path, required=True, help="the program hydroprint-worker")
    parser.add_argument("--case", choices=CASES, action="append", help="only this case; may be repeated")
    parser.add_argument("--turned", type=turn_deg, metavar="DEGREES",
                        help="judge only `simulate --plan`, for a pose turned by this angle")
    parser.add_argument("--small", action="store_true", help="a coarser sphere and image, with wider limits")
    parser.add_argument("--no-images", dest="images", action="store_false", help="judge no film image")
    return parser.parse_args()


def main() -> int:
    options = arguments()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        cases = {"turned-dip": judge_turned_dip} if options.turned else {name: CASES[name] for name in options.case or CASES}
        for case, judge in cases.items():
            try:
                found = judge(options, pathlib.Path(folder) / case)
            except WorkerFailed as error:
                print(f"{case}: nothing to judge: {error}", file=sys.stderr)
                return 2
            for claim in found:
                failed |= not claim.holds
                print(f"{'ok  ' if claim.holds else 'FAIL'}  {case}: {claim.what}: {claim.measured:.6g} "
                      f"(at most {claim.limit:g})")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
