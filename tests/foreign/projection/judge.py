#!/usr/bin/env python3
"""Judges the projections of pictures by hydroprint-worker against their definition. See ../README.md."""
from __future__ import annotations

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "plan"))  # readers of PLY and PNG

import cases
import claims
import expected
import pictures
import solids
from cases import Case
from landing import Landing, landing
from solids import Solid

import ply
import png

DPI = 150
CAT = pathlib.Path(__file__).resolve().parents[4] / "shared/models/cat/cat-low-resolution.obj"


class WorkerFailed(Exception):
    """The worker did not make a print."""


def write_inputs(case: Case, solid: Solid, folder: pathlib.Path) -> list[str]:
    """Writes the input files. Returns the flags for them."""
    folder.mkdir()
    solids.write_stl(folder / "shape.stl", solid, binary=not case.text)
    for picture in case.pictures:
        pictures.write_png(folder / picture.name, picture.pixels())
    flags = ["--mesh", str(folder / "shape.stl")]
    if case.turn is not None:
        (folder / "pose.json").write_text(json.dumps(case.pose(solid)))
        flags += ["--pose", str(folder / "pose.json")]
    if case.flags is not None:
        return flags + ["--texture", str(folder / case.pictures[0].name), *case.flags]
    (folder / "paint.json").write_text(json.dumps(case.paint.json()))
    return flags + ["--paint", str(folder / "paint.json")]


def run(worker: pathlib.Path, case: Case, solid: Solid, folder: pathlib.Path) -> pathlib.Path:
    """Makes the print of a case. Returns its folder."""
    command = [str(worker), "simulate", *write_inputs(case, solid, folder), "--film", case.film.option, "--model",
               "stokes", "--ink-passes", "0", "--dpi", str(DPI), "--out", str(folder / "print")]
    if case.depth_mm is not None:
        command += ["--depth-mm", f"{case.depth_mm:g}"]
    try:
        done = subprocess.run(command, capture_output=True, text=True, check=False)
    except OSError as error:
        raise WorkerFailed(f"{worker}: {error.strerror}") from error
    if done.returncode != 0:
        raise WorkerFailed(f"exit status {done.returncode}: {done.stderr.strip()}")
    return folder / "print"


def read_landing(path: pathlib.Path) -> Landing:
    found = ply.read(path)
    film = np.stack([found.vertices["film_x"], found.vertices["film_y"]], axis=1).astype(float)
    times, stretch = (found.vertices[name].astype(float) for name in ("contact_time", "stretch"))
    return landing(found.points_mm, film, times, stretch, found.triangles)


def judge(case: Case, solid: Solid, folder: pathlib.Path) -> tuple[list[claims.Claim], dict[str, int]]:
    """The claims about the print in a folder, and the numbers of points left out."""
    try:
        found = read_landing(folder / "surface_map.ply")
        image = png.read(folder / "film.png")
        warnings = json.loads((folder / "report.json").read_text())["run"]["warnings"]
    except (OSError, KeyError, ValueError) as error:
        raise WorkerFailed(f"files of the print: {error!r}") from error
    result = claims.Print(solid, case.paint, case.rotation, case.film, DPI, found, image)
    out, reasons = claims.of_print(result)
    if case.warning:
        count = sum(warning["code"] == case.warning for warning in warnings)
        out.append(claims.Claim(f"warnings {case.warning} in the report", float(count), 1, at_least=True))
    return out, reasons


def show(case: Case, found: list[claims.Claim], reasons: dict[str, int]) -> None:
    for claim in found:
        limit = f"(at {'least' if claim.at_least else 'most'} {claim.limit:g})"
        print(f"{'ok  ' if claim.holds else 'FAIL'}  {case.name}: {claim.what}: {claim.measured:.6g} {limit}")
    print(f"      {case.name}: points left out: " + ", ".join(f"{reason} {count}" for reason, count in reasons.items()),
          flush=True)


def arguments() -> argparse.Namespace:
    names = [case.name for case in cases.FULL + cases.SMALL]
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--worker", type=pathlib.Path, help="the program hydroprint-worker")
    parser.add_argument("--case", choices=names, action="append", metavar="NAME",
                        help="only this case; may be repeated: " + ", ".join(names))
    parser.add_argument("--small", action="store_true", help="one small ball, all projections")
    parser.add_argument("--cat", type=pathlib.Path, default=CAT, help="OBJ file of the cat")
    parser.add_argument("--keep", type=pathlib.Path, help="new folder for the files, which are otherwise deleted")
    parser.add_argument("--write-expected", type=pathlib.Path, metavar="FILE",
                        help="only write expected picture coordinates")
    parser.add_argument("--seed", type=int, default=1, help="of the points for --write-expected")
    options = parser.parse_args()
    if not options.worker and not options.write_expected:
        parser.error("--worker or --write-expected is required")
    return options


def selected(options: argparse.Namespace) -> list[Case]:
    if options.case:
        return [case for case in cases.FULL + cases.SMALL if case.name in options.case]
    return cases.SMALL if options.small else cases.FULL


def judge_cases(options: argparse.Namespace, folder: pathlib.Path) -> int:
    status = 0
    found: dict[str, Solid | None] = {}
    for case in selected(options):
        if case.solid not in found:
            found[case.solid] = cases.SOLIDS[case.solid](options.cat)
        solid = found[case.solid]
        if solid is None:
            print(f"skip  {case.name}: {options.cat} is missing")
            continue
        try:
            result, reasons = judge(case, solid, run(options.worker, case, solid, folder / case.name))
        except WorkerFailed as error:
            print(f"{case.name}: no print: {error}", file=sys.stderr, flush=True)
            status = 2
            continue
        show(case, result, reasons)
        if status == 0 and not all(claim.holds for claim in result):
            status = 1
    return status


def main() -> int:
    options = arguments()
    if options.write_expected:
        expected.write(options.write_expected, options.seed)
        return 0
    if options.keep:
        options.keep.mkdir()
        return judge_cases(options, options.keep)
    with tempfile.TemporaryDirectory() as folder:
        return judge_cases(options, pathlib.Path(folder))


if __name__ == "__main__":
    sys.exit(main())
