"""Claims about what `inspect` writes: functions of files that were read, without programs."""
from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from glb import Glb
from scene import Scene

LEVELS = 14.0  # of 255
WHITE = 255.0
TRIANGLES = 200_000
IMAGE_PIXELS = 2048
IMAGE_MIB = 32.0
BOX = 1e-5  # of the diagonal
THINNED_BOX = 0.02


@dataclass(frozen=True)
class Claim:
    what: str
    measured: float
    limit: float
    at_least: bool = False  # otherwise, the limit is the largest value at which the claim holds
    note: str = ""

    @property
    def holds(self) -> bool:
        return bool(self.measured >= self.limit if self.at_least else self.measured <= self.limit)  # False for NaN

    def __str__(self) -> str:
        limit = f"(at {'least' if self.at_least else 'most'} {self.limit:g})"
        return f"{self.what}: {self.measured:.6g} {limit}" + (f"; {self.note}" if self.note else "")


def must(what: str, holds: bool, note: str = "") -> Claim:
    return Claim(f"{what} (1: yes)", float(holds), 1, True, "" if holds else note)


def of_model(model: Glb, report: dict) -> list[Claim]:
    """Claims about every model and its summary."""
    scene, count = model.scene, len(model.scene.corners)
    thinned, shown = report["triangles"] > TRIANGLES, report["shown_triangles"]
    sides = [side for material in scene.materials if material.texture for side in material.texture.image.shape[:2]]
    return [
        Claim("triangles", count, TRIANGLES),
        must("shown triangles as in the summary", count == shown, f"{count}, {shown} in the summary"),
        must("only large models are thinned", thinned or count == report["triangles"], f"{count} of {report['triangles']}"),
        Claim("bounding box against the summary, share of the diagonal", box_off(scene, *box_of(report)),
              THINNED_BOX if thinned else BOX),
        must("extras are the summary", any(holds_summary(extras, report) for extras in model.extras)),
        Claim("longest side of a texture, pixels", max(sides, default=0), IMAGE_PIXELS),
        Claim("encoded textures, MiB", model.image_bytes / 2 ** 20, IMAGE_MIB)]


def box_of(report: dict) -> tuple[np.ndarray, np.ndarray]:
    return np.array(report["lowest_mm"], float), np.array(report["highest_mm"], float)


def box_off(scene: Scene, low: np.ndarray, high: np.ndarray) -> float:
    """Largest difference of the scene's bounding box, as a share of the given one's diagonal."""
    found = np.concatenate(scene.box)
    return float(np.abs(found - np.concatenate([low, high])).max() / np.linalg.norm(high - low))


def holds_summary(extras: object, report: dict) -> bool:
    """The extras are the summary, or one of their members is."""
    return same(extras, report) or (isinstance(extras, dict) and any(same(each, report) for each in extras.values()))


def same(a: object, b: object) -> bool:
    """Equal JSON values; numbers may differ by their last digits."""
    if isinstance(a, dict) and isinstance(b, dict):
        return a.keys() == b.keys() and all(same(a[key], b[key]) for key in a)
    if isinstance(a, list) and isinstance(b, list):
        return len(a) == len(b) and all(same(x, y) for x, y in zip(a, b))
    if isinstance(a, float) or isinstance(b, float):
        return isinstance(a, (int, float)) and isinstance(b, (int, float)) and math.isclose(a, b, rel_tol=1e-12)
    return a == b


def of_colours(model: dict[str, np.ndarray], film: dict[str, np.ndarray]) -> Claim:
    """Largest difference of any channel at the four places."""
    off = {name: float(np.abs(model[name] - film[name]).max()) for name in film}
    worst = max(off, key=lambda name: math.inf if math.isnan(off[name]) else off[name])
    values = [[round(float(v), 1) for v in side[worst]] for side in (model, film)]
    return Claim("colours against film.png, levels", off[worst], LEVELS, note=f"at {worst}: {values[0]}, film {values[1]}")


def of_uncoloured(model: dict[str, np.ndarray], warnings: list[str]) -> Claim:
    """A model without colours is shown white, or a warning says what is missing."""
    white = all(bool((WHITE - colour <= LEVELS).all()) for colour in model.values())
    return must("white, or a warning", white or len(warnings) > 0)


def of_refusal(inspected: tuple[int, str], simulated: tuple[int, str]) -> list[Claim]:
    """Exit statuses and last lines on stderr of both verbs."""
    return [must("refused", inspected[0] == simulated[0], f"exit status {inspected[0]} instead of {simulated[0]}"),
            must("same words", inspected[1] == simulated[1], f"{inspected[1]!r} instead of {simulated[1]!r}")]


def of_share(what: str, found: np.ndarray, expected: np.ndarray, share: float) -> Claim:
    """The share of rows of colours that agree. A row of NaN does not."""
    agree = (np.abs(found - expected) <= LEVELS).all(axis=1)
    return Claim(f"{what}, share within {LEVELS:g} levels", float(agree.mean()) if len(agree) else math.nan, share, True)


def of_reduced(images: list[np.ndarray], colours: np.ndarray, warnings: list[str]) -> list[Claim]:
    """Textures too large together are reduced evenly, keep their mean colours, and a warning mentions it."""
    means = np.array([image[:, :, :3].astype(float).mean(axis=(0, 1)) for image in images])
    about = [text for text in warnings if any(word in text.lower() for word in ("texture", "picture", "image"))]
    off = np.abs(means - colours).max() if means.shape == colours.shape else math.nan
    return [must("all textures are there", len(images) == len(colours), f"{len(images)} of {len(colours)}"),
            must("all have the same size", len({image.shape[:2] for image in images}) == 1),
            Claim("mean colours of textures, levels", float(off), LEVELS),
            must("a warning mentions textures", len(about) > 0, f"{warnings}")]
