#!/usr/bin/env python3
"""Tests of the simulated drive against closed forms and published frames, and of the judge with falsified outcomes."""
from __future__ import annotations

import os
import socket
import struct
import tomllib
import unittest

import claims
import drive_profile
import registers as at
import rows
import wires
from axis import STEP_S, Axis, move_time_s
from claims import Outcome, Sight
from drive import Drive
from faults import Fault
from simulator import Record, Setup, Simulator


class AxisTest(unittest.TestCase):
    def moved(self, distance: float, speed: float, acceleration: float) -> tuple[float, float, Axis]:
        """Duration and largest speed of a move."""
        axis, steps, largest = Axis(0.0, low_mm=-100.0), 0, 0.0
        while not axis.step_towards(distance, speed, acceleration):
            steps, largest = steps + 1, max(largest, abs(axis.velocity))
            self.assertLess(steps, 10 ** 6)
        return steps * STEP_S, largest, axis

    def test_moves_take_the_time_of_a_trapezoid_or_triangle(self):
        for distance, speed, acceleration in ((100, 20, 200), (1, 20, 200), (0.05, 5, 200), (-30, 7, 50)):
            took, largest, axis = self.moved(distance, speed, acceleration)
            self.assertAlmostEqual(took, move_time_s(abs(distance), speed, acceleration), delta=0.006)
            self.assertLessEqual(largest, min(speed, (acceleration * abs(distance)) ** 0.5) + acceleration * STEP_S)
            self.assertEqual((axis.position_mm, axis.velocity), (distance, 0.0))

    def test_braking_distance_is_v2_over_2a(self):
        axis = Axis(0.0, velocity=20.0)
        while axis.velocity:
            axis.step(0, 250)
        self.assertAlmostEqual(axis.position_mm, 20 ** 2 / 500, delta=1e-9)

    def test_a_hard_end_stops_the_axis(self):
        axis = Axis(300.0, velocity=100.0)
        for _ in range(200):
            axis.step(100, 1000)
        self.assertEqual((axis.position_mm, axis.velocity), (axis.high_mm, 0.0))


def enabled(position_mm: float = 100.0, **options: object) -> Drive:
    out = Drive(Axis(position_mm), **options)
    for word in (0x06, 0x07, 0x0F):
        out.write(at.CONTROL, [word])
    out.heard()
    return out


def jog(machine: Drive, speed: float) -> None:
    machine.write(at.MODE, [3, 0, 0, 0, 0, *at.words_of(800), *at.words_of(at.COUNTS_PER_MM_PER_S * speed), 0x0F])


def run(machine: Drive, seconds: float, talks: bool = True) -> None:
    for _ in range(round(seconds / STEP_S)):
        if talks:
            machine.heard()
        machine.advance(machine.now_s + STEP_S * 1.001)


class DriveTest(unittest.TestCase):
    def test_the_states_follow_each_other_as_in_cia_402(self):
        machine = Drive(Axis(0.0))
        machine.write(at.CONTROL, [0x0F])
        self.assertEqual(machine.state, "disabled")  # not ready to switch on
        for word, status in ((0x06, 0x21), (0x07, 0x23), (0x0F, 0x27)):
            machine.write(at.CONTROL, [word])
            self.assertEqual(machine.read(at.STATUS, 1)[0] & 0x6F, status)
        machine.fail(0x3210)
        self.assertEqual(machine.read(at.STATUS, 2), [0x08, 0x3210])
        machine.write(at.CONTROL, [0x0F])
        self.assertEqual(machine.state, "fault")
        machine.write(at.CONTROL, [0x80])
        self.assertEqual(machine.state, "disabled")

    def test_the_watchdog_stops_the_axis_after_its_time(self):
        machine = enabled(watchdog_s=0.25)
        jog(machine, 20)
        run(machine, 1.0)
        begin_s, begin_mm = machine.now_s, machine.axis.position_mm
        run(machine, 1.0, talks=False)
        acted = next(event for event in machine.events if event.what == "watchdog")
        self.assertAlmostEqual(acted.at_s - begin_s, 0.25, delta=0.003)
        self.assertAlmostEqual(machine.axis.position_mm - begin_mm, 20 * 0.25 + 20 ** 2 / 500, delta=0.05)
        self.assertEqual((machine.state, machine.axis.velocity), ("fault", 0.0))

    def test_homing_ends_at_the_switch_with_zero_there(self):
        machine = enabled(20.0)
        self.assertFalse(machine.homed)
        machine.write(at.MODE, [at.HOMING])
        machine.write(at.CONTROL, [0x1F])
        run(machine, 3.0)
        self.assertTrue(machine.homed)
        self.assertAlmostEqual(machine.reported_mm(), 0.0, delta=0.02)
        self.assertAlmostEqual(machine.axis.position_mm, 0.0, delta=0.02)

    def test_registers_have_the_low_word_first_and_count_backwards(self):
        machine = enabled(0.0)
        machine.offset_mm = -70.0
        low, high = machine.read(at.POSITION, 2)
        self.assertAlmostEqual(struct.unpack(">i", struct.pack(">HH", high, low))[0], -70 * 1024, delta=1)
        with self.assertRaises(at.NoRegister):
            machine.read(at.RESERVED + at.RESERVED_WORDS, 1)

    def test_a_halt_stops_and_nothing_starts_again_by_itself(self):
        machine = enabled()
        jog(machine, 5)
        run(machine, 0.5)
        machine.write(at.CONTROL, [0x10F])
        run(machine, 0.5)
        self.assertEqual(machine.axis.velocity, 0.0)
        machine.write(at.CONTROL, [0x0F])
        run(machine, 0.5)
        self.assertEqual(machine.axis.velocity, 0.0)


