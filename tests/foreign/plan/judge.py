#!/usr/bin/env python3
"""Judges the plans of hydroprint-worker against closed forms. See ../README.md."""
from __future__ import annotations

import argparse
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

FILM_MM = 105.0
WIDTH_MM = 5.0
RED = (255, 0, 0)
TURN_OVER = shapes.about(0, np.pi)


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
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise WorkerFailed(f"{worker}: {error.strerror}") from error
    if done.returncode != 0:
        raise WorkerFailed(f"exit status {done.returncode}: {done.stderr.strip()}")
    return folder / "plan"


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


CASES = {"sphere": judge_sphere, "turned": judge_turned_sphere, "cube": judge_cube, "plate": judge_plate, "threads": judge_threads}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worker", type=pathlib.Path, required=True, help="the program hydroprint-worker")
    parser.add_argument("--case", choices=CASES, action="append", help="only this case; may be repeated")
    parser.add_argument("--small", action="store_true", help="a coarser sphere and image, with wider limits")
    parser.add_argument("--no-images", dest="images", action="store_false", help="judge no film image")
    return parser.parse_args()


def main() -> int:
    options = arguments()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for case in options.case or CASES:
            try:
                found = CASES[case](options, pathlib.Path(folder) / case)
            except WorkerFailed as error:
                print(f"{case}: no plan: {error}", file=sys.stderr)
                return 2
            for claim in found:
                failed |= not claim.holds
                print(f"{'ok  ' if claim.holds else 'FAIL'}  {case}: {claim.what}: {claim.measured:.6g} "
                      f"(at most {claim.limit:g})")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
