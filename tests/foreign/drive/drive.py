"""A drive like those of CiA 402 with its axis: state machine, modes, registers, watchdog, faults. It has no input or
output of its own: time and messages are arguments, so that its behaviour can be compared with closed forms."""
from __future__ import annotations

import math
import random
from dataclasses import dataclass

import faults
import registers as reg
from axis import STEP_S, Axis
from registers import NoRegister, number_of, words_of

HOME_SPEED, HOME_SLOW, HOME_ACCELERATION = 15.0, 2.0, 200.0
STOP_DECELERATION, RUN_ACCELERATION = 250.0, 1000.0
FILTER_S, SHOWN_AS_MOVING = 0.005, 0.5  # the velocity register is behind by this time constant; mm/s
COMMUNICATION_LOST, FAR_MM, TRACE_STEPS = 0x8130, 10.0, 2
SHOWN_LATER = {"deaf", "far", "endless", "kept"}  # effects that are noted as the fault when they show


@dataclass(frozen=True)
class Event:
    at_s: float
    what: str
    position_mm: float


class Drive:
    def __init__(self, axis: Axis, now_s: float = 0.0, seed: int = 1, watchdog_s: float = 0.2, slips: bool = False):
        self.axis, self.now_s, self.random, self.fault = axis, now_s, random.Random(seed), faults.NONE
        self.slips = slips  # the home switch and the hard ends do not work
        self.watchdog_ms, self.watchdog_action = round(1000 * watchdog_s), reg.QUICK_STOP
        self.events: list[Event] = []
        self.trace: list[tuple[float, float, float, float]] = []  # time, position, velocity, reported position
        self.messages_s: list[float] = []
        self.off_until_s = -math.inf
        self.button = self.end_switch = False
        self.steps, self.filtered = 0, 0.0
        if slips:
            axis.low_mm, axis.high_mm = -math.inf, math.inf
        self.switch_on()

    def switch_on(self) -> None:
        """As after its power was off: disabled, without a home position."""
        self.state, self.control, self.error, self.homed, self.attained = "disabled", 0, 0, False, False
        self.offset_mm = self.axis.position_mm
        self.setting = {reg.MODE: [0], **{key: [0, 0] for key in (
            reg.TARGET, reg.SPEED, reg.ACCELERATION, reg.TARGET_VELOCITY)}}
        self.mode, self.target_mm, self.speed, self.phase = "rest", 0.0, 0.0, ""
        self.acceleration, self.last_message_s = HOME_ACCELERATION, None
        self.shown: dict[str, float] = {}  # values of registers that stand still
        self.begin_mm = self.axis.position_mm

    # Time

    def advance(self, until_s: float) -> None:
        while self.now_s + STEP_S <= until_s:
            self.now_s += STEP_S
            self.step()

    def step(self) -> None:
        if self.fault.watch(self.mode, self.now_s):
            self.begin_fault()
        if self.off_until_s > -math.inf and self.now_s >= self.off_until_s:
            self.off_until_s = -math.inf
            self.switch_on()
            self.note("restarted")
        self.supervise()
        self.move()
        self.filtered += (self.axis.velocity - self.filtered) * STEP_S / FILTER_S
        if "kept" in self.fault.effects and self.fault.active and self.axis.velocity == 0 and not self.noted("fault"):
            self.note("fault")
        self.steps += 1
        if self.steps % TRACE_STEPS == 0:
            self.trace.append((self.now_s, self.axis.position_mm, self.axis.velocity, self.reported_mm()))

    def supervise(self) -> None:
        """The watchdog: without messages the axis stops and the drive is in the state fault."""
        acts = self.state == "enabled" and self.watchdog_ms and self.watchdog_action == reg.QUICK_STOP
        if acts and self.last_message_s is not None and self.now_s - self.last_message_s > self.watchdog_ms / 1000:
            self.note("watchdog")
            self.fail(COMMUNICATION_LOST)

    def fail(self, code: int) -> None:
        self.state, self.error = "fault", code
        self.end_motion()

    def end_motion(self) -> None:
        """Brakes; the velocity of a jog is forgotten."""
        self.mode, self.phase, self.setting[reg.TARGET_VELOCITY] = "rest", "", [0, 0]
        self.fault.effects.pop("run", None)

    def move(self) -> None:
        axis, active = self.axis, self.fault.effects if self.fault.active else {}
        if "jam" in active:
            axis.jam()
        elif "run" in active and self.state == "enabled":
            before = axis.position_mm
            axis.step(active["run"], RUN_ACCELERATION)
            self.fault.travel_mm += abs(axis.position_mm - before)
            if self.fault.travel_mm >= active.get("run_mm", math.inf):
                self.end_motion()
        elif self.state != "enabled" or self.mode == "rest":
            axis.step(0, STOP_DECELERATION)
        elif self.mode == "move":
            if axis.step_towards(self.target_mm, self.speed, self.acceleration):
                self.end_motion()
        elif self.mode == "jog":
            axis.step(self.speed, self.acceleration)
        elif self.mode == "home":
            self.home(active)

    def home(self, active: faults.Effects) -> None:
        """Up to the switch, slowly back until it releases; that place is 0."""
        axis = self.axis
        if abs(axis.position_mm - self.begin_mm) > active.get("endless", math.inf) and not self.noted("fault"):
            self.note("fault")
        if "far" in active and abs(axis.position_mm - self.begin_mm) > FAR_MM:
            self.homed = self.attained = True
            self.note("fault")
            self.end_motion()
        elif self.phase == "search":
            axis.step(-HOME_SPEED, HOME_ACCELERATION)
            if axis.home_switch and not self.slips:
                self.phase = "back"
        else:
            axis.step(HOME_SLOW, HOME_ACCELERATION)
            if not axis.home_switch:
                self.offset_mm, self.homed, self.attained = axis.position_mm, True, True
                self.end_motion()

    def note(self, what: str) -> None:
        self.events.append(Event(self.now_s, what, self.axis.position_mm))

    def noted(self, what: str) -> bool:
        return any(event.what == what for event in self.events)

    # Faults

    def set_fault(self, fault: faults.Fault) -> None:
        self.fault = fault
        if "stale" in fault.effects or "far" in fault.effects:
            self.offset_mm = 0.0
        if "stale" in fault.effects:
            self.homed = True

    def begin_fault(self) -> None:
        effects = self.fault.effects
        if "run" in effects:
            side = math.copysign(1.0, self.axis.velocity) if self.mode != "rest" and self.axis.velocity else 1.0
            effects["run"] *= side
        if "freeze_position" in effects:
            self.shown["position"] = self.reported_mm()
        if "freeze_velocity" in effects:
            self.shown["velocity"] = self.filtered if "kept" in effects else 0.0
        self.offset_mm -= effects.get("jump", 0.0)
        if "alarm" in effects:
            self.fail(effects["alarm"])
        if "off_s" in effects:
            self.off_until_s = self.now_s + effects["off_s"]
            self.state = "disabled"
            self.end_motion()
        self.end_switch = self.end_switch or "end_switch" in effects
        if "button" in effects:
            self.button = True
            self.state = "disabled"
            self.end_motion()
        if not SHOWN_LATER & effects.keys() or "run" in effects:
            self.note("fault")

    @property
    def off(self) -> bool:
        return self.now_s < self.off_until_s

    def hears(self) -> bool:
        """Whether it obeys stops; an ignored stop is when the fault shows."""
        if self.fault.active and "deaf" in self.fault.effects:
            if not self.noted("fault"):
                self.note("fault")
            return False
        return True

    # Registers

    def reported_mm(self) -> float:
        return self.shown.get("position", self.axis.position_mm - self.offset_mm)

    def reported_velocity(self) -> float:
        return self.shown.get("velocity", self.filtered)

    def read(self, address: int, count: int) -> list[int]:
        words = self.words()
        if any(address + i not in words for i in range(count)):
            raise NoRegister
        return [words[address + i] for i in range(count)]

    def words(self) -> dict[int, int]:
        """All registers; the encoder is one count unsteady."""
        velocity = self.reported_velocity()
        unsteady = 0 if "position" in self.shown else self.random.choice((-1, 0, 0, 1))
        lists = {reg.VENDOR: [reg.VENDOR_ID], reg.PRODUCT: [reg.PRODUCT_ID],
                 reg.WATCHDOG_TIME: words_of(self.watchdog_ms), reg.WATCHDOG_ACTION: [self.watchdog_action],
                 reg.DEVICE_TYPE: [reg.CIA_402], reg.STATUS: [self.status()],
                 reg.ERROR: [self.error], reg.POSITION: words_of(reg.COUNTS_PER_MM * self.reported_mm() + unsteady),
                 reg.VELOCITY: words_of(reg.SHOWN_PER_MM_PER_S * velocity), reg.INPUTS: [self.inputs()],
                 reg.RESERVED: [0] * reg.RESERVED_WORDS, reg.CONTROL: [self.control], **self.setting}
        return {address + i: word for address, words in lists.items() for i, word in enumerate(words)}

    def status(self) -> int:
        moves = abs(self.reported_velocity()) > SHOWN_AS_MOVING or self.mode != "rest"
        return (reg.STATES[self.state] | reg.MOVING * moves | reg.HOMING_ATTAINED * self.attained
                | reg.HOMED * self.homed)

    def inputs(self) -> int:
        return (reg.POSITIVE_END * self.end_switch | reg.HOME_SWITCH * (self.axis.home_switch and not self.slips)
                | reg.TORQUE_OFF * self.button)

    def heard(self) -> None:
        """Any valid message restarts the watchdog."""
        self.last_message_s = self.now_s
        self.messages_s.append(self.now_s)

    def write(self, address: int, values: list[int]) -> None:
        """Writes settings, then carries out the control word if it is among them."""
        known = {reg.WATCHDOG_TIME: 2, reg.WATCHDOG_ACTION: 1, reg.CONTROL: 1}
        known.update({key: len(old) for key, old in self.setting.items()})
        at = address
        while at < address + len(values):
            size = known.get(at)
            words = values[at - address:at - address + (size or 1)]
            if size is None or len(words) < size:
                raise NoRegister
            self.put(at, words)
            at += size

    def put(self, address: int, words: list[int]) -> None:
        if address == reg.WATCHDOG_TIME:
            self.watchdog_ms = number_of(words)
        elif address == reg.WATCHDOG_ACTION:
            self.watchdog_action = words[0]
        elif address == reg.CONTROL:
            before, self.control = self.control, words[0]
            self.command(words[0], rising=words[0] & ~before)
        else:
            self.setting[address] = words

    # The state machine of CiA 402

    def command(self, word: int, rising: int) -> None:
        if self.state == "fault":
            if rising & 0x80:
                self.state, self.error = "disabled", 0
            return
        if self.button:
            self.state = "disabled"
            return
        stops = (self.state == "enabled") and (word & 0x100 or word & 0x0F != 0x0F)
        if stops:
            self.note("stop")
            if not self.hears():
                return
            self.end_motion()
        if not word & 0x02:
            self.state = "disabled"
        elif word & 0x06 == 0x02:
            self.state = "quick stop" if self.state == "enabled" else self.state
        elif word & 0x07 == 0x06:
            self.state = "ready"
        elif word & 0x0F == 0x07 and self.state != "disabled":
            self.state = "switched on"
        elif word & 0x0F == 0x0F and self.state in ("ready", "switched on", "enabled"):
            self.state = "enabled"
            if not word & 0x100:
                self.start(rising)

    def start(self, rising: int) -> None:
        """Bit 4 starts a move or homing when it rises; a jog follows its velocity at once."""
        mode, velocity = self.setting[reg.MODE][0], number_of(self.setting[reg.TARGET_VELOCITY])
        if mode == reg.PROFILE_VELOCITY and velocity:
            self.begin("jog", velocity / reg.COUNTS_PER_MM_PER_S)
        elif mode == reg.PROFILE_POSITION and rising & 0x10:
            self.begin("move", number_of(self.setting[reg.SPEED]) / -reg.COUNTS_PER_MM_PER_S)
            self.target_mm = number_of(self.setting[reg.TARGET]) / reg.COUNTS_PER_MM + self.offset_mm
        elif mode == reg.HOMING and rising & 0x10:
            self.begin("home", HOME_SPEED)
            self.phase, self.begin_mm = "search", self.axis.position_mm
            if "stale" in self.fault.effects:
                self.fault.began_s = self.now_s
                self.note("fault")
                self.end_motion()
            else:
                self.homed = self.attained = False

    def begin(self, mode: str, speed: float) -> None:
        if mode != "jog" or self.mode != "jog":
            self.note(f"start {mode}")
        self.mode, self.speed = mode, speed
        self.acceleration = number_of(self.setting[reg.ACCELERATION]) / reg.COUNTS_PER_MM_PER_S2
