#!/usr/bin/env python3
"""Tests of the judge: films made from its own formulas hold, and falsified ones do not."""
from __future__ import annotations

import dataclasses
import json
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

import numpy as np

import cases
import claims
import definition
import expected
import judge
import landing
import pictures
import solids
import synthetic
from cases import GLASS, OVER, PLAIN, TALL
from definition import Layer, Paint, Sites
from pictures import Picture

import png

DPI = 75
FILM = landing.round_film(90)
ROTATION = solids.rotation(OVER)
BALL = solids.icosphere(25, 3)
LANDING = synthetic.ball_landing(BALL, solids.icosphere(25, 4), FILM, ROTATION)
RASTER = landing.raster_of(LANDING, FILM, DPI)

PLANAR = Layer("planar", PLAIN, position_mm=(2.0, -3.0, 4.0), direction=(0.5, 0.8, 0.6), up=(0.2, -0.3, 2.0),
               size_mm=34.0, turn_deg=25.0, repeat=True)
DIP = Layer("dip", TALL, up=(0.9, 0.4, 0.3), size_mm=40.0, turn_deg=-40.0)
CYLINDER = Layer("cylindrical", PLAIN, size_mm=56.0, turn_deg=70.0)
BOX = Layer("box", TALL, direction=(0.4, 1.0, -0.3), size_mm=45.0, blend_mm=9.0)
DECAL = Layer("decal", PLAIN, position_mm=cases.of_film(OVER, (0.3, 0.2, -0.9), 25.0),
              direction=cases.of_film(OVER, (-0.3, -0.2, 0.9)),
              size_mm=36.0, depth_mm=9.0, mirror=True, turn_deg=20.0)
GLAZE = Layer("planar", GLASS, direction=(0.5, 0.8, 0.6), size_mm=50.0, opacity=0.7)


def judged(paint: Paint, film_paint: Paint | None = None, rotation: np.ndarray = ROTATION) -> list[claims.Claim]:
    """The claims about a film that was made from another paint, or with another rotation."""
    image = synthetic.film_image(RASTER, FILM, DPI, film_paint or paint, BALL, rotation)
    return claims.of_print(claims.Print(BALL, paint, ROTATION, FILM, DPI, LANDING, image))[0]


def judged_with(paint: Paint, name: str, replacement) -> list[claims.Claim]:
    """The claims about a film that was made with another function of the definition."""
    with mock.patch.object(definition, name, replacement):
        image = synthetic.film_image(RASTER, FILM, DPI, paint, BALL, ROTATION)
    return claims.of_print(claims.Print(BALL, paint, ROTATION, FILM, DPI, LANDING, image))[0]


def failed(found: list[claims.Claim]) -> set[str]:
    """The claims that do not hold: "colour" (of all points or of a decal's), or the first word."""
    names = [claim.what for claim in found if not claim.holds]
    return {"colour" if "colour" in name else name.split(" ")[0] for name in names}


def over(layer: Layer) -> Paint:
    return Paint((layer,), "#1f4fa8")


