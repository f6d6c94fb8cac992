#!/usr/bin/env python3
"""Tests of the judge: true models must hold, and falsified ones must be noticed."""
from __future__ import annotations

import pathlib
import sys
import tempfile
import unittest
from dataclasses import replace

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "plan"))

import cases
import claims
import glb
import light
import models
import png
import scene
from models import Document, Part

FILM = {name: colour.astype(float) for name, colour in zip(("++", "-+", "--", "+-"), models.COLOURS)}
KINDS = {"float colours": models.by_vertex(np.float32), "byte colours": models.by_vertex(np.uint8),
         "short colours": models.by_vertex(np.uint16), "factors": models.by_material(), "texture": models.by_texture(),
         "product": models.by_product()}


def read(parts: list[Part], translation_mm: tuple[float, ...] = (0, 0, 0)) -> glb.Glb:
    return glb.read(models.document(parts, models.summary_of(parts), translation_mm).packed())


def colours_hold(parts: list[Part]) -> bool:
    return claims.of_colours(cases.model_colours(read(parts).scene), FILM).holds


def failed(found: list[claims.Claim]) -> list[str]:
    return [claim.what.split(",")[0].split(" (")[0] for claim in found if not claim.holds]


class ColourTest(unittest.TestCase):
    def test_true_colours_hold(self):
        for name, parts in KINDS.items():
            with self.subTest(name):
                self.assertTrue(colours_hold(parts))

    def test_swapped_colours_are_noticed(self):
        self.assertFalse(colours_hold([replace(part, factor=part.factor[2::-1] + (1,)) for part in KINDS["factors"]]))
        for name in ("float colours", "byte colours", "short colours"):
            self.assertFalse(colours_hold([replace(part, colour=part.colour[:, ::-1].copy()) for part in KINDS[name]]), name)
        factors = [part.factor for part in KINDS["factors"]]
        swapped = [replace(part, factor=factors[n - 1]) for n, part in enumerate(KINDS["factors"])]
        self.assertFalse(colours_hold(swapped))

    def test_shifted_and_flipped_texture_is_noticed(self):
        part = KINDS["texture"][0]
        for uv in (part.uv + [0, 0.5], part.uv * [1, -1], part.uv * [-1, 1], part.uv[:, ::-1]):
            self.assertFalse(colours_hold([replace(part, uv=uv)]))

    def test_clamped_instead_of_repeated_is_noticed(self):
        part = replace(KINDS["texture"][0], uv=KINDS["texture"][0].uv + [3, -2])
        self.assertTrue(colours_hold([part]))
        self.assertFalse(colours_hold([replace(part, sampler={"wrapS": 33071, "wrapT": 33071})]))

    def test_colours_without_their_coding_are_noticed(self):
        part = KINDS["float colours"][0]
        self.assertFalse(colours_hold([replace(part, colour=light.levels(part.colour).astype(np.float32) / 255)]))

    def test_each_factor_of_the_product_counts(self):
        part = KINDS["product"][0]
        for other in (replace(part, colour=None), replace(part, factor=(1, 0.5, 1, 1)), replace(part, image=None, uv=None)):
            self.assertFalse(colours_hold([other]))

    def test_part_that_is_missing_is_noticed(self):
        self.assertFalse(colours_hold(KINDS["factors"][1:]))

    def test_mirrored_wrapping(self):
        self.assertEqual(light.wrapped(np.arange(-4, 7), 3, "mirror").tolist(), [2, 2, 1, 0, 0, 1, 2, 2, 1, 0, 0])
        self.assertEqual(light.wrapped(np.arange(-2, 5), 3, "repeat").tolist(), [1, 2, 0, 1, 2, 0, 1])

    def test_film_is_read_the_right_way_up(self):
        with tempfile.TemporaryDirectory() as folder:
            png.write(pathlib.Path(folder) / "film.png", models.film_image())
            found = cases.film_colours(pathlib.Path(folder) / "film.png")
        self.assertTrue(all((found[name] == FILM[name]).all() for name in FILM))

    def test_white_or_warning(self):
        white = {name: np.full(3, 255.0) for name in FILM}
        self.assertTrue(claims.of_uncoloured(white, []).holds)
        self.assertTrue(claims.of_uncoloured(FILM, ["texture_missing: ..."]).holds)
        self.assertFalse(claims.of_uncoloured(FILM, []).holds)


