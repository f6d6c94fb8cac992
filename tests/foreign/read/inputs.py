"""The judge's own inputs: each writes files, has the worker inspect them, and makes claims about the result."""
from __future__ import annotations

import pathlib
from collections.abc import Callable

import numpy as np

import claims
import png
import scene
import synthetic
from claims import Claim
from scene import Scene

Random = np.random.Generator
HAUSDORFF = 0.01  # of the diagonal
AGREE = 0.98
COLOURED_POINTS = 500
BESIDE_SEAM = 0.01  # of the texture
UV_SPAN = 0.25  # of the texture, within one triangle
SHOWN_EVERYWHERE = 0.01  # of the triangles, in each eighth of the box


class Torus:
    """300,000 triangles with a texture whose seams are in the surface."""

    def __init__(self, folder: pathlib.Path, random: Random, small: bool):
        self.random, self.sampled = random, 300 if small else 2000
        self.picture = synthetic.waves(random)
        self.mesh = synthetic.write_torus(folder, self.picture)

    def claims(self, model: Scene, warnings: list[str]) -> list[Claim]:
        diagonal = 2 * float(np.linalg.norm([synthetic.RING_MM + synthetic.TUBE_MM] * 2 + [synthetic.TUBE_MM]))
        uv = self.random.uniform(0, 1, (self.sampled, 2))
        reach = HAUSDORFF * diagonal
        places, there = scene.nearest(model, synthetic.torus_points(uv), reach)
        many = scene.random_places(model, 40 * COLOURED_POINTS, self.random)
        points = many.points(model)
        of_points = synthetic.torus_uv(points)
        beside = np.flatnonzero((np.abs(of_points - np.rint(of_points)) < BESIDE_SEAM).any(axis=1))[:COLOURED_POINTS]
        back = synthetic.torus_distance_mm(points[:self.sampled])
        span = np.ptp(model.uv, axis=1).max()
        out = [Claim("distance to the thinned surface, share of the diagonal", there.max() / diagonal, HAUSDORFF),
               Claim("distance from the thinned surface, share of the diagonal", back.max() / diagonal, HAUSDORFF),
               Claim("texture within one triangle, share of its width", span, UV_SPAN),
               Claim("points beside the seams", len(beside), COLOURED_POINTS, True),
               claims.of_share("colours of the surface", scene.shown(model, places), self.picture.colours(uv), AGREE)]
        for what, rows in (("thinned surface", np.arange(COLOURED_POINTS)), ("thinned surface beside the seams", beside)):
            found = scene.shown(model, scene.Places(many.triangle[rows], many.weights[rows]))
            out.append(claims.of_share(f"colours of the {what}", found, self.picture.colours(of_points[rows]), AGREE))
        return out


class Confetti:
    """Tetrahedra that are each smaller than what thinning keeps."""

    def __init__(self, folder: pathlib.Path, random: Random, small: bool):
        triangles = synthetic.confetti(random)
        self.box = triangles.min(axis=(0, 1)), triangles.max(axis=(0, 1))
        self.mesh = synthetic.write_confetti(folder, triangles)

    def claims(self, model: Scene, warnings: list[str]) -> list[Claim]:
        upper = model.corners.mean(axis=1) > synthetic.CONFETTI_BOX_MM / 2
        eighths = np.bincount(upper @ [1, 2, 4], minlength=8) / len(upper)
        return [Claim("bounding box, share of the diagonal", claims.box_off(model, *self.box), claims.THINNED_BOX),
                Claim("triangles in the emptiest eighth of the box, share", eighths.min(), SHOWN_EVERYWHERE, True)]


class Materials:
    """As many materials as small textures."""

    def __init__(self, folder: pathlib.Path, random: Random, small: bool):
        self.colours = random.integers(0, 256, (synthetic.MATERIALS, 4, 3))
        self.mesh = synthetic.write_squares(folder, [synthetic.quartered(each.astype(np.uint8)) for each in self.colours])

    def claims(self, model: Scene, warnings: list[str]) -> list[Claim]:
        out = []
        for n, (name, u, v) in enumerate((("upper left", 0.25, 0.75), ("upper right", 0.75, 0.75),
                                          ("lower left", 0.25, 0.25), ("lower right", 0.75, 0.25))):
            points = synthetic.square_places(synthetic.MATERIALS, np.array([u, v]))
            found = scene.shown(model, scene.nearest(model, points, 0.01)[0])
            out.append(claims.of_share(f"colours of the {name} quarters", found, self.colours[:, n], 1.0))
        return out


class Noise:
    """Textures that are too large together."""

    def __init__(self, folder: pathlib.Path, random: Random, small: bool):
        self.colours = random.integers(synthetic.NOISE_LEVELS, 256 - synthetic.NOISE_LEVELS, (synthetic.NOISE_IMAGES, 3))
        self.mesh = synthetic.write_squares(folder, [synthetic.noise(each, random) for each in self.colours])

    def claims(self, model: Scene, warnings: list[str]) -> list[Claim]:
        points = synthetic.square_places(len(self.colours), np.array([0.6, 0.3]))
        places = scene.nearest(model, points, 0.01)[0]
        used = [model.materials[model.material[each]].texture for each in places.triangle if each >= 0]
        return claims.of_reduced([texture.image for texture in used if texture], self.colours, warnings)


class Strip:
    """One texture that is too long."""

    def __init__(self, folder: pathlib.Path, random: Random, small: bool):
        self.random, self.picture = random, synthetic.waves(random)
        self.mesh = synthetic.write_squares(folder, [png.encode(self.picture.image(*synthetic.STRIP))])

    def claims(self, model: Scene, warnings: list[str]) -> list[Claim]:
        uv = self.random.uniform(0.02, 0.98, (COLOURED_POINTS, 2))
        places = scene.nearest(model, np.concatenate([uv, np.zeros((len(uv), 1))], axis=1), 0.01)[0]
        height, width = model.materials[0].texture.image.shape[:2]
        ratio = synthetic.STRIP[0] / synthetic.STRIP[1]
        return [Claim("width over height of the texture, relative error", abs(width / height / ratio - 1), 0.02),
                claims.of_share("colours", scene.shown(model, places), self.picture.colours(uv), 1.0)]


INPUTS: dict[str, Callable] = {"torus": Torus, "confetti": Confetti, "materials": Materials, "noise": Noise, "strip": Strip}
SMALL = ("torus",)