class PaintTest(unittest.TestCase):
    def assert_seen(self, layer: Layer, **changes) -> None:
        found = judged(over(layer), over(dataclasses.replace(layer, **changes)))
        self.assertIn("colour", failed(found), changes)

    def test_exact_films_hold(self):
        layers = [case.paint.layers for case in cases.SMALL]
        layers += [(BOX, GLAZE, DECAL), (Layer(colour="#308060"), CYLINDER)]
        for several in [(PLANAR,), (DIP,), (CYLINDER,), (BOX,), (DECAL,), *layers]:
            found = judged(Paint(tuple(several), "#1f4fa8"))
            self.assertEqual(failed(found), set(), [(claim.what, claim.measured) for claim in found])

    def test_mirrored_pictures_are_seen(self):
        for layer in (PLANAR, DIP, CYLINDER, BOX, DECAL):
            self.assert_seen(layer, mirror=not layer.mirror)

    def test_wrong_up_is_seen(self):
        self.assert_seen(PLANAR, up=(0.2, -0.5, 2.0))
        self.assert_seen(DIP, up=(0.9, 0.6, 0.3))
        self.assert_seen(BOX, up=(0.1, 0.0, 1.0))
        self.assert_seen(CYLINDER, up=(0.0, 0.1, 1.0))

    def test_wrong_size_is_seen(self):
        for layer in (PLANAR, DIP, BOX, DECAL):
            self.assert_seen(layer, size_mm=1.05 * layer.size_mm)
        self.assert_seen(CYLINDER, size_mm=80.0)

    def test_wrong_turn_is_seen(self):
        for layer in (PLANAR, DIP, CYLINDER, DECAL):
            self.assert_seen(layer, turn_deg=-layer.turn_deg)

    def test_other_fields_are_seen(self):
        self.assert_seen(PLANAR, repeat=False)
        self.assert_seen(DIP, repeat=True)
        self.assert_seen(PLANAR, position_mm=None)
        self.assert_seen(BOX, blend_mm=15.0)
        self.assert_seen(DECAL, depth_mm=16.0)
        self.assert_seen(DECAL, opacity=0.8)

    def test_dip_and_planar_in_the_other_frame_are_seen(self):
        self.assert_seen(DIP, projection="planar")
        self.assertIn("colour", failed(judged(over(DIP), rotation=np.eye(3))))

    def test_picture_upside_down_is_seen(self):
        codes = Picture.codes
        with mock.patch.object(Picture, "codes", lambda self, u, v: codes(self, u, 1 - v)):
            image = synthetic.film_image(RASTER, FILM, DPI, over(PLANAR), BALL, ROTATION)
        found = claims.of_print(claims.Print(BALL, over(PLANAR), ROTATION, FILM, DPI, LANDING, image))[0]
        self.assertIn("colour", failed(found))

    def test_hard_seam_of_a_box_is_seen(self):
        found = judged_with(over(BOX), "smooth", lambda distance, width: 1e-9 + (distance == 0))
        self.assertLessEqual({"colour", "box"}, failed(found))

    def test_other_blend_of_a_box_is_seen(self):
        found = judged_with(over(BOX), "smooth", lambda distance, width: np.maximum(0, 1 - distance / width))
        self.assertIn("colour", failed(found))

    def test_cylinder_that_does_not_close_is_seen(self):
        with mock.patch.object(definition, "size_mm", lambda layer, frame: (56.0, 56.0 / layer.aspect)):
            image = synthetic.film_image(RASTER, FILM, DPI, over(CYLINDER), BALL, ROTATION)
        found = claims.of_print(claims.Print(BALL, over(CYLINDER), ROTATION, FILM, DPI, LANDING, image))[0]
        self.assertLessEqual({"colour", "cylinder"}, failed(found))

    def test_decal_on_the_back_is_seen(self):
        direction = cases.of_film(OVER, (0.9, 0.2, 0.2))
        sideways = dataclasses.replace(DECAL, direction=direction, position_mm=None, depth_mm=None)
        found = judged_with(over(sideways), "faces_against", lambda normals, frame: np.ones(len(normals), bool))
        self.assertIn("colour", failed(found))

    def test_mixing_of_codes_is_seen(self):
        with mock.patch.object(definition, "to_linear", lambda codes: codes / 255):
            found = judged_with(over(GLAZE), "to_codes", lambda light: 255 * light)
        exact = judged(over(GLAZE))
        self.assertEqual(failed(exact), set())
        self.assertNotEqual(failed(found), set())


class FormulaTest(unittest.TestCase):
    def test_frames_are_as_seen_along_the_direction(self):
        for layer, right, up in ((Layer("planar"), (-1, 0, 0), (0, 1, 0)), (Layer("box"), (1, 0, 0), (0, 0, 1)),
                                 (Layer("cylindrical"), (1, 0, 0), (0, 0, 1))):
            frame = definition.frame_of(layer, BALL, np.eye(3))
            self.assertLess(np.abs(frame.r - right).max() + np.abs(frame.u - up).max(), 1e-12)

    def test_turn_is_counter_clockwise(self):
        layer = Layer("planar", PLAIN, position_mm=(0.0, 0.0, 0.0), direction=(0.0, 1.0, 0.0), turn_deg=90.0)
        frame = definition.frame_of(layer, BALL, np.eye(3))
        place, = definition.on_picture_mm(layer, frame, np.array([[0.0, 0.0, 3.0]]))  # above the middle
        self.assertLess(np.abs(place - [[3, 0]]).max(), 1e-12)  # is the turned picture's right
        around = Layer("cylindrical", PLAIN, turn_deg=90.0)
        frame = definition.frame_of(around, BALL, np.eye(3))
        place, = definition.on_picture_mm(around, frame, np.array([[25.0, 0.0, 0.0]]))
        self.assertLess(np.abs(place).max(), 0.5)  # the middle, turned from the front to the right

    def test_sizes_are_fitted(self):
        bracket = solids.bracket()
        for layer, size in ((Layer("planar", PLAIN), (90, 60)), (Layer("planar", TALL), (60, 96)),
                            (Layer("decal", PLAIN), (60, 40)), (Layer("decal", TALL), (37.5, 60)),
                            (Layer("box", TALL, direction=(1.0, 0.0, 0.0)), (60, 96)),
                            (Layer("planar", TALL, direction=(1.0, 0.0, 0.0)), (40, 64)),
                            (Layer("cylindrical", TALL), (60 * np.pi, 96 * np.pi)),
                            (Layer("cylindrical", TALL, size_mm=100.0), (30 * np.pi, 48 * np.pi)),
                            (Layer("cylindrical", TALL, size_mm=900.0), (60 * np.pi, 96 * np.pi)),
                            (Layer("cylindrical", TALL, size_mm=100.0, repeat=False), (100, 160))):
            frame = definition.frame_of(layer, bracket, np.eye(3))
            self.assertLess(np.abs(np.array(definition.size_mm(layer, frame)) - size).max(), 1e-4, layer)

    def test_weights_at_the_edge_of_two_axes_are_equal(self):
        layer = Layer("box", PLAIN)
        bracket = solids.bracket()
        frame = definition.frame_of(layer, bracket, np.eye(3))
        points = np.array([[30.0, 0.0, 0.0], [30.0, 3.0, 0.0], [30.0, 6.5, 0.0]])
        sites = Sites.on_triangles(points, np.tile([0.0, 0.0, -1.0], (3, 1)))
        weights = definition.box_weights(layer, bracket, frame, sites)
        self.assertLess(np.abs(weights - [[0, 0.5, 0.5], [0, 2 / 3, 1 / 3], [0, 1, 0]]).max(), 1e-6)

    def test_distances_agree_with_a_simple_case(self):
        edges = np.array([[[0.0, 0, 0], [10, 0, 0]], [[0, 20, 0], [0, 30, 5]]])
        points = np.array([[5.0, 3, 4], [-3, 0, 4], [0, 36, 8]])
        self.assertLess(np.abs(definition.distances_mm(points, edges) - [5, 5, np.sqrt(45)]).max(), 1e-9)

    def test_transfer_functions_are_inverse(self):
        codes = np.arange(256.0)
        self.assertLess(np.abs(definition.to_codes(definition.to_linear(codes)) - codes).max(), 0.01)
        self.assertAlmostEqual(float(definition.to_linear(np.array(188.0))), 0.5029, 4)

    def test_figures_of_the_notes(self):
        theta = np.radians([10, 60, 120, 150])
        exact = [6.97242041, 39.74423988, 65.32423024, 70.72089069]
        self.assertLess(np.abs(synthetic.film_radius_mm(40, 105, theta) - exact).max(), 1e-8)