class ContainerTest(unittest.TestCase):
    def setUp(self):
        parts = KINDS["texture"]
        self.document = models.document(parts, models.summary_of(parts))

    def test_true_file_is_read(self):
        glb.read(self.document.packed())

    def refused(self, data: bytes, words: str) -> None:
        with self.assertRaisesRegex(glb.Invalid, words):
            glb.read(data)

    def test_broken_container(self):
        data = self.document.packed()
        self.refused(data[:10], "header")
        self.refused(b"GLTF" + data[4:], "not a binary glTF")
        self.refused(data[:-4], "length")
        self.refused(data + b"\0\0\0\0", "length")
        size = int.from_bytes(data[12:16], "little")
        self.refused(data[:12] + (size + 1).to_bytes(4, "little") + data[16:], "multiple of 4")
        self.refused(data.replace(b'"2.0"', b'"1.0"'), "version")
        self.refused(data.replace(b"JSON", b"JSOM", 1), "chunks")

    def test_wrong_index(self):
        accessor = self.document.json["accessors"][-1]
        start = self.document.json["bufferViews"][accessor["bufferView"]]["byteOffset"]
        count = self.document.json["accessors"][0]["count"]
        del accessor["min"], accessor["max"]
        self.document.binary = self.document.binary[:start] + count.to_bytes(4, "little") + self.document.binary[start + 4:]
        self.refused(self.document.packed(), f"index {count} of {count}")

    def test_numbers_that_are_not_finite(self):
        self.document.binary = np.float32(np.nan).tobytes() + self.document.binary[4:]
        del self.document.json["accessors"][0]["min"], self.document.json["accessors"][0]["max"]
        self.refused(self.document.packed(), "POSITION needs min and max")
        self.document.json["accessors"][0] |= {"min": [0, 0, 0], "max": [0, 0, 0]}
        self.refused(self.document.packed(), "min is|finite")

    def test_falsified_documents(self):
        for path, value, words in (
                (("accessors", 0, "max"), [20, 20, 21], "max is"),
                (("accessors", 0, "min"), [-20, -20], "min is"),
                (("accessors", 0, "count"), 10 ** 6, "exceeds its buffer view"),
                (("accessors", 0, "byteOffset"), 2, "not aligned"),
                (("accessors", 0, "componentType"), 5125, "min is|not three floats"),
                (("accessors", 1, "count"), 3, "min is|different lengths"),
                (("accessors", -1, "count"), 4, "min is|max is|not triangles"),
                (("bufferViews", 0, "byteLength"), 10 ** 9, "exceeds the buffer"),
                (("buffers", 0, "byteLength"), 100, "bytes more than the buffer"),
                (("images", 0, "mimeType"), "image/jpeg", "not an embedded PNG"),
                (("materials", 0, "extensions"), {}, "not unlit"),
                (("materials", 0, "alphaMode"), "BLEND", "not opaque"),
                (("materials", 0, "pbrMetallicRoughness", "baseColorFactor"), [2, 1, 1, 1], "baseColorFactor"),
                (("materials", 0, "pbrMetallicRoughness", "baseColorTexture", "index"), 1, "IndexError"),
                (("materials", 0, "pbrMetallicRoughness", "baseColorTexture", "texCoord"), 1, "TEXCOORD_1"),
                (("textures", 0, "source"), 7, "IndexError"),
                (("meshes", 0, "primitives", 0, "mode"), 5, "not made of triangles"),
                (("meshes", 0, "primitives", 0, "material"), 3, "IndexError"),
                (("nodes", 0, "children"), [0], "two parents"),
                (("nodes", 0, "rotation"), [0, 0, 0, 2], "unit quaternion"),
                (("extensionsRequired",), ["KHR_draco_mesh_compression"], "extensions")):
            with self.subTest(path):
                self.setUp()
                *steps, last = path
                part = self.document.json
                for step in steps:
                    part = part[step]
                part[last] = value
                self.refused(self.document.packed(), words)

    def test_damaged_image(self):
        view = self.document.json["bufferViews"][self.document.json["images"][0]["bufferView"]]
        start = view["byteOffset"]
        self.document.binary = self.document.binary[:start] + b"\0" + self.document.binary[start + 1:]
        self.refused(self.document.packed(), "not a PNG")

    def test_nodes_move_turn_and_scale(self):
        far = read(KINDS["factors"], (300_000.0, 5.0, -7.0)).scene
        self.assertLess(claims.box_off(far, np.full(3, -20.0), np.full(3, 20.0)), 1e-6)
        half = 0.5 ** 0.5
        self.document.json["nodes"][0] = {"children": [1], "rotation": [0, 0, half, half]}
        self.document.json["nodes"].append({"mesh": 0, "scale": [2, 1, 1], "translation": [100, 0, 0]})
        low, high = glb.read(self.document.packed()).scene.box
        self.assertTrue(np.allclose(low, [-20, 60, -20], atol=1e-4) and np.allclose(high, [20, 140, 20], atol=1e-4))


