"""Provokes one fault of the drive in one state of the rig, and records what the daemon does."""
from __future__ import annotations

import pathlib
import time

import rows
from claims import Outcome, Sight
from faults import Fault
from drive_profile import Timing
from rows import Row
from session import Daemon, Operator
from simulator import Setup, Simulator

FINAL = ("FAULT", "ESTOPPED")
SETTLED_S = 0.4  # after the rig's last state, for the axis to come to rest


def provoke(row: Row, wire: str, program: pathlib.Path, seed: int) -> Outcome:
    setup = Setup(wire, row.start_mm, slips=row.slips, seed=seed)
    with Simulator(setup) as simulator, Daemon(program, simulator, Timing(), row.axis) as daemon:
        operator = Operator(daemon)
        prepare(row, operator)
        simulator.clear()
        if row.state != rows.DIP:
            set_fault(row, simulator)
        order(row, operator, simulator)
        try:
            sights = watch(row, operator)
        finally:
            operator.end_jog()
        return Outcome(simulator.record(), sights, setup.watchdog_s)


def set_fault(row: Row, simulator: Simulator) -> None:
    simulator.set_fault(Fault(rows.MODES[row.state], row.after_s, dict(row.effects)))


def prepare(row: Row, operator: Operator) -> None:
    operator.wait("DISARMED", seconds=10)
    operator.command("arm")
    if row.state not in (rows.HOME, rows.UNHOMED):
        operator.home()
    if row.state in (rows.JOG, rows.DIP):
        operator.move(30, 20)


def order(row: Row, operator: Operator, simulator: Simulator) -> None:
    if row.state == rows.HOME:
        operator.command("home")
    elif row.state == rows.JOG:
        operator.jog(rows.JOG_SPEED)
    elif row.state == rows.MOVE:
        operator.command("moveTo", positionMm=row.target_mm, speedMmPerS=rows.MOVE_SPEED)
    elif row.state == rows.DIP:
        operator.dip(60, rows.DIP_SPEED)
        operator.wait("DIPPING", seconds=10)
        set_fault(row, simulator)
    if row.deaf and "run" not in row.effects:
        time.sleep(row.after_s + 0.3)
        operator.end_jog()
        operator.command("stop")


def watch(row: Row, operator: Operator) -> list[Sight]:
    """Looks at the rig until it has reached a final state, or for as long as the row says."""
    sights, end = [], time.monotonic() + row.after_s + row.watched_s
    while time.monotonic() < end:
        rig = operator.rig()
        sights.append(sight_of(rig))
        if sights[-1].state in FINAL:
            break
        time.sleep(0.005)
    time.sleep(SETTLED_S)
    return sights + [sight_of(operator.rig())]


def sight_of(rig: dict) -> Sight:
    return Sight(time.monotonic(), rig.get("state", ""), rig.get("cause", ""), rig.get("homed", False),
                 rig.get("motion", {}).get("outcome", ""))
