#!/usr/bin/env python3
"""Tests of the judge: plans and films made from the closed forms hold, and falsified ones do not."""
from __future__ import annotations

import pathlib
import sys
import tempfile
import unittest

import numpy as np

import claims
import closed_form
import judge
import ply
import png
import shapes
from selftest_colour import ColourTest  # noqa: F401, run by main()
from selftest_turned import TurnedDipTest, TurnTest  # noqa: F401, run by main()

SPHERE = closed_form.Sphere(40, 105)
LIMITS = claims.Limits()
DPI = 100


def sphere_plan(width_mm: float = 5, seam_mm: float = 0) -> ply.Mesh:
    """The exact plan of a sphere, with its seam shifted upwards."""
    points, triangles = shapes.icosphere(40, 5)
    theta = np.arccos(np.clip(-points[:, 2] / 40, -1, 1))
    shifted = theta - seam_mm / 40
    beyond_mm = 40 * (shifted - np.pi / 2)
    first = np.where(theta < np.radians(170), SPHERE.stretch(shifted), np.nan)
    second = np.where(theta > np.radians(10), SPHERE.stretch(np.pi - shifted), np.nan)
    return mesh_of(points, triangles, np.where(beyond_mm < 0, 1, 2),
                   [closed_form.weight(beyond_mm, width_mm), closed_form.weight(-beyond_mm, width_mm)], [first, second])


def mesh_of(points: np.ndarray, triangles: np.ndarray, dip: np.ndarray, weights: list, stretch: list) -> ply.Mesh:
    names = ["x", "y", "z", "dip", "weight_1", "weight_2", "stretch_1", "stretch_2"]
    vertices = np.zeros(len(points), [(name, "i4" if name == "dip" else "f8") for name in names])
    for name, values in zip(names, [*points.T, dip, *weights, *stretch]):
        vertices[name] = values
    return ply.Mesh(vertices, triangles)


def film(width_mm: float = 5, shift_px: int = 0, ink_of=lambda w: w) -> np.ndarray:
    """The exact first film of a plain red sphere."""
    size = round(210 * DPI / 25.4)
    middle = (np.arange(size) + 0.5 - size / 2) * 25.4 / DPI
    theta = SPHERE.theta_rad(np.hypot(middle[None], middle[:, None]))
    ink = ink_of(closed_form.weight(40 * (theta - np.pi / 2), width_mm))
    out = np.round(255 - 255 * ink[:, :, None] * np.array([0, 1, 1])).astype(np.uint8)
    return np.roll(out, shift_px, axis=1)


def failed(found: list[claims.Claim]) -> set[str]:
    return {claim.what.split(",")[0] for claim in found if not claim.holds}


