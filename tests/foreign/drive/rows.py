"""The table of faults and states: what goes wrong in which state of the rig, and which causes are true."""
from __future__ import annotations

from dataclasses import dataclass, field

REST, UNHOMED, HOME, JOG, MOVE, DIP = "rest", "unhomed", "home", "jog", "move", "dip"
MODES = {REST: "rest", UNHOMED: "rest", HOME: "home", JOG: "jog", MOVE: "move", DIP: "move"}  # of the drive
JOG_SPEED, MOVE_SPEED, DIP_SPEED = 5.0, 10.0, 10.0
NOTICE_S, NOTICE_MM = 0.15, 1.0  # whichever is later
NO_PROGRESS_S = 0.3 + NOTICE_S  # the promised time without progress; a moving axis may be 0.5 mm + 0.25 s v behind
POWER_OFF_S, STALE_S = 1.5, 0.25

UNEXPECTED, JUMPED, OVERSPEED = "UNEXPECTED_MOTION", "POSITION_JUMPED", "OVERSPEED"
INCONSISTENT, FOLLOWING, HOMING_FAILED = "FEEDBACK_INCONSISTENT", "FOLLOWING_ERROR", "HOMING_FAILED"
NOT_OBEYED, RESTARTED, LINK_LOST = "STOP_NOT_OBEYED", "DRIVE_RESTARTED", "LINK_LOST"


@dataclass(frozen=True)
class Row:
    name: str
    state: str
    effects: dict
    causes: tuple[str, ...]  # each of them is true
    notice_s: float = NOTICE_S
    notice_mm: float | None = NOTICE_MM  # None: only the time counts
    after_s: float = 0.5  # from the start of the motion to the fault
    watched_s: float = 4.0  # how long the judge waits for the daemon
    start_mm: float = 10.0
    target_mm: float = 150.0
    final: tuple[str, ...] = ("FAULT",)
    slips: bool = False
    axis: dict = field(default_factory=dict)

    @property
    def deaf(self) -> bool:
        return "deaf" in self.effects


def still(name: str, state: str, causes: tuple[str, ...], effects: dict, **more: object) -> Row:
    """A fault in which the axis stands still, so that only time counts."""
    return Row(name, state, effects, causes, notice_s=more.pop("notice_s", NO_PROGRESS_S), notice_mm=None, **more)


def everywhere(states: tuple[str, ...], what: str, cause: str, effects: dict, **more: object) -> list[Row]:
    return [Row(f"{state}-{what}", state, dict(effects), (cause,), **more) for state in states]


