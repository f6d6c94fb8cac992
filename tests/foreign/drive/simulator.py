"""Runs the drive on its wire in a process of its own, so that the judge's work does not delay it."""
from __future__ import annotations

import contextlib
import multiprocessing
import os
import select
import time
from dataclasses import dataclass

import drive_profile
import wires
from axis import Axis
from drive import Drive, Event
from faults import Fault

LOOP_S = 0.004
PRIORITY = 12  # of SCHED_FIFO, if the system grants it: a real drive does not share the daemon's processors


@dataclass(frozen=True)
class Setup:
    """What a simulator starts with."""
    wire: str = "tcp"
    start_mm: float = 10.0
    watchdog_s: float = drive_profile.WATCHDOG_S
    slips: bool = False
    seed: int = 1


@dataclass(frozen=True)
class Record:
    """What happened at the drive; times on the clock time.monotonic(), which all processes share."""
    now_s: float
    events: list[Event]
    trace: list[tuple[float, float, float, float]]  # time, position, velocity, reported position
    messages_s: list[float]
    late_s: list[tuple[float, float]]  # time, and by how much the simulator itself was late
    strike: wires.Strike | None


class Simulator:
    """The judge's side: starts the process and talks to it."""

    def __init__(self, setup: Setup):
        context = multiprocessing.get_context("fork")
        self.pipe, other = context.Pipe()
        self.process = context.Process(target=serve, args=(setup, other), daemon=True)
        self.process.start()
        self.endpoint: str = self.pipe.recv()

    def ask(self, *message: object) -> object:
        self.pipe.send(message)
        return self.pipe.recv()

    def set_fault(self, fault: Fault) -> None:
        self.ask("fault", fault)

    def set_strike(self, kind: str, after_s: float) -> None:
        """The first reply this time from now goes wrong."""
        self.ask("strike", kind, after_s)

    def record(self, whole: bool = True) -> Record:
        """Not the whole one: only the end of the trace and no messages, which does not detain the simulator."""
        return self.ask("record", whole)

    def clear(self) -> None:
        """Forgets what was recorded so far."""
        self.ask("clear")

    def __enter__(self) -> "Simulator":
        return self

    def __exit__(self, *_: object) -> None:
        with contextlib.suppress(OSError):
            self.pipe.send(("end",))
        self.process.join(5)
        self.process.kill()


def serve(setup: Setup, pipe: "multiprocessing.connection.Connection") -> None:
    with contextlib.suppress(OSError):
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(PRIORITY))
    drive = Drive(Axis(setup.start_mm), time.monotonic(), setup.seed, setup.watchdog_s, setup.slips)
    wire = wires.WIRES[setup.wire](drive)
    pipe.send(wire.endpoint)
    with contextlib.suppress(EOFError, KeyboardInterrupt):
        Loop(drive, wire, pipe).run()
    wire.close()


class Loop:
    def __init__(self, drive: Drive, wire: wires.Wire, pipe: "multiprocessing.connection.Connection"):
        self.drive, self.wire, self.pipe = drive, wire, pipe
        self.late_s: list[tuple[float, float]] = []
        self.goes_on = True

    def run(self) -> None:
        while self.goes_on:
            due_s = min([time.monotonic() + LOOP_S]
                        + [item.due_s for channel in self.wire.channels for item in channel.waiting])
            files = [self.pipe] + [channel.file for channel in self.wire.channels]
            if self.wire.listener:
                files.append(self.wire.listener)
            ready, _, _ = select.select(files, [], [], max(0.0, due_s - time.monotonic()))
            now_s = time.monotonic()
            if now_s - due_s > LOOP_S:
                self.late_s.append((now_s, now_s - due_s))
            self.drive.advance(now_s)
            if self.pipe in ready:
                self.control(*self.pipe.recv())
            if self.wire.listener in ready and not self.drive.off:
                self.wire.accept()
            self.exchange(ready)

    def exchange(self, ready: list) -> None:
        for channel in list(self.wire.channels):
            try:
                if channel.file in ready:
                    self.wire.serve(channel)
                channel.flush(self.drive.now_s)
                if self.drive.off:
                    self.wire.drop(channel)
            except (ConnectionError, OSError):
                self.wire.drop(channel)

    def control(self, what: str, *values: object) -> None:
        drive, answer = self.drive, None
        if what == "fault":
            drive.set_fault(values[0])
        elif what == "strike":
            self.wire.strike = wires.Strike(values[0], drive.now_s + values[1])
        elif what == "record":
            trace, messages_s = (drive.trace, drive.messages_s) if values[0] else (drive.trace[-1:], [])
            answer = Record(drive.now_s, drive.events, trace, messages_s, self.late_s, self.wire.strike)
        elif what == "clear":
            drive.events, drive.trace, drive.messages_s, self.late_s, self.wire.strike = [], [], [], [], None
        elif what == "end":
            self.goes_on = False
        self.pipe.send(answer)
