"""The simulated drive's profile for hydroprintd. hardware/profiles/virtual.toml explains the keys."""
from __future__ import annotations

from dataclasses import dataclass

import registers as at
from drive import COMMUNICATION_LOST, HOME_ACCELERATION
from wires import UNIT

MAX_SPEED, WATCHDOG_S = 20.0, 0.25  # mm/s


@dataclass(frozen=True)
class Timing:
    """Of the link, as in the profiles that are shipped."""
    response_timeout_s: float = 0.1
    worst_delay_s: float = 0.25


def two_words(key: str, address: int, factor: str, value: float) -> str:
    return (f'[{key}]\nspace = "holding"\naddress = {address}\nwords = 2\nsigned = true\nlow_word_first = true\n'
            f"{factor} = {value}\n")


def number(factor: str, value: float, signed: bool) -> str:
    return f"{{ words = 2, signed = {str(signed).lower()}, low_word_first = true, {factor} = {value} }}"


def bit(address: int, mask: int) -> str:
    return f'{{ space = "holding", address = {address}, bit = {mask.bit_length() - 1} }}'


def request(address: int, *values: object) -> str:
    words = ", ".join(str(value) if isinstance(value, int) else f'"{value}"' for value in values)
    return f"{{ address = {address}, values = [{words}] }}"


def text(timing: Timing = Timing()) -> str:
    """TOML. The axis is reversed, so a jog downwards has a negative velocity."""
    def jog(velocity: str) -> str:
        return request(at.MODE, at.PROFILE_VELOCITY, 0, 0, 0, 0, "acceleration", velocity, 0x0F)

    clear = request(at.CONTROL, 0x0F)
    move = request(at.MODE, at.PROFILE_POSITION, "position", "speed", "acceleration", 0, 0, 0x1F)
    return "\n".join([
        'name = "judge"', "tried_on_hardware = false", "virtual = true", f"unit = {UNIT}",
        "single_writes_by_fc16 = false", "",
        "[motion]", f"max_speed_mm_per_s = {MAX_SPEED}", f"acceleration_mm_per_s2 = {HOME_ACCELERATION}",
        f"stopping_deceleration_mm_per_s2 = {HOME_ACCELERATION}", "jog_refresh_s = 0.05", "jog_dead_man_s = 0", "",
        "[timing]", f"response_timeout_s = {timing.response_timeout_s}", f"worst_delay_s = {timing.worst_delay_s}", "",
        "[[identity]]", 'space = "holding"', f"address = {at.VENDOR}", f"value = {at.VENDOR_ID}",
        'meaning = "vendor"', "",
        "[[identity]]", 'space = "holding"', f"address = {at.PRODUCT}", f"value = {at.PRODUCT_ID}",
        'meaning = "product"', "",
        "[[block]]", 'space = "holding"', f"address = {at.DEVICE_TYPE}",
        f"count = {at.RESERVED - at.DEVICE_TYPE}",
        f'mark = {{ address = {at.DEVICE_TYPE}, value = {at.CIA_402}, meaning = "device type" }}', "",
        two_words("position", at.POSITION, "counts_per_mm", at.COUNTS_PER_MM),
        two_words("velocity", at.VELOCITY, "counts_per_mm_per_s", at.SHOWN_PER_MM_PER_S),
        "[alarm_code]", 'space = "holding"', f"address = {at.ERROR}", "",
        "[status]", f"enabled = {bit(at.STATUS, 4)}", f"homed = {bit(at.STATUS, at.HOMED)}",
        f"moving = {bit(at.STATUS, at.MOVING)}", f"alarm = {bit(at.STATUS, 8)}",
        f"positive_end = {bit(at.INPUTS, at.POSITIVE_END)}",
        f"negative_end = {bit(at.INPUTS, at.NEGATIVE_END)}",
        f"home_switch = {bit(at.INPUTS, at.HOME_SWITCH)}", f"stop_input = {bit(at.INPUTS, at.TORQUE_OFF)}", "",
        "[write]", f"position = {number('counts_per_mm', at.COUNTS_PER_MM, True)}",
        f"speed = {number('counts_per_mm_per_s', -at.COUNTS_PER_MM_PER_S, True)}",
        f"acceleration = {number('counts_per_mm_per_s2', at.COUNTS_PER_MM_PER_S2, False)}",
        f"deceleration = {number('counts_per_mm_per_s2', at.COUNTS_PER_MM_PER_S2, False)}", "",
        "[commands]",
        f"enable = [{request(at.CONTROL, 0x06)}, {request(at.CONTROL, 0x07)}, {clear}]",
        f"disable = [{request(at.CONTROL, 0x06)}]",
        f"home = [{clear}, {request(at.MODE, at.HOMING)}, {request(at.CONTROL, 0x1F)}]",
        f"move = [{clear}, {move}]", f"jog_positive = [{jog('-speed')}]", f"jog_negative = [{jog('speed')}]",
        f"stop = [{request(at.CONTROL, 0x010F)}]",
        f"reset_fault = [{request(at.CONTROL, 0x00)}, {request(at.CONTROL, 0x80)}]", "",
        "[watchdog]", f"largest_time_s = {WATCHDOG_S}",
        f'time = {{ space = "holding", address = {at.WATCHDOG_TIME}, words = 2, low_word_first = true, '
        "counts_per_s = 1000.0 }",
        f'action = {{ space = "holding", address = {at.WATCHDOG_ACTION} }}',
        f"stopping_actions = [{at.QUICK_STOP}]", "",
        "[[alarm]]", f"code = {COMMUNICATION_LOST}", 'text = "no message from the daemon"', 'hint = "check the cable"',
        "", "[[alarm]]", "code = 0x3210", 'text = "voltage too high"', 'hint = "check the supply"', ""])
