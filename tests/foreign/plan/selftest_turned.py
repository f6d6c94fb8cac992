"""Tests of the claims about a dip at a turned pose: images made from the closed form hold, and falsified ones do not. Run by
selftest.py."""
from __future__ import annotations

import dataclasses
import unittest

import numpy as np

import claims
import closed_form
import judge
import shapes
import turned

SPHERE = closed_form.Sphere(40, 105)
DPI = 200
TURN = shapes.after(shapes.about_line(judge.TILTED, np.radians(8)), judge.TURN_OVER)
POLE = shapes.rotation(TURN) @ np.array([0.0, 0.0, 1.0])
SEAM = "seam off the object's equator"
COLOURS = "share of pixels more than 3 levels off"


def images(pole: np.ndarray = POLE, shift_mm: float = 0, width_mm: float = 5) -> turned.Images:
    """The exact images of a plain red sphere, with the seam shifted beyond the own side."""
    size = round(2 * SPHERE.film_mm * DPI / 25.4)
    x_mm, y_mm = claims.film_grid_mm((size, size), DPI)
    beyond_mm = SPHERE.beyond_mm(x_mm[None, :], y_mm[:, None], pole) - shift_mm
    weight = closed_form.weight(beyond_mm, width_mm)[:, :, None]
    ink = np.array([0, 255, 255])
    return turned.Images(np.round(255 - weight * ink), np.broadcast_to(255 - ink, (size, size, 3)),
                         np.round(255 * np.repeat(weight, 3, axis=2)))


def failed(made: turned.Images, seam_mm: float = 0.1) -> set[str]:
    found = turned.of_turned_dip(made, DPI, SPHERE, POLE, 5, claims.Limits(), seam_mm)
    return {claim.what.split(",")[0] for claim in found if not claim.holds}


class TurnedDipTest(unittest.TestCase):
    def test_exact_images_hold(self):
        self.assertEqual(failed(images(), seam_mm=0.03), set())

    def test_mask_that_turns_with_the_pose_is_seen(self):
        self.assertLessEqual({SEAM, COLOURS}, failed(images(pole=claims.LOWEST)))

    def test_turn_in_the_other_direction_is_seen(self):
        back = shapes.after(shapes.about_line(judge.TILTED, np.radians(-8)), judge.TURN_OVER)
        self.assertLessEqual({SEAM, COLOURS}, failed(images(pole=shapes.rotation(back) @ np.array([0.0, 0.0, 1.0]))))

    def test_shifted_seam_is_seen(self):
        for shift_mm in (0.2, -0.2):
            self.assertIn(SEAM, failed(images(shift_mm=shift_mm)))
            self.assertIn(SEAM, failed(images(shift_mm=2 * shift_mm), seam_mm=0.24))  # the limit of --small

    def test_weights_of_the_other_dip_are_seen(self):
        self.assertIn("share of the azimuths without a seam", failed(images(pole=-POLE)))

    def test_weights_that_are_not_applied_are_seen(self):
        made = images()
        found = failed(dataclasses.replace(made, film=made.complete))
        self.assertEqual(found, {COLOURS, "share of pixels of film.png that are not complete.png seen through mask.png"})
        whole = dataclasses.replace(made, film=made.complete, mask=np.full_like(made.mask, 255))
        self.assertEqual(failed(whole), {COLOURS, "share of the azimuths without a seam", SEAM})

    def test_other_width_is_seen(self):
        self.assertIn(COLOURS, failed(images(width_mm=6)))

    def test_other_film_at_the_planned_pose_is_seen(self):
        film = images().film
        self.assertTrue(turned.of_same_film(film, film)[0].holds)
        for other in (np.roll(film, 1, axis=0), film[1:]):
            self.assertFalse(turned.of_same_film(other, film)[0].holds)

    def test_missing_and_needless_warnings_are_seen(self):
        pose_off, seam_moved = {"code": "PLAN_POSE_OFF"}, {"code": "PLAN_SEAM_MOVED"}
        for warnings, turned_deg, holds in (([], 8, False), ([pose_off], 8, True), ([seam_moved], 8, False), ([], 3, True),
                                            ([pose_off], 3, False), ([], 0, True), ([pose_off], 0, False),
                                            ([seam_moved], 0, False)):
            self.assertEqual(turned.of_warnings(warnings, turned_deg)[0].holds, holds, (warnings, turned_deg))


class TurnTest(unittest.TestCase):
    def test_turns_agree_with_matrices(self):
        line = judge.TILTED / np.linalg.norm(judge.TILTED)
        cross = np.array([[0, -line[2], line[1]], [line[2], 0, -line[0]], [-line[1], line[0], 0]])
        matrix = np.eye(3) + np.sin(0.3) * cross + (1 - np.cos(0.3)) * cross @ cross  # Rodrigues' formula
        self.assertLess(np.abs(shapes.rotation(shapes.about_line(judge.TILTED, 0.3)) - matrix).max(), 1e-12)
        both = shapes.rotation(shapes.after(shapes.about(0, 0.5), shapes.about_line(judge.TILTED, 0.3)))
        self.assertLess(np.abs(both - shapes.rotation(shapes.about(0, 0.5)) @ matrix).max(), 1e-12)

    def test_equator_stays_where_it_can_be_judged(self):
        azimuth = np.linspace(0, 2 * np.pi, 100)
        r_mm = SPHERE.film_radius_mm(turned.MOST_THETA_RAD)
        turn = shapes.about_line(np.array([0.0, 1.0, 0.0]), np.radians(turned.MOST_TURN_DEG - 1e-9))
        beyond_mm = SPHERE.beyond_mm(r_mm * np.cos(azimuth), r_mm * np.sin(azimuth), shapes.rotation(turn) @ claims.LOWEST)
        self.assertGreater(beyond_mm.min(), -1e-6)
