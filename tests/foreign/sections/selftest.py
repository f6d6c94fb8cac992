#!/usr/bin/env python3
"""Tests of the judge: sections against closed forms, bodies against their description, and falsified results."""
from __future__ import annotations

import argparse
import contextlib
import io
import json
import pathlib
import sys
import tempfile
import unittest

import numpy as np

import bodies  # first: makes ../plan importable
import claims
import judge
import meshes
import runs
import solids
from areas import Sections
from claims import Outcome

import closed_form
import shapes

SPHERE = closed_form.Sphere(bodies.SPHERE_MM, bodies.SPHERE_FILM_MM)
TILT = bodies.turn((0, 25), (1, 40), (2, 10))


def failed(found: list[claims.Claim]) -> set[str]:
    return {claim.what.split(",")[0] for claim in found if not claim.holds}


class SectionTest(unittest.TestCase):
    def check(self, sections: Sections, expected, share: float = 1e-3) -> None:
        """Compares areas with a function of the height above the middle. Errors are shares of the largest area, because
        those of curved bodies by their triangles are as large near the poles as in the middle."""
        height = sections.top - sections.bottom
        parts = np.linspace(0.02, 0.98, 33)
        exact = np.array([expected((part - 0.5) * height) for part in parts])
        found = np.array([sections.area_mm2(part * height) for part in parts])
        self.assertLess(np.abs(found - exact).max() / exact.max(), share)

    def test_sphere(self):
        for shape in (shapes.icosphere(40, 5), solids.inverted(shapes.icosphere(40, 5))):
            self.check(Sections(shape), lambda z: np.pi * (1600 - z * z))

    def test_box_on_its_face(self):
        self.check(Sections(solids.box((-30, -20, -15), (30, 20, 15))), lambda z: 2400, 1e-5)

    def test_cube_on_its_corner(self):
        upright = shapes.between(np.ones(3), np.array([0.0, 0.0, 1.0]))
        cube = solids.turned(solids.box((-1, -1, -1), (1, 1, 1)), upright)

        def exact(z: float) -> float:  # of x + y + z = s in the unit cube, where s goes from 0 to 3
            s = min(z / np.sqrt(12) * 3 + 1.5, 1.5 - z / np.sqrt(12) * 3)
            return 4 * np.sqrt(3) / 2 * (s * s - 3 * max(s - 1, 0) ** 2)
        self.check(Sections(cube), exact, 1e-5)

    def test_tilted_boxes_have_their_volume(self):
        sections = Sections(solids.turned(solids.box((0, 0, 0), (60, 40, 3)), TILT))
        height, count = sections.top - sections.bottom, 200
        total = sum(sections.area_mm2((i + 0.5) * height / count) for i in range(count)) * height / count
        self.assertLess(abs(total / 7200 - 1), 1e-3)

    def test_torus_lying_and_standing(self):
        lying = solids.torus(30, 10, 200, 100)
        self.check(Sections(lying), lambda z: 4 * np.pi * 30 * np.sqrt(100 - z * z), 2e-3)
        standing = Sections(solids.turned(lying, bodies.turn((0, 90))))
        y = np.linspace(-10, 10, 20001)
        middle = 40.0
        for height in (5.0, 15.0, 25.0):  # through both sides of the ring
            chord = np.sqrt((30 + np.sqrt(100 - y * y)) ** 2 - height ** 2)
            hole = np.sqrt(np.maximum((30 - np.sqrt(100 - y * y)) ** 2 - height ** 2, 0))
            exact = 2 * np.trapz(chord - hole, y)
            self.assertLess(abs(standing.area_mm2(middle + height) / exact - 1), 2e-3)

    def test_two_overlapping_spheres_count_once(self):
        apart, radius = 30.0, 25.0
        both = solids.joined([solids.ellipsoid((x, 0, 0), (radius,) * 3, 5, TILT) for x in (-apart / 2, apart / 2)])

        def exact(z: float) -> float:
            r = np.sqrt(radius ** 2 - z * z)
            half = apart / 2
            lens = 2 * (r * r * np.arccos(half / r) - half * np.sqrt(r * r - half * half)) if r > half else 0
            return 2 * np.pi * r * r - lens
        self.check(Sections(both), exact)

    def test_doubled_faces_count_once(self):
        for inverted in (True, False):
            body = bodies.doubled_sphere(True, inverted, ".stl")
            self.check(Sections(body.shape), lambda z: np.pi * (1600 - z * z), 5e-3)

    def test_ball_within_a_ball_adds_nothing(self):
        inner = solids.inverted(shapes.icosphere(20, 4))
        self.check(Sections(solids.joined([shapes.icosphere(40, 5), inner])), lambda z: np.pi * (1600 - z * z))

    def test_open_body_has_rays_without_end(self):
        lid_off = bodies.body("inner-faces")
        self.assertGreater(Sections(lid_off.posed(lid_off.shape)).area_and_gaps(40)[1], 0)


