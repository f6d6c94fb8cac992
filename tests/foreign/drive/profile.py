"""The simulated drive's profile for hydroprintd. hardware/profiles/virtual.toml explains the keys."""
from __future__ import annotations

import drive
from wires import UNIT

MAX_SPEED = 20.0  # mm/s


def two_words(key: str, address: int, factor: str, value: float) -> str:
    return (f'[{key}]\nspace = "holding"\naddress = {address}\nwords = 2\nsigned = true\nlow_word_first = true\n'
            f"{factor} = {value}\n")


def number(factor: str, value: float, signed: bool) -> str:
    return f"{{ words = 2, signed = {str(signed).lower()}, low_word_first = true, {factor} = {value} }}"


def bit(address: int, mask: int) -> str:
    return f'{{ space = "holding", address = {address}, bit = {mask.bit_length() - 1} }}'


def request(address: int, *values: object) -> str:
    return f"{{ address = {address}, values = [{', '.join(str(v) if isinstance(v, int) else repr(v) for v in values)}] }}"


def text(largest_watchdog_s: float = 0.25) -> str:
    """TOML. The axis is reversed, so a jog downwards has a negative velocity."""
    def start(mode: int, target: object, speed: object, velocity: object, control: int) -> str:
        places = [mode, *([target] if isinstance(target, str) else [0, 0]), *([speed] if isinstance(speed, str) else [0, 0]),
                  "acceleration", *([velocity] if isinstance(velocity, str) else [0, 0]), control]
        return request(drive.MODE, *places)

    clear = request(drive.CONTROL, 0x0F)
    return "\n".join([
        'name = "judge"', "tried_on_hardware = false", "virtual = true", f"unit = {UNIT}",
        "single_writes_by_fc16 = false", "",
        "[motion]", f"max_speed_mm_per_s = {MAX_SPEED}", f"acceleration_mm_per_s2 = {drive.HOME_ACCELERATION}",
        f"stopping_deceleration_mm_per_s2 = {drive.HOME_ACCELERATION}", "jog_refresh_s = 0.05", "jog_dead_man_s = 0", "",
        "[timing]", "response_timeout_s = 0.05", "worst_delay_s = 0.13", "",
        "[[identity]]", 'space = "holding"', f"address = {drive.VENDOR}", f"value = {drive.VENDOR_ID}",
        'meaning = "vendor"', "",
        "[[identity]]", 'space = "holding"', f"address = {drive.PRODUCT}", f"value = {drive.PRODUCT_ID}",
        'meaning = "product"', "",
        "[[block]]", 'space = "holding"', f"address = {drive.DEVICE_TYPE}",
        f"count = {drive.RESERVED - drive.DEVICE_TYPE}",
        f'mark = {{ address = {drive.DEVICE_TYPE}, value = {drive.CIA_402}, meaning = "device type" }}', "",
        two_words("position", drive.POSITION, "counts_per_mm", drive.COUNTS_PER_MM),
        two_words("velocity", drive.VELOCITY, "counts_per_mm_per_s", drive.COUNTS_PER_MM_PER_S),
        "[alarm_code]", 'space = "holding"', f"address = {drive.ERROR}", "",
        "[status]", f"enabled = {bit(drive.STATUS, 4)}", f"homed = {bit(drive.STATUS, drive.HOMED)}",
        f"moving = {bit(drive.STATUS, drive.MOVING)}", f"alarm = {bit(drive.STATUS, 8)}",
        f"positive_end = {bit(drive.INPUTS, drive.POSITIVE_END)}",
        f"negative_end = {bit(drive.INPUTS, drive.NEGATIVE_END)}",
        f"home_switch = {bit(drive.INPUTS, drive.HOME_SWITCH)}", f"stop_input = {bit(drive.INPUTS, drive.TORQUE_OFF)}", "",
        "[write]", f"position = {number('counts_per_mm', drive.COUNTS_PER_MM, True)}",
        f"speed = {number('counts_per_mm_per_s', -drive.COUNTS_PER_MM_PER_S, True)}",
        f"acceleration = {number('counts_per_mm_per_s2', drive.COUNTS_PER_MM_PER_S2, False)}",
        f"deceleration = {number('counts_per_mm_per_s2', drive.COUNTS_PER_MM_PER_S2, False)}", "",
        "[commands]",
        f"enable = [{request(drive.CONTROL, 0x06)}, {request(drive.CONTROL, 0x07)}, {clear}]",
        f"disable = [{request(drive.CONTROL, 0x06)}]",
        f"home = [{clear}, {request(drive.MODE, drive.HOMING)}, {request(drive.CONTROL, 0x1F)}]",
        f"move = [{clear}, {start(drive.PROFILE_POSITION, 'position', 'speed', 0, 0x1F)}]",
        f"jog_positive = [{start(drive.PROFILE_VELOCITY, 0, 0, '-speed', 0x0F)}]",
        f"jog_negative = [{start(drive.PROFILE_VELOCITY, 0, 0, 'speed', 0x0F)}]",
        f"stop = [{request(drive.CONTROL, 0x010F)}]",
        f"reset_fault = [{request(drive.CONTROL, 0x00)}, {request(drive.CONTROL, 0x80)}]", "",
        "[watchdog]", f"largest_time_s = {largest_watchdog_s}",
        f'time = {{ space = "holding", address = {drive.WATCHDOG_TIME}, words = 2, low_word_first = true, '
        "counts_per_s = 1000.0 }",
        f'action = {{ space = "holding", address = {drive.WATCHDOG_ACTION} }}',
        f"stopping_actions = [{drive.QUICK_STOP}]", "",
        "[[alarm]]", f"code = {drive.COMMUNICATION_LOST}", 'text = "no message from the daemon"', 'hint = "check the cable"',
        "", "[[alarm]]", "code = 0x3210", 'text = "voltage too high"', 'hint = "check the supply"', ""])
