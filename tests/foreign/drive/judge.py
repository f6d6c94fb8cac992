#!/usr/bin/env python3
"""Judges how hydroprintd supervises a drive that fails. See ../README.md."""
from __future__ import annotations

import argparse
import concurrent.futures
import contextlib
import multiprocessing
import os
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
GOOD_MOTIONS, BAD_REPLIES, SMALL_MOTIONS = 100, 200, 10  # on each wire
NOT_POSSIBLE = 77  # exit status, which CTest reports as skipped
# One row of each on each wire.
SMALL_STATES = ((rows.REST, rows.UNHOMED), (rows.JOG,), (rows.HOME,), (rows.MOVE, rows.DIP))


def judge_row(name: str, wire: str, options: argparse.Namespace) -> list[Claim]:
    row = rows.NAMES[name]
    try:
        return of_row(row, faulty.provoke(row, wire, options.daemon, options.seed))
    except (Refused, OSError) as error:
        return [Claim("the motion was accepted", False, str(error), "accepted")]


def show(title: str, found: list[Claim]) -> bool:
    # In one piece, because the thread of the other wire writes, too.
    sys.stdout.write("".join(claim.line(title) + "\n" for claim in found))
    sys.stdout.flush()
    return all(claim.holds for claim in found)


def judge_wire(wire: str, names: list[str], options: argparse.Namespace) -> bool:
    """Everything on one wire, in turn."""
    good = True
    for name in names:
        good = show(f"{wire} {name}", judge_row(name, wire, options)) and good
    for what, count in (("good motions", options.motions), ("bad replies", options.bad_replies)):
        if count and not options.row:
            good = show(f"{wire} {what}", motions.judge(wire, what == "bad replies", count, options)) and good
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
    parser.add_argument("--row", action="append", choices=rows.NAMES, metavar="NAME",
                        help="only this row; may be repeated")
    parser.add_argument("--wire", choices=(*WIRES, "both"), default="both")
    parser.add_argument("--no-rows", action="store_true", help="only motions")
    parser.add_argument("--motions", type=int, metavar="N", help=f"good motions on each wire (default {GOOD_MOTIONS})")
    parser.add_argument("--bad-replies", type=int, metavar="N",
                        help=f"motions with one bad reply each, on each wire (default {BAD_REPLIES})")
    parser.add_argument("--response-timeout-s", type=float, default=Timing.response_timeout_s,
                        help=f"in the profile for motions (default {Timing.response_timeout_s:g})")
    parser.add_argument("--worst-delay-s", type=float, default=Timing.worst_delay_s,
                        help=f"in the profile for motions (default {Timing.worst_delay_s:g})")
    parser.add_argument("--busy", action="store_true",
                        help="beside two processes that compute all the time; exit status 77 without SCHED_FIFO")
    parser.add_argument("--small", action="store_true",
                        help=f"one row of each kind of state, and {SMALL_MOTIONS} motions by default")
    parser.add_argument("--seed", type=int, default=1, help="of the motions, of the bad replies, and of the sample")
    parser.add_argument("--list", action="store_true", help="print the rows and exit")
    options = parser.parse_args()
    if options.motions is None:
        options.motions = SMALL_MOTIONS if options.small else GOOD_MOTIONS
    if options.bad_replies is None:
        options.bad_replies = SMALL_MOTIONS if options.small else BAD_REPLIES
    return options


def real_time_is_granted() -> bool:
    """Whether the system lets threads run before all ordinary processes; asks in a process of its own."""
    process = multiprocessing.get_context("fork").Process(
        target=lambda: os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(1)))
    with open(os.devnull, "w", encoding="utf-8") as nowhere, contextlib.redirect_stderr(nowhere):
        process.start()
    process.join()
    return process.exitcode == 0


def names_of(wire: str, options: argparse.Namespace) -> list[str]:
    names = options.row or ([] if options.no_rows else list(rows.NAMES))
    if options.small and names and not options.row:
        draw = random.Random(f"{options.seed} {wire}")
        names = [draw.choice([name for name in names if rows.NAMES[name].state in states]) for states in SMALL_STATES]
    return names


def main() -> int:
    options = arguments()
    if options.list:
        for row in rows.ROWS:
            print(f"{row.name:34} {' or '.join(row.causes)}")
        return 0
    if options.busy and not real_time_is_granted():
        print("skipped: the system does not grant SCHED_FIFO", file=sys.stderr)
        return NOT_POSSIBLE
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
