#!/usr/bin/env python3
"""Judges how `hydroprint-worker inspect` reads models, against film.png and its own inputs. See ../README.md."""
from __future__ import annotations

import argparse
import json
import pathlib
import subprocess
import sys
import tempfile

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "plan"))  # closed form and reader of PNG

import cases
import claims
import glb
import inputs
from cases import Run
from claims import Claim

SMALL_RUNS = 8
REFUSED, BAD_USAGE = 3, 2  # exit statuses


class WorkerFailed(Exception):
    """The worker could not be run, or does not know its flags."""


def run(worker: pathlib.Path, words: list[str], folder: pathlib.Path) -> tuple[int, str]:
    """Runs the worker in a folder. Returns its exit status and the last line on stderr."""
    try:
        done = subprocess.run([str(worker), *words], cwd=folder, capture_output=True, check=False)
    except OSError as error:
        raise WorkerFailed(f"{worker}: {error.strerror}") from error
    last = (done.stderr.decode("utf-8", "replace").strip().splitlines() or [""])[-1]
    if done.returncode == BAD_USAGE:
        raise WorkerFailed(f"exit status {BAD_USAGE}: {last}")
    return done.returncode, last


def warnings_of(report: dict) -> list[str]:
    return [f"{each['code']}: {each['message']}" for each in report["warnings"]]


def read_result(folder: pathlib.Path) -> tuple[glb.Glb, dict]:
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    return glb.read((folder / "model.glb").read_bytes()), report


def judge_case(worker: pathlib.Path, each: Run, folder: pathlib.Path) -> list[Claim]:
    """Compares both verbs of the worker on one model. Their results are in the folder."""
    simulated = run(worker, ["simulate", *each.for_simulate, "--out", str(folder / "print")], each.folder)
    inspected = run(worker, ["inspect", *each.for_inspect, "--out", str(folder / "model")], each.folder)
    uncoloured = cases.ABOUT_THE_FILM.search(simulated[1]) is not None
    if simulated[0] not in (0, REFUSED):
        return [claims.must("simulated", False, f"exit status {simulated[0]}: {simulated[1]}")]
    if simulated[0] == REFUSED and not uncoloured:
        return claims.of_refusal(inspected, simulated)
    if inspected[0] != 0:
        return [claims.must("finished", False, f"exit status {inspected[0]}: {inspected[1]}")]
    model, report = read_result(folder / "model")
    out = claims.of_model(model, report)
    if uncoloured:
        out.append(claims.of_uncoloured(cases.model_colours(model.scene), warnings_of(report)))
    elif (folder / "print/film.png").exists():
        film = cases.film_colours(folder / "print/film.png")
        out.append(claims.of_colours(cases.model_colours(model.scene), film))
    return out


def judge_input(worker: pathlib.Path, name: str, seed: int, small: bool, folder: pathlib.Path) -> list[Claim]:
    """Judges one of the judge's own inputs."""
    made = inputs.INPUTS[name](folder, np.random.default_rng([seed, *name.encode()]), small)
    status, last = run(worker, ["inspect", "--mesh", str(made.mesh), "--out", str(folder / "model")], folder)
    if status != 0:
        return [claims.must("finished", False, f"exit status {status}: {last}")]
    model, report = read_result(folder / "model")
    return claims.of_model(model, report) + made.claims(model.scene, warnings_of(report))


def drawn(runs: list[Run], seed: int) -> list[Run]:
    """Some runs, each of another case."""
    random = np.random.default_rng(seed)
    folders = sorted({each.folder for each in runs})
    chosen = random.choice(len(folders), min(SMALL_RUNS, len(folders)), replace=False)
    of_folders = [[each for each in runs if each.folder == folders[n]] for n in sorted(chosen)]
    return [group[random.integers(len(group))] for group in of_folders]


def show(name: str, found: list[Claim], whole: bool) -> bool:
    """Prints the claims that do not hold, or all. Returns whether all hold."""
    for claim in found:
        if whole or not claim.holds:
            print(f"{'ok  ' if claim.holds else 'FAIL'}  {name}: {claim}", flush=True)
    if not whole and all(claim.holds for claim in found):
        print(f"ok    {name}: {len(found)} claims; {found[-1]}", flush=True)
    return all(claim.holds for claim in found)


def attempted(judgement, *arguments) -> list[Claim]:
    """The claims of a judgement, or one about a result that cannot be read."""
    try:
        return judgement(*arguments)
    except (OSError, KeyError, TypeError, ValueError) as error:
        return [claims.must("the result can be read", False, repr(error))]


def judge(options: argparse.Namespace) -> int:
    worker = options.worker.resolve()
    good = []
    runs, skipped = cases.read(options.cases)
    if not options.cases.is_dir():
        skipped.append(f"all cases: {options.cases} does not exist")
    for line in skipped:
        print(f"skip  {line}")
    for each in drawn(runs, options.seed) if options.small and runs else runs:
        with tempfile.TemporaryDirectory() as name:
            good.append(show(each.name, attempted(judge_case, worker, each, pathlib.Path(name)), False))
    for each in options.inputs:
        with tempfile.TemporaryDirectory() as name:
            found = attempted(judge_input, worker, each, options.seed, options.small, pathlib.Path(name))
            good.append(show(each, found, True))
    print(f"{sum(good)} hold, {len(good) - sum(good)} do not, {len(skipped)} skipped")
    return 0 if all(good) else 1


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("worker", type=pathlib.Path, nargs="?", help="the program hydroprint-worker")
    parser.add_argument("--cases", type=pathlib.Path, default=cases.FOLDER, help="default: ../shared/cases")
    parser.add_argument("--small", action="store_true", help=f"{SMALL_RUNS} runs of different cases, and the torus")
    parser.add_argument("--seed", type=int, default=1, help="of the drawn runs and of the judge's inputs (default 1)")
    parser.add_argument("--self-test", action="store_true", help="test the judge itself: falsified models must be noticed")
    options = parser.parse_args()
    options.inputs = list(inputs.SMALL if options.small else inputs.INPUTS)
    if options.worker is None and not options.self_test:
        parser.error("name the worker, or use --self-test")
    return options


def main() -> int:
    options = arguments()
    if options.self_test:
        import selftest
        return selftest.main()
    try:
        return judge(options)
    except WorkerFailed as error:
        print(f"not run: {error}", file=sys.stderr)
        return 2


if __name__ == "__main__":
    sys.exit(main())
