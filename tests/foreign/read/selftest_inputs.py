"""Tests of the claims about the judge's own inputs: true models hold, falsified ones are noticed."""
from __future__ import annotations

import pathlib
import tempfile
import unittest
from dataclasses import replace

import numpy as np

import claims
import inputs
import scene
import synthetic
from scene import Material, Places, Scene, Texture
from selftest import failed

WHITE = Material(np.ones(3), None)
REPEATED = ("repeat", "repeat")


def plain(corners: np.ndarray) -> Scene:
    """White triangles."""
    count = len(corners)
    return Scene(corners, np.full((count, 3, 2), np.nan), np.ones((count, 3, 3)), np.zeros(count, int), [WHITE])


def textured(points: np.ndarray, uv: np.ndarray, images: list[np.ndarray], material: np.ndarray) -> Scene:
    """Triangles x 3 points and texture coordinates, whose v runs up."""
    materials = [Material(np.ones(3), Texture(image, REPEATED, False)) for image in images]
    return Scene(points, uv * [1, -1] + [0, 1], np.ones((*points.shape[:2], 3)), material, materials)


def coarse_torus(picture: synthetic.Waves, across: int, along: int) -> Scene:
    u, v = (each.reshape(-1) for each in np.meshgrid(np.arange(across), np.arange(along), indexing="ij"))
    corner = {step: np.stack([(u + step[0]) / across, (v + step[1]) / along], axis=1)
              for step in ((0, 0), (1, 0), (1, 1), (0, 1))}
    uv = np.concatenate([np.stack([corner[step] for step in steps], axis=1)
                         for steps in (((0, 0), (1, 0), (1, 1)), ((0, 0), (1, 1), (0, 1)))])
    points = synthetic.torus_points(uv.reshape(-1, 2)).reshape(-1, 3, 3)
    return textured(points, uv, [picture.image(256, 256)], np.zeros(len(uv), int))


class TorusTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with tempfile.TemporaryDirectory() as folder:
            cls.torus = inputs.Torus(pathlib.Path(folder), np.random.default_rng(5), True)
            text = cls.torus.mesh.read_text().splitlines()
        cls.counts = {kind: sum(line.startswith(kind + " ") for line in text) for kind in ("v", "vt", "f")}
        cls.scene = coarse_torus(cls.torus.picture, 200, 100)

    def of(self, model: Scene) -> list[str]:
        return failed(self.torus.claims(model, []))

    def test_file_and_thinned_surface(self):
        self.assertEqual(self.counts, {"v": 150_000, "vt": 501 * 301, "f": 300_000})
        self.assertEqual(self.of(self.scene), [])

    def test_triangles_across_the_seam_are_noticed(self):
        for side in (0, 1):
            uv = self.scene.uv.copy()
            uv[:, :, side] = np.where(uv[:, :, side] > 1 - 1e-9, 0, uv[:, :, side])
            found = self.of(replace(self.scene, uv=uv))
            self.assertIn("texture within one triangle", found)
            self.assertIn("colours of the thinned surface beside the seams", found)

    def test_wrong_colours_are_noticed(self):
        for uv in (self.scene.uv + [0, 0.05], self.scene.uv * [1, -1], self.scene.uv[:, :, ::-1]):
            self.assertEqual(len(self.of(replace(self.scene, uv=uv))), 3)

    def test_wrong_shapes_are_noticed(self):
        there, back = "distance to the thinned surface", "distance from the thinned surface"
        moved = self.of(replace(self.scene, corners=self.scene.corners + [0, 0, 2.5]))
        self.assertTrue({there, back} <= set(moved))
        rows = np.flatnonzero(self.scene.corners[:, :, 0].min(axis=1) < 60)
        holed = Scene(self.scene.corners[rows], self.scene.uv[rows], self.scene.colour[rows], self.scene.material[rows],
                      self.scene.materials)
        self.assertIn(there, self.of(holed))
        self.assertNotIn(back, self.of(holed))
        self.assertIn(back, self.of(coarse_torus(self.torus.picture, 10, 6)))