class BodyTest(unittest.TestCase):
    def test_shells_and_closedness(self):
        for name in bodies.BODIES:
            body = bodies.body(name, small=True)
            with self.subTest(name):
                single, shell = meshes.prepared(meshes.welded(body.shape[0][body.shape[1]]))
                self.assertEqual(shell.max() + 1, body.shells)
                if body.kind in (bodies.SOLID, bodies.LATTICE, bodies.BAD):
                    closed = meshes.without_doubles(single if body.solid is None else body.solid)
                    self.assertEqual(solids.unpaired_edges(closed), 0)
                    self.assertGreater(abs(solids.volume_mm3(closed)), 0)
                else:
                    self.assertGreater(solids.unpaired_edges(single), 0)

    def test_stated_sizes(self):
        for name in bodies.BODIES:
            body = bodies.body(name, small=True)
            extent = np.ptp(body.shape[0] * body.scale, axis=0).max()
            self.assertAlmostEqual(extent / (body.size_mm or extent), 1, 6, name)
        self.assertEqual(bodies.body("helmet").shells, 85)
        self.assertAlmostEqual(len(bodies.body("bracket").shape[1]) / 23000, 1, 1)
        self.assertEqual(len(np.unique(bodies.body("doubled").shape[0], axis=0)), 40962)

    def test_same_every_time(self):
        for name in ("scan", "hedgehog"):
            first, second = (bodies.body(name, small=True).shape[0] for _ in range(2))
            self.assertTrue((first == second).all())

    def test_files_give_the_body_back(self):
        with tempfile.TemporaryDirectory() as folder:
            for name, suffix in (("text", ".stl"), ("hundredth", ".ply")):
                body = bodies.body(name, small=True)
                path = pathlib.Path(folder) / (name + suffix)
                meshes.write(path, body.shape)
                points, triangles = meshes.read(path)
                self.assertTrue((points[triangles] == body.shape[0][body.shape[1]]).all())
            (pathlib.Path(folder) / "text.stl").write_bytes(b"short".ljust(100))
            with self.assertRaises(ValueError):
                meshes.read(pathlib.Path(folder) / "text.stl")

    def test_list_names_every_body(self):
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            bodies.list_bodies(True)
        self.assertEqual([line.split()[0] for line in out.getvalue().splitlines()], list(bodies.BODIES))


