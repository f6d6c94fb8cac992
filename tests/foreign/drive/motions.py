"""Motions of all kinds, drawn from a seed, that must end as ordered: undisturbed, or with one bad reply each."""
from __future__ import annotations

import argparse
import collections
import random
import time
from dataclasses import dataclass

import wires
from axis import move_time_s
from claims import Claim
from drive import HOME_ACCELERATION, HOME_SPEED
from drive_profile import Timing
from session import Daemon, Operator, Refused
from simulator import Setup, Simulator

KINDS = {"short move": 6, "long move": 1, "jog": 5, "changed jog": 4, "home": 2, "dip": 1, "arm": 1}
LOW_MM, HIGH_MM, NEAR_MM = 9.0, 70.0, 30.0  # of the places moved to
ARRIVED_MM = 0.15
STOOD_STILL_S, EXCUSED_SHARE = 0.05, 0.02  # the simulator has real-time priority, so such a delay is the machine's
AFTERMATH_S = 0.3  # in which a bad reply at the end of a motion still shows
SETTLED = ("IDLE", "FAULT", "ESTOPPED", "OFFLINE", "DISARMED", "UNHOMED")


@dataclass
class Tally:
    """Motions by what was done, and what went wrong."""
    done: collections.Counter
    failures: list[str]
    tried: collections.Counter
    excused: int = 0  # failures while the machine stood still

    def count(self, what: str, failure: str, late_s: float) -> None:
        if failure and late_s > STOOD_STILL_S:
            self.excused += 1
            return
        self.tried[what] += 1
        self.done[what] += not failure

    def claims(self) -> list[Claim]:
        most = max(1, round(EXCUSED_SHARE * (self.excused + self.tried.total())))
        return [Claim("failures not counted, because the simulator itself stood still", self.excused <= most,
                      str(self.excused), f"at most {most}"),
                *[Claim(f"{what}, as ordered", self.done[what] == count, f"{self.done[what]} of {count}", "all")
                  for what, count in sorted(self.tried.items())],
                *[Claim("motion", False, failure, "as ordered") for failure in self.failures]]


