#!/usr/bin/env python3
"""Judges how hydroprintd supervises a drive that fails. See ../README.md."""
from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import multiprocessing
import pathlib
import random
import sys

import faulty
import motions
import rows
from claims import Claim, of_row
from drive_profile import Timing
from session import NotStarted, Refused

WIRES = ("tcp", "rtu")
SMALL_ROWS, SMALL_MOTIONS = 4, 10  # on each wire


def judge_row(name: str, wire: str, options: argparse.Namespace) -> list[Claim]:
    row = rows.NAMES[name]
    try:
        return of_row(row, faulty.provoke(row, wire, options.daemon, options.seed))
    except (Refused, OSError) as error:
        return [Claim("the motion was accepted", False, str(error), "accepted")]


def show(title: str, found: list[Claim]) -> bool:
    print("\n".join(claim.line(title) for claim in found), flush=True)
    return all(claim.holds for claim in found)


def judge_wire(wire: str, names: list[str], options: argparse.Namespace) -> bool:
    """Everything on one wire, in turn."""
    good = True
    for name in names:
        good = show(f"{wire} {name}", judge_row(name, wire, options)) and good
    for bad in (False, True):
        if options.motions and not options.row:
            good = show(f"{wire} {'bad replies' if bad else 'good motions'}", motions.judge(wire, bad, options)) and good
    return good


def spin() -> None:
    while True:
        pass


@contextlib.contextmanager
def busy_processes(count: int):
    """Processes of normal priority that compute all the time."""
    processes = [multiprocessing.get_context("fork").Process(target=spin, daemon=True) for _ in range(count)]
    for process in processes:
        process.start()
    try:
        yield
    finally:
        for process in processes:
            process.kill()


def arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--daemon", type=pathlib.Path, default=pathlib.Path("build/release/bin/hydroprintd"),
                        help="the program hydroprintd (default build/release/bin/hydroprintd)")
    parser.add_argument("--row", action="append", choices=rows.NAMES, metavar="NAME", help="only this row; may be repeated")
    parser.add_argument("--wire", choices=(*WIRES, "both"), default="both")
    parser.add_argument("--motions", type=int, default=100, metavar="N",
                        help="good motions, and motions with a bad reply each, on each wire (default 100)")
    parser.add_argument("--only-motions", action="store_true", help="no rows")
    parser.add_argument("--response-timeout-s", type=float, default=Timing.response_timeout_s,
                        help=f"in the profile for motions (default {Timing.response_timeout_s:g})")
    parser.add_argument("--worst-delay-s", type=float, default=Timing.worst_delay_s,
                        help=f"in the profile for motions (default {Timing.worst_delay_s:g})")
    parser.add_argument("--busy", action="store_true", help="beside two processes that compute all the time")
    parser.add_argument("--small", action="store_true", help="a sample of the rows, and few motions")
    parser.add_argument("--seed", type=int, default=1, help="of the motions, of the bad replies, and of the sample")
    parser.add_argument("--list", action="store_true", help="print the rows and exit")
    return parser.parse_args()


def names_of(wire: str, options: argparse.Namespace) -> list[str]:
    names = options.row or ([] if options.only_motions else list(rows.NAMES))
    if options.small and not options.row:
        names = random.Random(f"{options.seed} {wire}").sample(names, min(SMALL_ROWS, len(names)))
    return names


def main() -> int:
    options = arguments()
    if options.list:
        for row in rows.ROWS:
            print(f"{row.name:34} {' or '.join(row.causes)}")
        return 0
    if options.small:
        options.motions = min(options.motions, SMALL_MOTIONS)
    wires = WIRES if options.wire == "both" else (options.wire,)
    with busy_processes(2 if options.busy else 0), concurrent.futures.ThreadPoolExecutor() as pool:
        jobs = [pool.submit(judge_wire, wire, names_of(wire, options), options) for wire in wires]
        try:
            return 0 if all([job.result() for job in jobs]) else 1
        except NotStarted as error:
            print(f"hydroprintd did not start: {error}", file=sys.stderr)
            return 2


if __name__ == "__main__":
    sys.exit(main())
