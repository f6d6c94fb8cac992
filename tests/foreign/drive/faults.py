"""Faults that the simulated drive can have. Each begins by itself, some time into a given kind of motion."""
from __future__ import annotations

from dataclasses import dataclass, field

# Effects and their values:
#   run: the axis moves at this speed, in mm/s, relative to the ordered direction (at rest: down)
#   run_mm: only for this distance            jam: the axis stands still at once
#   freeze_position: the register keeps its value
#   freeze_velocity: the register shows 0; with `kept` it keeps its value, and the fault counts when the axis is at rest
#   jump: the reported position jumps by so much, in mm
#   deaf: stops are acknowledged and ignored
#   stale, far: homing ends at once; after 10 mm
#   endless: homing does not end; the fault counts from this distance, in mm
#   alarm: with this code                     off_s: the drive's power is off for this time
#   button, end_switch: is pressed
Effects = dict


@dataclass
class Fault:
    mode: str  # of the drive when the fault begins: "rest", "home", "jog" or "move"
    after_s: float  # time since this mode was entered
    effects: Effects = field(default_factory=dict)
    began_s: float | None = None  # the drive's clock
    travel_mm: float = 0.0  # of `run`
    entered_s: float | None = None

    @property
    def active(self) -> bool:
        return self.began_s is not None

    def watch(self, mode: str, now_s: float) -> bool:
        """Returns true once, when the fault begins."""
        if self.active:
            return False
        if mode != self.mode:
            self.entered_s = None
            return False
        if self.entered_s is None:
            self.entered_s = now_s
        if now_s - self.entered_s < self.after_s:
            return False
        self.began_s = now_s
        return True


NONE = Fault("none", 0.0)