class Trial:
    """One daemon and one drive, and a random sequence of motions on them."""

    def __init__(self, operator: Operator, simulator: Simulator, draw: random.Random):
        self.operator, self.simulator, self.draw = operator, simulator, draw
        self.place_mm, self.struck = 0.0, False

    def strike(self, kind: str | None, lasts_s: float) -> None:
        """One reply goes wrong at a random time of the motion, which has just begun."""
        self.struck = kind is not None
        if kind:
            self.simulator.set_strike(kind, lasts_s * self.draw.uniform(0.1, 0.8))

    def run(self, motion: str, bad: str | None) -> str:
        """Returns what went wrong; empty if nothing did."""
        try:
            if motion in ("home", "arm"):
                return self.home(motion == "arm", bad)
            if motion in ("jog", "changed jog"):
                return self.jog(motion == "changed jog", bad)
            return self.dip(bad) if motion == "dip" else self.move(motion == "long move", bad)
        except Refused as error:
            return str(error)

    def ended(self, rig: dict, outcome: str) -> str:
        """Compares the rig with what it should be."""
        if self.struck and rig.get("state") == "IDLE":
            time.sleep(AFTERMATH_S)
            rig = self.operator.rig()
        last = rig.get("motion", {})
        self.place_mm = rig.get("positionMm", 0.0)
        if rig.get("state") == "IDLE" and rig.get("homed") and last.get("outcome") == outcome and not rig.get("cause"):
            return ""
        return f"{rig.get('state')} {rig.get('cause')}, motion {last.get('outcome')} {last.get('cause', '')}".strip()

    def home(self, again: bool, bad: str | None) -> str:
        if self.place_mm < LOW_MM:  # homing from its end would be too short to be seen without one reply
            self.operator.move(self.draw.uniform(LOW_MM, NEAR_MM), 20)
            self.simulator.clear()
        if again:
            self.operator.command("disarm")
            self.operator.command("arm")
        self.operator.command("home")
        self.strike(bad, self.operator.rig()["positionMm"] / HOME_SPEED)
        return self.ended(self.operator.wait(*SETTLED), "DONE")

    def move(self, far: bool, bad: str | None) -> str:
        target = self.draw.uniform(LOW_MM, HIGH_MM)
        if not far:
            target = min(HIGH_MM, max(LOW_MM, self.place_mm + self.draw.choice((-1, 1)) * self.draw.uniform(0.5, 15)))
        distance = abs(target - self.place_mm)
        speed = self.draw.uniform(max(1.0, distance / 4), 20)
        self.operator.command("moveTo", positionMm=target, speedMmPerS=speed)
        self.strike(bad, move_time_s(distance, speed, HOME_ACCELERATION))
        said = self.ended(self.operator.wait(*SETTLED, seconds=20), "DONE")
        off = abs(self.simulator.record(whole=False).trace[-1][3] - target)
        return said or (f"{off:.2f} mm from its target" if off > ARRIVED_MM else "")

    def jog(self, changes: bool, bad: str | None) -> str:
        side = 1 if self.place_mm < NEAR_MM else -1
        lasts_s, speed = self.draw.uniform(0.4, 1.2), side * self.draw.uniform(1, 12)
        self.operator.jog(speed)
        self.strike(bad, lasts_s)
        time.sleep(lasts_s)
        if changes:
            self.operator.jog(speed * self.draw.uniform(0.3, 1.5))
            time.sleep(lasts_s)
            self.operator.jog(-speed)
            time.sleep(lasts_s)
        self.operator.end_jog()
        return self.ended(self.operator.wait(*SETTLED, seconds=5), "STOPPED")

    def dip(self, bad: str | None) -> str:
        if self.place_mm < 20:
            self.operator.move(25, 20)
            self.place_mm = 25
        depth, speed = self.draw.uniform(2, 15), self.draw.uniform(4, 12)
        job = self.operator.dip(depth, speed)
        self.operator.wait("DIPPING", seconds=10)
        self.strike(bad, 2 * depth / speed)
        while (state := self.operator.daemon.ask("GET", f"/v1/{job}")["state"]) in ("RUNNING", "WAITING_FOR_OPERATOR"):
            time.sleep(0.05)
        said = self.ended(self.operator.wait(*SETTLED, seconds=5), "DONE")
        return said or ("" if state == "SUCCEEDED" else f"job {state}")

    def recover(self) -> None:
        """After a motion that failed."""
        self.operator.wait("FAULT", "ESTOPPED", "IDLE", "UNHOMED", "DISARMED", seconds=3)
        for verb in ("resetFault", "arm"):
            try:
                self.operator.command(verb)
            except Refused:
                pass
        self.operator.home()
        self.place_mm = 0.0


def judge(wire: str, bad: bool, count: int, options: argparse.Namespace) -> list[Claim]:
    draw = random.Random(f"{options.seed} {wire} {bad}")
    timing = Timing(options.response_timeout_s, options.worst_delay_s)
    tally = Tally(collections.Counter(), [], collections.Counter())
    with Simulator(Setup(wire, seed=options.seed)) as simulator, Daemon(options.daemon, simulator, timing) as daemon:
        operator = Operator(daemon)
        operator.prepare()
        trial = Trial(operator, simulator, draw)
        for number in range(count):
            simulator.clear()
            motion = draw.choices(list(KINDS), list(KINDS.values()))[0]
            kind = wires.BAD[number % len(wires.BAD)] if bad else None
            failure = trial.run(motion, kind)
            record = simulator.record(whole=False)
            struck = record.strike
            what = f"{kind} reply" if kind else motion
            if kind and (struck is None or struck.hit_s is None):
                what = f"motion without its {kind} reply"
            late_s = max((late for _, late in record.late_s), default=0.0)
            tally.count(what, failure, late_s)
            if failure and late_s <= STOOD_STILL_S:
                tally.failures.append(f"{number + 1}: {motion}{f', {what}' if kind else ''}: {failure}")
            if failure:
                trial.recover()
    return tally.claims()