class ModelClaimTest(unittest.TestCase):
    def setUp(self):
        self.parts = KINDS["texture"]
        self.summary = models.summary_of(self.parts)

    def of(self, document: Document, summary: dict | None = None) -> list[str]:
        return failed(claims.of_model(glb.read(document.packed()), summary or self.summary))

    def test_true_summary_holds(self):
        document = models.document(self.parts, self.summary)
        self.assertEqual(self.of(document), [])
        document.json["scenes"][0]["extras"] = document.json["asset"].pop("extras")["summary"]
        self.assertEqual(self.of(document), [])

    def test_other_summary_is_noticed(self):
        document = models.document(self.parts, self.summary | {"format": "STL"})
        self.assertEqual(self.of(document), ["extras are the summary"])
        del document.json["asset"]["extras"]
        self.assertEqual(self.of(document), ["extras are the summary"])

    def test_falsified_numbers_are_noticed(self):
        fewer = [replace(self.parts[0], triangles=self.parts[0].triangles[:-1])]
        self.assertEqual(self.of(models.document(fewer, self.summary)),
                         ["shown triangles as in the summary", "only large models are thinned"])
        moved = [replace(self.parts[0], points=self.parts[0].points + [0.002, 0, 0])]
        self.assertEqual(self.of(models.document(moved, self.summary)), ["bounding box against the summary"])
        scaled = [replace(self.parts[0], points=self.parts[0].points / 10)]
        self.assertEqual(self.of(models.document(scaled, self.summary)), ["bounding box against the summary"])

    def test_too_large_models_are_noticed(self):
        many = [replace(self.parts[0], triangles=np.repeat(self.parts[0].triangles, 40, axis=0))]
        self.assertIn("triangles", self.of(models.document(many, models.summary_of(many))))
        wide = [replace(self.parts[0], image=np.zeros((1, 2049, 3), np.uint8))]
        self.assertEqual(self.of(models.document(wide, self.summary)), ["longest side of a texture"])
        heavy = glb.read(models.document(self.parts, self.summary).packed())
        self.assertEqual(failed(claims.of_model(replace(heavy, image_bytes=33 * 2 ** 20), self.summary)),
                         ["encoded textures"])

    def test_refusals_are_compared(self):
        self.assertEqual(failed(claims.of_refusal((3, "a.obj: x"), (3, "a.obj: x"))), [])
        self.assertEqual(failed(claims.of_refusal((0, ""), (3, "a.obj: x"))), ["refused", "same words"])
        self.assertEqual(failed(claims.of_refusal((3, "a.obj: y"), (3, "a.obj: x"))), ["same words"])


def main() -> int:
    import selftest_inputs
    import selftest_judge
    tests = unittest.TestSuite(unittest.defaultTestLoader.loadTestsFromModule(module)
                               for module in (sys.modules[__name__], selftest_inputs, selftest_judge))
    return 0 if unittest.TextTestRunner().run(tests).wasSuccessful() else 1


if __name__ == "__main__":
    sys.exit(main())
