#!/usr/bin/env python3
"""Judges how hydroprint-worker dips any mesh: areas of sections, coverage, time and memory. See ../README.md."""
from __future__ import annotations

import argparse
import json
import pathlib
import sys
import tempfile

import bodies  # first: makes ../plan importable
import claims
import runs
from areas import Sections
from bodies import Body
from claims import Claim, Outcome

import closed_form
import png

LONGER = 1.5  # the worker is stopped after this many times the allowed processor time


def finished_claims(name: str, body: Body, folder: pathlib.Path, small: bool) -> list[Claim]:
    """The claims about the artifacts of a finished run."""
    try:
        report = json.loads((folder / "report.json").read_text())["flow"]
        if body.kind == bodies.HOLLOW:
            return claims.of_hollow(report, png.read(folder / "film.png"))
        if body.kind == bodies.OPEN:
            return []
        out = claims.of_sections(report, Sections(body.posed(body.shape if body.solid is None else body.solid)))
        if name.startswith("doubled"):
            surface = runs.read_surface(folder / "surface_map.ply")
            most = claims.MAP_RMS_SMALL_MM if small else claims.MAP_RMS_MM
            sphere = closed_form.Sphere(bodies.SPHERE_MM, bodies.SPHERE_FILM_MM)
            out += claims.of_exact_map(surface.points, surface.film, sphere, most)
        if name in bodies.ELLIPSOIDS:
            surface = runs.read_surface(folder / "surface_map.ply")
            outer = ~bodies.within_ellipsoids(surface.points / body.scale, name)
            least = claims.COVERAGE if name == "figure" else 0.0
            out += claims.of_coverage(report, (surface.points, surface.triangles), surface.film, outer, least)
        return out
    except (OSError, KeyError, TypeError, ValueError, StopIteration) as error:
        return [claims.not_so("artifacts cannot be read", True, repr(error))]


def judge(name: str, options: argparse.Namespace, folder: pathlib.Path) -> tuple[Body, Outcome, list[Claim]]:
    body = bodies.body(name, options.small)
    limits = claims.LATTICE if body.kind == bodies.LATTICE else claims.SOLID
    outcome = runs.run(options.worker, body, folder, LONGER * limits.seconds, options.timeout_s)
    found = claims.of_end(outcome, limits)
    if name == "flat-plate":
        found += claims.of_flat_plate(outcome)
    if name in ("doubled", "doubled-same", "figure"):
        found.append(claims.not_so("not finished", not outcome.finished))
    if outcome.finished:
        found += finished_claims(name, body, folder / "print", options.small)
    return body, outcome, found


def show(name: str, body: Body, outcome: Outcome, found: list[Claim]) -> None:
    for claim in found:
        print(f"{'ok  ' if claim.holds else 'FAIL'}  {name}: {claim}")
    ending = "no end" if outcome.killed else "finished" if outcome.finished else f"exit status {outcome.status}"
    print(f"      {name}: {len(body.shape[1])} triangles, {ending}, last stage {(outcome.stages or ('none',))[-1]}",
          flush=True)


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worker", type=pathlib.Path, required=True, help="the program hydroprint-worker")
    parser.add_argument("--body", choices=bodies.BODIES, action="append", metavar="NAME",
                        help="only this body; may be repeated: " + ", ".join(bodies.BODIES))
    parser.add_argument("--small", action="store_true", help="coarse versions of the quick bodies")
    parser.add_argument("--timeout-s", type=float, default=600, help="stop the worker after this time (default 600)")
    parser.add_argument("--keep", type=pathlib.Path, help="new folder for the files, which are otherwise deleted")
    return parser.parse_args()


def judge_bodies(options: argparse.Namespace, folder: pathlib.Path) -> int:
    status = 0
    for name in options.body or (bodies.QUICK if options.small else bodies.BODIES):
        try:
            body, outcome, found = judge(name, options, folder / name)
        except runs.WorkerFailed as error:
            print(f"{name}: not run: {error}", file=sys.stderr, flush=True)
            status = 2
            continue
        show(name, body, outcome, found)
        if status == 0 and not all(claim.holds for claim in found):
            status = 1
    return status


def main() -> int:
    options = arguments()
    if options.keep:
        options.keep.mkdir()
        return judge_bodies(options, options.keep)
    with tempfile.TemporaryDirectory() as folder:
        return judge_bodies(options, pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
