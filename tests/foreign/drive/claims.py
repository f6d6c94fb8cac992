"""Claims about one fault: functions of what was measured, without programs."""
from __future__ import annotations

import math
from dataclasses import dataclass

from drive import STOP_DECELERATION
from rows import NOTICE_S, Row
from simulator import Record

ALLOWED_S = 0.02  # for a busy machine; the simulator's own delays are added
PERIOD_S = 0.02  # of polling: when the daemon can decide after a time has passed
AT_REST = 1e-6  # mm/s
GONE = ("STOPPING", "FAULT", "ESTOPPED", "OFFLINE", "DISARMED")


@dataclass(frozen=True)
class Claim:
    what: str
    holds: bool
    measured: str
    limit: str

    def line(self, title: str) -> str:
        return f"{'ok  ' if self.holds else 'FAIL'}  {title}: {self.what}: {self.measured} ({self.limit})"


@dataclass(frozen=True)
class Sight:
    """The rig as the daemon reported it, and when."""
    at_s: float
    state: str
    cause: str
    homed: bool
    outcome: str


@dataclass(frozen=True)
class Outcome:
    record: Record
    sights: list[Sight]
    watchdog_s: float

    @property
    def fault_s(self) -> float | None:
        return next((event.at_s for event in self.record.events if event.what == "fault"), None)

    def noticed_s(self, row: Row) -> float:
        """When the daemon showed that it knew: a stop arrived, messages ceased, or the rig left its state."""
        begin, found = self.fault_s, []
        if not row.deaf or "run" in row.effects:
            found += [event.at_s for event in self.record.events if event.what == "stop" and event.at_s >= begin]
            found += [sight.at_s for sight in self.sights if sight.at_s >= begin and sight.state in GONE]
        found += [self.silent_s] if self.silent_s is not None else []
        return min(found, default=math.inf)

    @property
    def silent_s(self) -> float | None:
        """When the last message before the watchdog acted arrived."""
        acted = next((event.at_s for event in self.record.events if event.what == "watchdog"), None)
        return None if acted is None else max((at for at in self.record.messages_s if at <= acted), default=acted)

    def travel_mm(self, until_s: float) -> float:
        """The larger one of what the axis and its register moved since the fault."""
        begin, axis, register, before = self.fault_s, 0.0, 0.0, None
        for row in self.record.trace:
            if row[0] > until_s:
                break
            if before and row[0] >= begin:
                axis, register = axis + abs(row[1] - before[1]), register + abs(row[3] - before[3])
            before = row
        return max(axis, register)

    @property
    def rest_s(self) -> float:
        """When the axis came to rest; infinite if it still moves."""
        trace = self.record.trace
        if not trace or abs(trace[-1][2]) > AT_REST:
            return math.inf
        return next((row[0] for row in reversed(trace) if abs(row[2]) > AT_REST), self.fault_s)

    def speed(self, from_s: float) -> float:
        return max((abs(row[2]) for row in self.record.trace if row[0] >= from_s), default=0.0)

    def late_s(self, until_s: float) -> float:
        """By how much the simulator itself was late since the fault."""
        return sum(late for at, late in self.record.late_s if self.fault_s <= at <= until_s + late)


def of_row(row: Row, outcome: Outcome) -> list[Claim]:
    if outcome.fault_s is None:
        states = ", ".join(dict.fromkeys(sight.state for sight in outcome.sights))
        return [Claim("the fault occurred", False, f"it did not; the rig was {states}", "in the ordered motion")]
    return [of_notice(row, outcome), of_rest(row, outcome), *of_end(row, outcome)]


def of_notice(row: Row, outcome: Outcome) -> Claim:
    at = outcome.noticed_s(row)
    took, travel = at - outcome.fault_s, outcome.travel_mm(at)
    limit = row.notice_s + ALLOWED_S + outcome.late_s(at)
    if row.deaf and "run" not in row.effects:
        limit += PERIOD_S
    holds = took <= limit or (math.isfinite(at) and row.notice_mm is not None and travel <= row.notice_mm)
    by_travel = "" if row.notice_mm is None else f" or {row.notice_mm:g} mm"
    measured = f"{took:.3f} s, {travel:.2f} mm" if math.isfinite(at) else f"never, {travel:.1f} mm"
    return Claim("noticed after", holds, measured, f"at most {limit:.3f} s{by_travel}")


def of_rest(row: Row, outcome: Outcome) -> Claim:
    noticed, rest = outcome.noticed_s(row), outcome.rest_s
    limit = ALLOWED_S + outcome.late_s(rest) + outcome.speed(outcome.fault_s) / STOP_DECELERATION
    if row.deaf:
        limit += outcome.watchdog_s
        limit += NOTICE_S + PERIOD_S if "run" in row.effects else 0
    took = rest - noticed if math.isfinite(noticed) else math.inf
    return Claim("at rest after that", took <= limit, f"{max(took, 0.0):.3f} s" if math.isfinite(took) else "never",
                 f"at most {limit:.3f} s")


def of_end(row: Row, outcome: Outcome) -> list[Claim]:
    last = outcome.sights[-1]
    out = [Claim("cause", last.cause in row.causes, last.cause or "none", " or ".join(row.causes)),
           Claim("state", last.state in row.final, last.state, " or ".join(row.final)),
           Claim("homed afterwards", not last.homed, str(last.homed), "False")]
    if row.state not in ("rest", "unhomed"):
        # A motion that was ordered to stop may count as stopped.
        wanted = ("FAILED", "STOPPED") if row.deaf else ("FAILED",)
        out.append(Claim("outcome of the motion", last.outcome in wanted, last.outcome or "none", " or ".join(wanted)))
    if row.state == "home":
        ever = any(sight.homed for sight in outcome.sights)
        out.append(Claim("ever reported as homed", not ever, str(ever), "False"))
    return out