class SectionClaimTest(unittest.TestCase):
    def setUp(self):
        balls = [solids.ellipsoid((x, 0, 0), (20, 20, 20), 3) for x in (-10, 10)]
        self.sections = Sections(solids.joined(balls))
        self.depths = np.linspace(0.05, 39.95, 60)

    def report(self, factor: float = 1, depths: np.ndarray | None = None) -> dict:
        depths = self.depths if depths is None else depths
        rows = [{"depth_mm": d, "area_mm2": factor * self.sections.area_mm2(d)} for d in depths]
        return {"depth_mm": 40.0, "sections": rows}

    def of(self, report: dict) -> set[str]:
        return failed(claims.of_sections(report, self.sections))

    def test_true_areas_hold(self):
        self.assertEqual(self.of(self.report()), set())

    def test_wrong_areas_are_found(self):
        self.assertEqual(self.of(self.report(1.02)), {"areas of sections off"})
        report = self.report()
        report["sections"][30]["area_mm2"] *= 2
        self.assertEqual(self.of(report), {"areas of sections off"})
        report["sections"][30]["area_mm2"] = float("nan")
        self.assertEqual(self.of(report), {"areas of sections off"})
        one = Sections(solids.ellipsoid((0, 0, 0), (20, 20, 20), 3))
        report["sections"] = [{"depth_mm": d, "area_mm2": 2 * one.area_mm2(d)} for d in self.depths]
        self.assertEqual(self.of(report), {"areas of sections off"})

    def test_missing_sections_are_found(self):
        self.assertEqual(self.of({"depth_mm": 40.0}), {"sections"})
        self.assertIn("largest step between sections", self.of(self.report(1, self.depths[:30])))

    def test_sections_beyond_the_dip_are_found(self):
        self.assertIn("sections outside the dip", self.of(self.report() | {"depth_mm": 39.0}))

    def test_either_side_of_a_level_face_holds(self):
        steps = solids.blocks([np.array([0.0, 10, 30])] * 3, np.arange(8).reshape(2, 2, 2) % 3 > 0)
        self.sections = Sections(steps)
        around = [self.sections.area_mm2(10 + shift) for shift in (-0.1, 0.1)]
        self.assertGreater(abs(around[0] - around[1]), 10)
        for area in around:
            report = self.report(1, np.arange(1.0, 30, 2))
            report["sections"].append({"depth_mm": 10.0, "area_mm2": area})
            self.assertNotIn("areas of sections off", self.of(report))


class MapClaimTest(unittest.TestCase):
    def setUp(self):
        self.points, _ = shapes.icosphere(SPHERE.radius_mm, 4)
        theta = np.arccos(np.clip(-self.points[:, 2] / SPHERE.radius_mm, -1, 1))
        way = self.points[:, :2] / np.maximum(np.hypot(*self.points[:, :2].T), 1e-9)[:, None]
        self.film = way * SPHERE.film_radius_mm(theta)[:, None]

    def of(self, film: np.ndarray) -> set[str]:
        return failed(claims.of_exact_map(self.points, film, SPHERE, claims.MAP_RMS_MM))

    def test_exact_map_holds(self):
        self.assertEqual(self.of(self.film), set())

    def test_film_that_never_moves_is_found(self):
        self.assertEqual(self.of(self.points[:, :2]), {"distance from the exact map"})

    def test_small_errors_are_found(self):
        self.assertEqual(self.of(self.film + [0.02, 0]), {"distance from the exact map"})
        turn = np.array([(1, 5e-4), (-5e-4, 1)])
        self.assertEqual(self.of(self.film @ turn), {"distance from the exact map"})

    def test_missing_places_are_found(self):
        self.film[np.argmin(self.points[:, 2])] = np.nan
        self.assertEqual(self.of(self.film), {"places of the map without film"})
        self.assertEqual(len(self.of(np.full_like(self.film, np.nan))), 2)


class OtherClaimTest(unittest.TestCase):
    def outcome(self, **changes) -> Outcome:
        return Outcome(**({"status": 0, "killed": False, "seconds": 5.0, "memory_bytes": 1e8,
                           "stages": ("reading", "velocity"), "errors": ()} | changes))

    def test_ends(self):
        def of(**changes) -> set[str]:
            return failed(claims.of_end(self.outcome(**changes), claims.SOLID))
        self.assertEqual(of(), set())
        self.assertEqual(of(seconds=61.0), {"processor time"})
        self.assertEqual(of(memory_bytes=2e9), {"memory"})
        for status in (-11, 1, 4, 139):
            self.assertEqual(of(status=status), {"neither finished nor refused"})
        self.assertEqual(of(status=-9, killed=True), {"neither finished nor refused"})
        self.assertEqual(of(status=3, stages=("reading",), errors=("a.stl: too fine",)), set())
        self.assertEqual(of(status=3, errors=("a.stl: too fine",)), {"refusal after the first solve"})
        self.assertEqual(of(status=3, stages=(), errors=()), {"lines of the refusal more or less than one"})

    def test_flat_plate(self):
        refused = self.outcome(status=3, errors=("a.stl: encloses nothing; give it a thickness",))
        self.assertEqual(failed(claims.of_flat_plate(refused)), set())
        self.assertEqual(len(failed(claims.of_flat_plate(self.outcome()))), 2)
        self.assertEqual(len(failed(claims.of_flat_plate(self.outcome(status=3, errors=("a.stl: bad",))))), 1)

    def test_hollow_bodies(self):
        image = np.full((20, 20, 3), 255, np.uint8)
        image[4:16, 4:16] = (208, 32, 32)
        self.assertEqual(len(failed(claims.of_hollow({"coverage": 1.0}, image))), 1)
        self.assertEqual(failed(claims.of_hollow({"coverage": 0.4}, image)), set())
        image[3, 4:16] = (221, 140, 140)  # the edge of the print
        self.assertEqual(len(failed(claims.of_hollow({"coverage": 1.0}, image))), 1)
        image[4:8, 4:8] = (32, 32, 208)
        self.assertEqual(failed(claims.of_hollow({"coverage": 1.0}, image)), set())

    def test_inner_faces_do_not_count(self):
        points, triangles = bodies.body("bear", small=True).shape
        outer = ~bodies.within_ellipsoids(points, "bear")
        self.assertTrue(0.4 < outer.mean() < 0.95)
        film = np.where(outer[:, None], points[:, :2], np.nan)

        def of(coverage: float) -> set[str]:
            return failed(claims.of_coverage({"coverage": coverage}, (points, triangles), film, outer, 0.995))
        self.assertEqual(of(0.999), set())
        self.assertEqual(of(0.78), {"coverage in the report", "coverage in the report off that share"})
        film[::3] = np.nan
        self.assertIn("share of the outer surface with film in the map", of(0.999))