ROWS = [
    Row("rest-runaway", REST, {"run": 25}, (UNEXPECTED,)),
    Row("rest-runaway-fast", REST, {"run": 100, "run_mm": 144}, (UNEXPECTED,)),
    Row("rest-runaway-velocity-frozen", REST, {"run": 25, "freeze_velocity": True}, (UNEXPECTED, INCONSISTENT)),
    # Without a velocity, a position that runs faster than the axis can is a jump, too.
    Row("rest-runaway-fast-velocity-frozen", REST, {"run": 100, "run_mm": 144, "freeze_velocity": True},
        (UNEXPECTED, INCONSISTENT, JUMPED)),
    Row("rest-runaway-position-frozen", REST, {"run": 25, "freeze_position": True}, (UNEXPECTED, INCONSISTENT)),
    Row("rest-drift", REST, {"run": 0.15}, (UNEXPECTED,), watched_s=9),
    Row("rest-drift-velocity-frozen", REST, {"run": 0.15, "freeze_velocity": True}, (UNEXPECTED, INCONSISTENT),
        watched_s=9),
    Row("rest-rezeroed", REST, {"jump": 30}, (JUMPED,)),
    Row("unhomed-runaway", UNHOMED, {"run": 25}, (UNEXPECTED,)),

    Row("jog-runaway", JOG, {"run": 25}, (OVERSPEED,)),
    Row("jog-twice-as-fast", JOG, {"run": 2 * JOG_SPEED}, (OVERSPEED,)),
    Row("jog-runaway-deaf", JOG, {"run": 25, "deaf": True}, (OVERSPEED, NOT_OBEYED)),
    Row("jog-wrong-way", JOG, {"run": -JOG_SPEED}, ("WRONG_DIRECTION",)),
    still("jog-stall", JOG, (FOLLOWING,), {"jam": True}),

    Row("home-runaway", HOME, {"run": 120}, (OVERSPEED,), start_mm=150, after_s=0.3),
    still("home-stale", HOME, (HOMING_FAILED,), {"stale": True}, start_mm=80, notice_s=1.0),
    still("home-far", HOME, (HOMING_FAILED,), {"far": True}, start_mm=90, after_s=0.05, notice_s=NOTICE_S),
    # The ends are 60 mm apart, so after 60 mm no switch can follow. The distance kept from the ends may be added.
    Row("home-endless", HOME, {"endless": 60.0}, (HOMING_FAILED,), slips=True, after_s=0.05, watched_s=9,
        axis={"end_high_mm": 55.0, "keep_out_mm": 13.0}, notice_mm=13.0 + NOTICE_MM),

    still("move-stall", MOVE, (FOLLOWING,), {"jam": True}),
    still("dip-stall", DIP, (FOLLOWING,), {"jam": True}),
    Row("move-wrong-way", MOVE, {"run": -MOVE_SPEED}, (FOLLOWING, "WRONG_DIRECTION")),
    Row("move-overspeed", MOVE, {"run": 25}, (OVERSPEED, FOLLOWING)),
    Row("dip-overspeed", DIP, {"run": 25}, (OVERSPEED, FOLLOWING)),

    Row("jog-position-jumps", JOG, {"jump": 30}, (JUMPED,)),
    Row("move-position-jumps", MOVE, {"jump": 30}, (JUMPED, FOLLOWING)),
    Row("dip-position-jumps", DIP, {"jump": 30}, (JUMPED, FOLLOWING)),
    *everywhere((JOG, MOVE, DIP), "position-frozen", INCONSISTENT, {"freeze_position": True}),
    *everywhere((JOG, MOVE, DIP), "velocity-frozen", INCONSISTENT, {"freeze_velocity": True}),
    Row("home-position-frozen", HOME, {"freeze_position": True}, (INCONSISTENT,), start_mm=60),
    Row("home-velocity-frozen", HOME, {"freeze_velocity": True}, (INCONSISTENT,), start_mm=60),

    # The register keeps the speed of the move when the axis has arrived, so it never shows that the axis obeys a stop.
    Row("move-velocity-kept", MOVE, {"freeze_velocity": True, "kept": True}, (INCONSISTENT, NOT_OBEYED), target_mm=30,
        watched_s=6, final=("FAULT", "STOPPING")),

    *everywhere((JOG, MOVE), "deaf", NOT_OBEYED, {"deaf": True}),
    *everywhere((REST, JOG, MOVE), "alarm", "DRIVE_ALARM", {"alarm": 0x3210}, notice_mm=None),
    *everywhere((REST, MOVE), "restart", RESTARTED, {"off_s": 0.06}, notice_mm=None, notice_s=0.06 + NOTICE_S),
    *[Row(f"{state}-power-loss", state, {"off_s": POWER_OFF_S}, (RESTARTED, LINK_LOST), notice_mm=None,
          notice_s=STALE_S + NOTICE_S, watched_s=6) for state in (REST, MOVE)],
    *everywhere((REST, JOG, MOVE), "stop-button", "STOP_BUTTON", {"button": True}, notice_mm=None, final=("ESTOPPED",)),
    *everywhere((JOG, MOVE), "end-switch", "END_SWITCH", {"end_switch": True}),
]
NAMES = {row.name: row for row in ROWS}