class FaultTest(unittest.TestCase):
    def jogged(self, effects: dict) -> Drive:
        machine = enabled()
        machine.set_fault(Fault("jog", 0.3, effects))
        jog(machine, 5)
        run(machine, 0.6)
        return machine

    def test_a_runaway_has_its_speed_until_it_is_stopped(self):
        machine = self.jogged({"run": 25})
        self.assertAlmostEqual(machine.axis.velocity, 25)
        machine.write(at.CONTROL, [0x10F])
        run(machine, 0.2)
        self.assertEqual(machine.axis.velocity, 0.0)

    def test_a_deaf_drive_goes_on_until_its_watchdog_acts(self):
        machine = self.jogged({"deaf": True})
        machine.write(at.CONTROL, [0x10F])
        run(machine, 0.5)
        self.assertAlmostEqual(machine.axis.velocity, 5)
        run(machine, 0.5, talks=False)
        self.assertEqual(machine.axis.velocity, 0.0)

    def test_frozen_registers_stand_still_while_the_other_one_lives(self):
        machine = self.jogged({"freeze_position": True})
        before = machine.read(at.POSITION, 4)
        run(machine, 0.2)
        self.assertEqual(machine.read(at.POSITION, 4), before)
        self.assertEqual(at.number_of(before[2:]), round(5 * at.SHOWN_PER_MM_PER_S))
        machine = self.jogged({"freeze_velocity": True})
        self.assertEqual(machine.read(at.VELOCITY, 2), [0, 0])

    def test_a_jump_moves_the_register_and_not_the_axis(self):
        machine = enabled()
        machine.set_fault(Fault("rest", 0.01, {"jump": 30}))
        run(machine, 0.1)
        self.assertAlmostEqual(machine.reported_mm(), 30.0)
        self.assertEqual(machine.axis.position_mm, 100.0)

    def test_power_loss_forgets_the_home_position(self):
        machine = enabled()
        machine.homed = True
        machine.set_fault(Fault("rest", 0.01, {"off_s": 0.2}))
        run(machine, 0.1)
        self.assertTrue(machine.off)
        run(machine, 0.2)
        self.assertEqual((machine.off, machine.homed, machine.state), (False, False, "disabled"))


class WireTest(unittest.TestCase):
    def test_checksums_agree_with_published_frames(self):
        # MODBUS over Serial Line V1.02, 6.2.2: 02 07 has the checksum 41 12.
        self.assertEqual(wires.crc(bytes([0x02, 0x07])), bytes([0x41, 0x12]))
        self.assertEqual(wires.crc(b"123456789"), bytes([0x37, 0x4B]))  # check value of CRC-16/MODBUS: 0x4B37

    def test_replies_have_the_layout_of_the_specification(self):
        machine = enabled()
        reply = wires.answer(machine, struct.pack(">BHH", 3, at.DEVICE_TYPE, 2))
        self.assertEqual(reply[:4], bytes([3, 4, 402 >> 8, 402 & 0xFF]))
        self.assertEqual(wires.answer(machine, struct.pack(">BHH", 3, 9, 1)), bytes([0x83, 2]))
        self.assertEqual(wires.answer(machine, bytes([43, 14])), bytes([0xAB, 1]))
        self.assertEqual(wires.answer(machine, struct.pack(">BHHBH", 16, at.MODE, 1, 2, 3)),
                         struct.pack(">BHH", 16, at.MODE, 1))

    def request(self) -> bytes:
        frame = bytes([wires.UNIT]) + struct.pack(">BHH", 3, at.DEVICE_TYPE, 1)
        return frame + wires.crc(frame)

    def replies(self, kind: str) -> list[tuple[float, bytes]]:
        """What a line sends for one request while this goes wrong, and after which time."""
        machine = enabled()
        wire = wires.RtuWire(machine)
        wire.strike = wires.Strike(kind, 0.0) if kind else None
        os.write(wire.slave, self.request())
        wire.serve(wire.channels[0])
        wire.close()
        return [(item.due_s - machine.now_s, item.data) for item in wire.channels[0].waiting]

    def test_replies_go_wrong_as_asked(self):
        (after_s, good), = self.replies("")
        self.assertEqual(wires.crc(good[:-2]), good[-2:])
        self.assertLess(after_s, 0.01)
        self.assertEqual(self.replies("lost"), [])
        (_, damaged), = self.replies("damaged")
        self.assertNotEqual(wires.crc(damaged[:-2]), damaged[-2:])
        self.assertEqual([data for _, data in self.replies("doubled")], [good, good])
        for kind in ("late", "delayed"):
            (after_s, data), = self.replies(kind)
            self.assertEqual((round(after_s, 6), data), (wires.LATE_S, good))

    def test_the_process_answers_over_tcp_and_cuts_connections_when_its_power_is_off(self):
        with Simulator(Setup("tcp")) as simulator:
            client = socket.create_connection(("127.0.0.1", int(simulator.endpoint.rsplit(":", 1)[1])), timeout=5)
            client.sendall(struct.pack(">HHHBBHH", 9, 0, 6, wires.UNIT, 3, at.VENDOR, 2))
            reply = client.recv(100)
            self.assertEqual(struct.unpack(">HHHBBBHH", reply),
                             (9, 0, 7, wires.UNIT, 3, 4, at.VENDOR_ID, at.PRODUCT_ID))
            simulator.set_fault(Fault("rest", 0.0, {"off_s": 0.05}))
            self.assertEqual(client.recv(100), b"")
            client.close()

    def test_the_profile_is_toml_with_the_registers_of_the_drive(self):
        values = tomllib.loads(drive_profile.text())
        self.assertEqual(values["position"]["address"], at.POSITION)
        self.assertLess(values["position"]["counts_per_mm"], 0)
        self.assertLess(values["timing"]["response_timeout_s"], wires.LATE_S)
        self.assertLess(wires.LATE_S, values["timing"]["worst_delay_s"])