class SphereTest(unittest.TestCase):
    def of_plan(self, plan: ply.Mesh) -> set[str]:
        return failed(claims.of_sphere(plan, SPHERE, 5, LIMITS))

    def of_film(self, image: np.ndarray) -> set[str]:
        return failed(claims.of_sphere_film(image, DPI, SPHERE, 5, LIMITS))

    def test_figures_of_the_notes(self):
        theta = np.radians([10, 30, 60, 90, 110, 120, 135, 150])
        r0 = [6.97242041, 20.69636813, 39.74423988, 55.09681288, 62.49930249, 65.32423024, 68.5571922, 70.72089069]
        self.assertLess(np.abs(SPHERE.film_radius_mm(theta) - r0).max(), 1e-8)
        self.assertLess(np.abs(SPHERE.theta_rad(np.array(r0)) - theta).max(), 1e-9)

    def test_exact_plan_and_film_hold(self):
        self.assertEqual(self.of_plan(sphere_plan()), set())
        self.assertEqual(self.of_film(film()), set())

    def test_shifted_seam_is_seen(self):
        self.assertIn("seam off the equator", self.of_plan(sphere_plan(seam_mm=0.2)))

    def test_other_width_is_seen(self):
        self.assertIn("weights off", self.of_plan(sphere_plan(width_mm=6)))
        self.assertIn("share of pixels more than 3 levels off", self.of_film(film(width_mm=6)))

    def test_weights_that_do_not_sum_to_one_are_seen(self):
        plan = sphere_plan()
        plan.vertices["weight_1"] *= 0.9999
        self.assertIn("weights of reached points do not sum to one", self.of_plan(plan))

    def test_weight_without_film_is_seen(self):
        plan = sphere_plan()
        plan.vertices["stretch_1"][plan.points_mm[:, 2] < -39] = np.nan
        self.assertIn("weight where no film arrives", self.of_plan(plan))

    def test_wrong_stretch_is_seen(self):
        plan = sphere_plan()
        for dip in ("1", "2"):
            plan.vertices["stretch_" + dip] *= 1.01
        self.assertEqual(self.of_plan(plan), {"mean stretch of dip 1 off", "mean stretch of dip 2 off"})

    def test_plan_of_one_dip_alone_is_seen(self):
        plan = sphere_plan()
        plan.vertices["dip"] = 1
        self.assertIn("seam off the equator", self.of_plan(plan))

    def test_shifted_film_is_seen(self):
        self.assertIn("share of pixels more than 3 levels off", self.of_film(film(shift_px=2)))

    def test_film_that_is_blended_otherwise_is_seen(self):
        for ink_of in (lambda w: 1 - w, lambda w: w ** 0.9, np.ceil):
            self.assertIn("share of pixels more than 3 levels off", self.of_film(film(ink_of=ink_of)))


class CubeTest(unittest.TestCase):
    def plan(self, tilt: float = 0) -> ply.Mesh:
        """A cube whose faces have 25 x 25 squares, divided at its zigzag; a tilt moves the seam off it."""
        grid = np.linspace(-25, 25, 26)
        u, v = (values.reshape(-1) for values in np.meshgrid(grid, grid))
        faces, triangles = [], []
        square = np.arange(25)[:, None] * 26 + np.arange(25)[None]
        corners = [np.stack([square, square + 1, square + 27], -1), np.stack([square, square + 27, square + 26], -1)]
        for axis in range(3):
            for side in (-25.0, 25.0):
                face = np.insert(np.stack([u, v], 1), axis, side, axis=1)
                triangles += [len(faces) * len(u) + c.reshape(-1, 3) for c in corners]
                faces.append(face)
        points = np.concatenate(faces)
        # The film of each dip is stretched by the distance to the nearest of its own three faces.
        low, high = 25 + points.min(axis=1), 25 - points.max(axis=1)
        shift = tilt * points[:, 0] / 25
        first, second = 1 + low / 50 + shift, 1 + high / 50 - shift
        own = np.where(first < second, 1.0, 0.0)
        return mesh_of(points, np.concatenate(triangles), np.where(own > 0, 1, 2), [own, 1 - own], [first, second])

    def test_zigzag_has_six_edges_of_the_cube(self):
        ends = claims.zigzag(25)
        self.assertTrue((np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) == 50).all())
        self.assertEqual(len({tuple(end) for edge in ends for end in edge}), 6)

    def test_tilted_division_is_seen(self):
        self.assertIn("share of the faces' inner points with the wrong dip", failed(claims.of_cube(self.plan(0.5), 50)))
        self.assertNotIn("share of the faces' inner points with the wrong dip",
                         failed(claims.of_cube(self.plan(), 50)))

    def test_unreached_face_is_seen(self):
        plan = self.plan()
        plan.vertices["dip"][plan.points_mm[:, 0] < -24.9] = 0
        self.assertIn("share of the surface that no dip reaches", failed(claims.of_cube(plan, 50)))


