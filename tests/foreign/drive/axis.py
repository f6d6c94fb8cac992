"""One vertical axis, integrated in time. Positions in mm from the home switch, positive is down."""
from __future__ import annotations

import math
from dataclasses import dataclass

STEP_S = 0.001
SNAP_MM = 0.0005


@dataclass
class Axis:
    position_mm: float
    low_mm: float = -8.0  # hard ends
    high_mm: float = 308.0
    velocity: float = 0.0  # mm/s

    @property
    def home_switch(self) -> bool:
        return self.position_mm <= 0

    def step(self, wanted: float, acceleration: float) -> None:
        """Goes on for STEP_S: the velocity approaches `wanted` with this acceleration. A hard end stops the axis."""
        change = max(-acceleration * STEP_S, min(acceleration * STEP_S, wanted - self.velocity))
        before, self.velocity = self.velocity, self.velocity + change
        self.position_mm += (before + self.velocity) / 2 * STEP_S
        if not self.low_mm <= self.position_mm <= self.high_mm:
            self.position_mm = max(self.low_mm, min(self.high_mm, self.position_mm))
            self.velocity = 0.0

    def jam(self) -> None:
        self.velocity = 0.0

    def step_towards(self, target_mm: float, speed: float, acceleration: float) -> bool:
        """Goes on for STEP_S towards a target, with a trapezoid of velocity. Returns whether it has arrived."""
        distance = target_mm - self.position_mm
        if abs(distance) < SNAP_MM and abs(self.velocity) <= acceleration * STEP_S:
            self.position_mm, self.velocity = target_mm, 0.0
            return True
        side = math.copysign(1.0, distance)
        self.step(side * min(speed, braking_speed(abs(distance), side * self.velocity, acceleration)), acceleration)
        return False


def braking_speed(distance_mm: float, velocity: float, acceleration: float) -> float:
    """Speed v after the next step from which it can brake: v^2 / 2a = distance - (velocity + v) / 2 STEP_S."""
    room = STEP_S ** 2 / 4 + (2 * distance_mm - velocity * STEP_S) / acceleration
    return max(0.0, acceleration * (math.sqrt(max(0.0, room)) - STEP_S / 2))


def move_time_s(distance_mm: float, speed: float, acceleration: float) -> float:
    """Duration of a move from rest to rest."""
    if distance_mm >= speed ** 2 / acceleration:
        return distance_mm / speed + speed / acceleration
    return 2 * math.sqrt(distance_mm / acceleration)
