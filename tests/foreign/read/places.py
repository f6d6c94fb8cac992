#!/usr/bin/env python3
"""Runs the worker on one reading case, and prints where a picture of the model from below has which colour, as JSON. For
tests of the pages that show models. See ../README.md."""
from __future__ import annotations

import argparse
import json
import pathlib
import sys

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "plan"))  # closed form and reader of PNG

import cases
import claims
import judge


def run(worker: pathlib.Path, words: list[str], folder: pathlib.Path) -> None:
    status, last = judge.run(worker, words, folder)
    if status != 0:
        sys.exit(f"{words[0]}: exit status {status}: {last}")


def places(film: pathlib.Path, radius_mm: float) -> dict:
    colours = cases.film_colours(film)
    quadrants = [{"name": name, "points_mm": cases.landed_mm(cases.film_places(signs), radius_mm).tolist(),
                  "colour": colours[name].tolist()} for name, signs in cases.QUADRANTS.items()]
    return {"radius_mm": radius_mm, "levels": claims.LEVELS, "quadrants": quadrants}


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("worker", type=pathlib.Path, help="the program hydroprint-worker")
    parser.add_argument("name", help="of the run, such as '01-obj-vertex-rgba | rgba'")
    parser.add_argument("out", type=pathlib.Path, help="folder for the results: print/film.png, model/model.glb")
    parser.add_argument("--cases", type=pathlib.Path, default=cases.FOLDER, help="default: ../shared/cases")
    return parser.parse_args()


def main() -> None:
    options = arguments()
    worker, out = options.worker.resolve(), options.out.resolve()
    each = next((one for one in cases.read(options.cases)[0] if one.name == options.name), None)
    if each is None:
        sys.exit(f"{options.cases} has no run '{options.name}'")
    out.mkdir(parents=True, exist_ok=True)
    run(worker, ["simulate", *each.for_simulate, "--out", str(out / "print")], each.folder)
    run(worker, ["inspect", *each.for_inspect, "--out", str(out / "model")], each.folder)
    low, high = judge.read_result(out / "model")[0].scene.box
    print(json.dumps(places(out / "print/film.png", float(high[0] - low[0]) / 2)))


if __name__ == "__main__":
    main()