class RunTest(unittest.TestCase):
    """Stand-ins for the worker are shell scripts."""

    def run_script(self, script: str, most_cpu_s: float = 60, most_wall_s: float = 60) -> Outcome:
        with tempfile.TemporaryDirectory() as folder:
            worker = pathlib.Path(folder) / "worker"
            worker.write_text("#!/bin/sh\n" + script)
            worker.chmod(0o755)
            return runs.run(worker, bodies.body("level-box"), pathlib.Path(folder) / "a", most_cpu_s, most_wall_s)

    def test_refusal(self):
        script = ('for last; do :; done; eval "echo \'{\\"stage\\":\\"reading\\"}\' >&$last"\n'
                  f'echo "{runs.WARNING} odd" >&2; echo "a.stl: bad" >&2; exit 3\n')
        outcome = self.run_script(script)
        self.assertEqual((outcome.status, outcome.stages, outcome.errors), (3, ("reading",), ("a.stl: bad",)))
        self.assertTrue(outcome.refused and outcome.memory_bytes > 0)

    def test_worker_without_end_is_stopped(self):
        self.assertTrue(self.run_script("exec sleep 60\n", most_wall_s=0.3).killed)
        endless = self.run_script("while :; do :; done\n", most_cpu_s=1)
        self.assertTrue(endless.killed and endless.seconds > 0.5)

    def test_crash_is_no_end_by_the_judge(self):
        outcome = self.run_script("kill -11 $$\n")
        self.assertEqual((outcome.status, outcome.killed), (-11, False))

    def test_worker_that_cannot_be_run(self):
        with self.assertRaises(runs.WorkerFailed):
            self.run_script("exit 2\n")
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(runs.WorkerFailed):
            missing = pathlib.Path(folder) / "none"
            runs.run(missing, bodies.body("level-box"), pathlib.Path(folder) / "a", 60, 60)

    def test_exit_status_of_the_judge(self):
        with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(io.StringIO()):
            for status, expected in ((2, 2), (4, 1), (0, 1)):
                worker = pathlib.Path(folder) / f"worker-{status}"
                worker.write_text(f"#!/bin/sh\nexit {status}\n")
                worker.chmod(0o755)
                options = argparse.Namespace(worker=worker, body=["level-box"], small=True, timeout_s=60)
                where = pathlib.Path(folder) / f"runs-{status}"
                where.mkdir()
                with contextlib.redirect_stderr(io.StringIO()):
                    self.assertEqual(judge.judge_bodies(options, where), expected)

    def test_pose_is_of_the_contract(self):
        for name in ("cup", "plate-edge"):
            body = bodies.body(name, small=True)
            pose = json.loads(json.dumps(body.pose()))
            moved = body.posed(body.shape)[0] + pose["translation_mm"]
            self.assertLess(np.abs(moved.min(axis=0) + moved.max(axis=0))[:2].max(), 1e-9)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