class OtherInputTest(unittest.TestCase):
    def made(self, kind: str):
        with tempfile.TemporaryDirectory() as folder:
            return inputs.INPUTS[kind](pathlib.Path(folder), np.random.default_rng(7), False)

    def test_confetti(self):
        triangles = synthetic.confetti(np.random.default_rng(7))
        confetti = self.made("confetti")

        def of(kept: np.ndarray) -> list[str]:
            return failed(confetti.claims(plain(kept), []))
        self.assertEqual(of(triangles[::20]), [])
        self.assertIn("bounding box", of(triangles[(triangles[:, :, 0] < 180).all(axis=1)][::20]))
        self.assertEqual(of(np.concatenate([triangles[:1000], triangles[(triangles[:, :, 0] > 100).all(axis=1)]])),
                         ["triangles in the emptiest eighth of the box"])

    def squares(self, images: list[np.ndarray]) -> Scene:
        corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
        points = np.stack([synthetic.square_places(len(images), corner) for corner in corners], axis=1)
        triangles = np.concatenate([points[:, [0, 1, 2]], points[:, [0, 2, 3]]])
        uv = np.concatenate([np.tile(corners[steps], (len(images), 1, 1)) for steps in ([0, 1, 2], [0, 2, 3])])
        return textured(triangles, uv, images, np.tile(np.arange(len(images)), 2))

    def test_materials(self):
        materials = self.made("materials")
        images = [np.repeat(np.repeat(each.reshape(2, 2, 3), 4, axis=0), 4, axis=1) for each in materials.colours]
        good = self.squares(images)
        self.assertEqual(failed(materials.claims(good, [])), [])
        self.assertEqual(len(failed(materials.claims(replace(good, material=np.roll(good.material, 1)), []))), 4)
        self.assertEqual(len(failed(materials.claims(self.squares([image[::-1] for image in images]), []))), 4)
        one_lost = images[:7] + [np.full((8, 8, 3), 255)] + images[8:]
        self.assertEqual(len(failed(materials.claims(self.squares(one_lost), []))), 4)

    def test_reduced_textures(self):
        random = np.random.default_rng(3)
        colours = random.integers(60, 190, (4, 3))
        images = [np.rint(colour + random.integers(-60, 60, (64, 64, 3))) for colour in colours]
        warning = ["TEXTURES_REDUCED: the textures have more than 32 MiB"]
        self.assertEqual(failed(claims.of_reduced(images, colours, warning)), [])
        self.assertEqual(failed(claims.of_reduced(images, colours, [])), ["a warning mentions textures"])
        other_size = images[:3] + [images[3][:32]]
        self.assertEqual(failed(claims.of_reduced(other_size, colours, warning)), ["all have the same size"])
        self.assertEqual(failed(claims.of_reduced(images[::-1], colours, warning)), ["mean colours of textures"])
        self.assertEqual(failed(claims.of_reduced(images[:3], colours, warning)),
                         ["all textures are there", "mean colours of textures"])

    def test_strip(self):
        strip = self.made("strip")
        good = self.squares([strip.picture.image(2048, 123)])
        self.assertEqual(failed(strip.claims(good, [])), [])
        self.assertEqual(failed(strip.claims(self.squares([strip.picture.image(2048, 300)]), [])),
                         ["width over height of the texture"])
        self.assertEqual(failed(strip.claims(self.squares([strip.picture.image(2048, 123)[:, ::-1]]), [])), ["colours"])


class PlaceTest(unittest.TestCase):
    def test_nearest_places(self):
        random = np.random.default_rng(2)
        corners = random.normal(size=(40, 3, 3))
        soup = plain(corners)
        points = 2 * random.normal(size=(50, 3))
        places, distance = scene.nearest(soup, points, 100.0)
        self.assertTrue(np.allclose(np.linalg.norm(places.points(soup) - points, axis=1), distance))
        steps = [(i, j, 20 - i - j) for i in range(21) for j in range(21 - i)]
        dense = np.einsum("kc,tcx->tkx", np.array(steps) / 20, corners).reshape(-1, 3)
        sampled = np.linalg.norm(dense[None] - points[:, None], axis=2).min(axis=1)
        self.assertTrue((distance <= sampled + 1e-9).all() and (distance >= sampled - 0.2).all())
        self.assertTrue(np.isinf(scene.nearest(soup, points + 1000, 1.0)[1]).all())

    def test_lowest_hits(self):
        low, high = np.array([[(0, 0, z), (4, 0, z), (0, 4, z)] for z in (1.0, 2.0)])
        two = plain(np.stack([high, low]))
        hits = scene.lowest_hits(two, np.array([(1.0, 1.0), (3.0, 3.0)]))
        self.assertEqual(hits.triangle.tolist(), [1, -1])
        self.assertTrue(np.allclose(hits.points(two)[0], (1, 1, 1)))
        self.assertTrue(np.isnan(scene.shown(two, hits)[1]).all())

    def test_random_places_are_even(self):
        flat = np.array([[(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(1, 1, 0), (9, 1, 0), (1, 9, 0)]], float)
        two = plain(flat)
        places: Places = scene.random_places(two, 5000, np.random.default_rng(1))
        self.assertAlmostEqual(places.triangle.mean(), 64 / 65, 2)
        self.assertTrue(np.allclose(places.points(two)[places.triangle == 1].mean(axis=0), flat[1].mean(axis=0), atol=0.1))
