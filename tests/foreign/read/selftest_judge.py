"""Tests of the whole judge, with a program in place of the worker."""
from __future__ import annotations

import argparse
import contextlib
import io
import json
import pathlib
import tempfile
import unittest
from dataclasses import replace

import judge
import models
import png
from models import Part
from selftest import KINDS

FAKE_WORKER = """#!/usr/bin/env python3
import json, pathlib, shutil, sys
here, out = pathlib.Path(__file__).parent, pathlib.Path(sys.argv[sys.argv.index("--out") + 1])
answer = json.loads((here / (sys.argv[1] + ".json")).read_text())
if answer["status"] == 0:
    shutil.copytree(here / sys.argv[1], out)
print("a note\\n" + answer["last"], file=sys.stderr)
sys.exit(answer["status"])
"""


class JudgeTest(unittest.TestCase):
    """The program answers with prepared files."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        root = pathlib.Path(self.folder.name)
        self.worker, self.cases = root / "worker", root / "cases"
        self.worker.write_text(FAKE_WORKER)
        self.worker.chmod(0o755)
        for name in ("simulate", "inspect", "cases/01-own", "cases/02-paint", "cases/27-pocket"):
            (root / name).mkdir(parents=True)
        for name, more in (("01-own", []), ("02-paint", ["--texture", "b.png"]), ("27-pocket", [])):
            text = {"kind": "worker", "runs": [{"name": "one", "args": ["--mesh", "a.obj", *more]}]}
            (self.cases / name / "case.json").write_text(json.dumps(text))
        png.write(root / "simulate/film.png", models.film_image())
        self.write(KINDS["factors"])
        self.answer("simulate", 0, "")
        self.answer("inspect", 0, "")

    def write(self, parts: list[Part]) -> None:
        folder, summary = self.worker.parent / "inspect", models.summary_of(parts)
        (folder / "model.glb").write_bytes(models.document(parts, summary).packed())
        (folder / "report.json").write_text(json.dumps(summary))

    def answer(self, verb: str, status: int, last: str) -> None:
        (self.worker.parent / f"{verb}.json").write_text(json.dumps({"status": status, "last": last}))

    def judged(self) -> tuple[int, str]:
        options = argparse.Namespace(worker=self.worker, cases=self.cases, small=False, seed=1, inputs=[])
        out = io.StringIO()
        with contextlib.redirect_stdout(out):
            return judge.judge(options), out.getvalue()

    def test_good_answers_hold(self):
        status, text = self.judged()
        self.assertEqual(status, 0, text)
        self.assertIn("skip  02-paint | one: not the model's own colours (--texture)", text)
        self.assertIn("1 hold, 0 do not, 1 skipped", text)

    def test_wrong_colours_fail(self):
        self.write(KINDS["factors"][:1] + [replace(part, factor=(1, 0, 0, 1)) for part in KINDS["factors"][1:]])
        self.assertEqual(self.judged()[0], 1)

    def test_damaged_model_fails(self):
        (self.worker.parent / "inspect/model.glb").write_bytes(b"glTF")
        self.assertEqual(self.judged()[0], 1)

    def test_refusals(self):
        words = "worker: a.obj: line 1: damaged"
        self.answer("simulate", 3, words)
        self.assertEqual(self.judged()[0], 1)
        self.answer("inspect", 3, words)
        self.assertEqual(self.judged()[0], 0)
        self.answer("inspect", 3, "worker: a.obj: damaged")
        self.assertEqual(self.judged()[0], 1)
        self.answer("simulate", 0, "")
        self.assertEqual(self.judged()[0], 1)

    def test_models_without_colours(self):
        self.answer("simulate", 3, "worker: a.obj: has no colour, so the film would stay blank")
        self.assertEqual(self.judged()[0], 1)
        self.write([models.sphere()])
        self.assertEqual(self.judged()[0], 0)
        self.answer("inspect", 3, "worker: a.obj: has no colour, so the film would stay blank")
        self.assertEqual(self.judged()[0], 1)

    def test_unknown_verb_is_not_judged(self):
        self.answer("inspect", 2, "unknown verb")
        with self.assertRaises(judge.WorkerFailed):
            self.judged()