class FileTest(unittest.TestCase):
    def test_solids_are_closed_and_face_outwards(self):
        for solid, volume in ((solids.icosphere(10, 3), 4 / 3 * np.pi * 1000), (solids.bracket(), 27303.2)):
            self.assertEqual(solids.open_edges(solid), 0)
            a, b, c = (solid.points[solid.triangles[:, i]] for i in range(3))
            self.assertLess(abs((np.cross(a, b) * c).sum() / 6 / volume - 1), 0.02)

    def test_no_triangle_is_between_two_axes(self):
        for case in cases.FULL + cases.SMALL:
            for layer in case.paint.layers:
                if layer.kind == "box" and case.solid != "cat":
                    solid = cases.SOLIDS[case.solid](pathlib.Path())
                    frame = definition.frame_of(layer, solid, case.rotation)
                    near = np.sort(np.abs(solid.normals @ frame.axes.T), axis=1)
                    self.assertGreater((near[:, 2] - near[:, 1]).min(), 1e-5, case.name)

    def test_repeats_around_a_cylinder_are_not_ambiguous(self):
        for case in cases.FULL + cases.SMALL:
            for layer in case.paint.layers:
                if layer.kind == "cylindrical" and layer.repeats and case.solid != "cat":
                    solid = cases.SOLIDS[case.solid](pathlib.Path())
                    radius = definition.cylinder_radius_mm(definition.frame_of(layer, solid, case.rotation))
                    count = 2 * np.pi * radius / (layer.size_mm or 2 * np.pi * radius)
                    self.assertLess(abs(count - round(count)), 0.4, case.name)

    def test_pictures_are_read_again_and_keep_their_range(self):
        with tempfile.TemporaryDirectory() as folder:
            for picture in (PLAIN, TALL, GLASS):
                path = pathlib.Path(folder) / picture.name
                pictures.write_png(path, picture.pixels())
                self.assertTrue((png.read(path) == picture.pixels()).all())
                colours = picture.pixels()[:, :, :3]
                self.assertTrue((colours >= 60).all() and (colours <= 200).all())

    def test_expected_places_are_the_same_for_the_same_seed(self):
        with tempfile.TemporaryDirectory() as folder:
            texts = []
            for seed in (1, 1, 2):
                expected.write(pathlib.Path(folder) / "a.json", seed)
                texts.append((pathlib.Path(folder) / "a.json").read_text())
        self.assertEqual(texts[0], texts[1])
        self.assertNotEqual(texts[0], texts[2])
        self.assertEqual({len(case["uv"]) for case in json.loads(texts[0])["cases"]}, {200})

    def test_worker_that_fails_is_reported(self):
        with tempfile.TemporaryDirectory() as folder, self.assertRaises(judge.WorkerFailed):
            judge.run(pathlib.Path("/bin/false"), cases.SMALL[0], BALL, pathlib.Path(folder) / "a")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[1:]])
