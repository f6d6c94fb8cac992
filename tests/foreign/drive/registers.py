"""Registers of the simulated drive. Two-word values have their low word first. The axis is reversed: counts decrease
downwards."""

VENDOR, PRODUCT, WATCHDOG_TIME, WATCHDOG_ACTION = 0x2100, 0x2101, 0x2110, 0x2112
DEVICE_TYPE, STATUS, ERROR, POSITION, VELOCITY, INPUTS = 0x3000, 0x3001, 0x3002, 0x3003, 0x3005, 0x3007
RESERVED, RESERVED_WORDS = 0x3008, 24
MODE, TARGET, SPEED, ACCELERATION, TARGET_VELOCITY, CONTROL = 0x4000, 0x4001, 0x4003, 0x4005, 0x4007, 0x4009
VENDOR_ID, PRODUCT_ID, CIA_402 = 0x5A17, 0x0E31, 402

COUNTS_PER_MM, COUNTS_PER_MM_PER_S, COUNTS_PER_MM_PER_S2 = -1024.0, -256.0, 4.0
SHOWN_PER_MM_PER_S = -16.0  # of the velocity register, which is coarse
PROFILE_POSITION, PROFILE_VELOCITY, HOMING = 1, 3, 6

# Bits of the status word: 0x30xx states of CiA 402, 8 moving and 15 homed are the maker's.
MOVING, HOMING_ATTAINED, HOMED = 1 << 8, 1 << 12, 1 << 15
STATES = {"disabled": 0x40, "ready": 0x21, "switched on": 0x23, "enabled": 0x27, "quick stop": 0x07, "fault": 0x08}
POSITIVE_END, NEGATIVE_END, HOME_SWITCH, TORQUE_OFF = 1, 2, 4, 8  # bits of INPUTS

NO_ACTION, QUICK_STOP = 0, 3  # of WATCHDOG_ACTION


class NoRegister(Exception):
    """Raised for addresses that the drive does not have."""


def words_of(value: float, count: int = 2) -> list[int]:
    """Low word first; negative numbers in two's complement."""
    whole = round(value) & (1 << 16 * count) - 1
    return [whole >> 16 * i & 0xFFFF for i in range(count)]


def number_of(words: list[int]) -> int:
    whole = words[0] | words[1] << 16
    return whole - (1 << 32) if whole >> 31 else whole