def outcome(row: rows.Row, notices_after_s: float = 0.1, cause: str = "", state: str = "", homed: bool = False,
            stops: bool = True) -> Outcome:
    """The outcome of a jog at 5 mm/s in which the fault `row` happens after 0.5 s."""
    machine = enabled()
    machine.set_fault(Fault("jog", 0.5, dict(row.effects)))
    jog(machine, 5)
    run(machine, 0.5 + notices_after_s)
    if stops:
        machine.write(at.CONTROL, [0x10F])
    run(machine, 0.5)
    record = Record(machine.now_s, machine.events, machine.trace, machine.messages_s, [], None)
    last = Sight(machine.now_s, state or row.final[0], cause or row.causes[0], homed, "FAILED")
    return Outcome(record, [last], drive_profile.WATCHDOG_S)


def failed(row: rows.Row, measured: Outcome) -> set[str]:
    return {claim.what for claim in claims.of_row(row, measured) if not claim.holds}


class JudgeTest(unittest.TestCase):
    RUNAWAY = rows.NAMES["jog-runaway"]

    def test_a_stop_in_time_holds(self):
        self.assertEqual(failed(self.RUNAWAY, outcome(self.RUNAWAY)), set())

    def test_what_is_noticed_late_is_found(self):
        self.assertIn("noticed after", failed(self.RUNAWAY, outcome(self.RUNAWAY, notices_after_s=0.25)))

    def test_one_millimetre_may_take_longer_than_the_time(self):
        row = rows.NAMES["jog-velocity-frozen"]
        self.assertEqual(failed(row, outcome(row, notices_after_s=0.19)), set())
        self.assertIn("noticed after", failed(row, outcome(row, notices_after_s=0.22)))

    def test_a_jump_of_the_register_is_travel(self):
        row = rows.NAMES["jog-position-jumps"]
        self.assertIn("noticed after", failed(row, outcome(row, notices_after_s=0.19)))

    def test_an_axis_that_does_not_stop_is_found(self):
        self.assertIn("at rest after that", failed(self.RUNAWAY, outcome(self.RUNAWAY, stops=False)))

    def test_wrong_words_are_found(self):
        self.assertEqual(failed(self.RUNAWAY, outcome(self.RUNAWAY, cause="LINK_LOST")), {"cause"})
        self.assertEqual(failed(self.RUNAWAY, outcome(self.RUNAWAY, state="IDLE")), {"state"})
        self.assertEqual(failed(self.RUNAWAY, outcome(self.RUNAWAY, homed=True)), {"homed afterwards"})

    def test_a_fault_that_did_not_happen_proves_nothing(self):
        row = rows.NAMES["move-overspeed"]
        machine = enabled()
        record = Record(machine.now_s, [], [], [], [], None)
        self.assertEqual(failed(row, Outcome(record, [Sight(0, "FAULT", "OVERSPEED", False, "FAILED")], 0.25)),
                         {"the fault occurred"})

    def test_a_drive_that_ignores_stops_needs_silence(self):
        row = rows.NAMES["jog-deaf"]
        talking = outcome(row, stops=True)
        self.assertIn("noticed after", failed(row, talking))


if __name__ == "__main__":
    unittest.main()