class PlateTest(unittest.TestCase):
    def test_weights_that_pass_through_the_plate_are_seen(self):
        grid = np.linspace(-30, 30, 61)
        u, v = (values.reshape(-1) for values in np.meshgrid(grid, grid))
        points = np.concatenate([np.stack([u, v, np.full_like(u, z)], 1) for z in (-0.75, 0.75)])
        own = np.repeat([1.0, 0.0], len(u))
        triangles = np.array([[0, 1, 2]])
        good = mesh_of(points, triangles, 2 - own, [own, 1 - own], [own + 1, 2 - own])
        self.assertEqual(failed(claims.of_plate(good, (60, 60, 1.5), 5)), set())
        through = 1 - closed_form.weight(np.full(len(own), -1.5), 5)  # 1.5 mm from the other face
        mixed = np.where(own > 0, 1 - through, through)
        bad = mesh_of(points, triangles, 2 - own, [mixed, 1 - mixed], [own + 1, 2 - own])
        self.assertEqual(failed(claims.of_plate(bad, (60, 60, 1.5), 5)), {"weight of the face's own dip below one"})


class FileTest(unittest.TestCase):
    def test_filters_of_png_are_undone(self):
        rng = np.random.default_rng(7)
        for channels in (1, 3):
            image = rng.integers(0, 256, (23, 31, channels))
            padded = np.pad(image, ((1, 0), (1, 0), (0, 0)))
            left, up, corner = padded[1:, :-1], padded[:-1, 1:], padded[:-1, :-1]
            guesses = [0 * left, left, up, (left + up) // 2, png.paeth(left, up, corner)]
            kinds = rng.integers(0, 5, 23)
            filtered = np.stack([(image[y] - guesses[kind][y]) & 255 for y, kind in enumerate(kinds)])
            self.assertTrue((png.unfilter(kinds, filtered.astype(np.uint8)) == image).all())

    def test_written_png_is_read_again(self):
        image = np.random.default_rng(7).integers(0, 256, (23, 31, 3))
        with tempfile.TemporaryDirectory() as folder:
            png.write(pathlib.Path(folder) / "a.png", image)
            self.assertTrue((png.read(pathlib.Path(folder) / "a.png") == image).all())

    def test_paeth_prefers_left_then_up(self):
        for left, up, corner, expected in ((10, 20, 15, 15), (10, 20, 20, 10), (10, 20, 10, 20), (5, 5, 9, 5)):
            self.assertEqual(png.paeth(np.array(left), np.array(up), np.array(corner)), expected)

    def test_truncated_ply_is_refused(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.ply"
            head = ("ply\nformat binary_little_endian 1.0\ncomment x\nelement vertex 1\nproperty double x\n"
                    "property double y\nproperty double z\nproperty int dip\nelement face 1\n"
                    "property list uchar int vertex_indices\nend_header\n").encode()
            body = np.array([1, 2, 3], "<f8").tobytes() + np.array([4], "<i4").tobytes()
            body += b"\x03" + np.array([0, 0, 0], "<i4").tobytes()
            path.write_bytes(head + body)
            self.assertEqual(ply.read(path).vertices["dip"][0], 4)
            self.assertEqual(ply.read(path).points_mm.tolist(), [[1, 2, 3]])
            path.write_bytes(head + body + b"?")
            with self.assertRaises(ValueError):
                ply.read(path)
            path.write_bytes(head.replace(b"end_header", b"property uchar flags\nend_header") + body + b"?")
            self.assertEqual(ply.read(path).triangles.tolist(), [[0, 0, 0]])

    def test_worker_that_fails_is_reported(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(judge.WorkerFailed):
            judge.run_plan(pathlib.Path("/bin/false"), pathlib.Path(folder) / "a", shapes.box((1, 1, 1)), [], 72)

    def test_shapes_are_closed_and_face_outwards(self):
        for points, triangles in (shapes.icosphere(2, 2), shapes.box((1, 2, 3))):
            a, b, c = (points[triangles[:, i]] for i in range(3))
            self.assertTrue(((np.cross(b - a, c - a) * (a + b + c)).sum(axis=1) > 0).all())
            self.assertEqual(len(points) - len(triangles) // 2, 2)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
