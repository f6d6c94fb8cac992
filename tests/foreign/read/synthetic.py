"""Large inputs with known shape and colours, written to a folder. All random numbers come from a given generator."""
from __future__ import annotations

import pathlib
from dataclasses import dataclass

import numpy as np

import png

RING_MM, TUBE_MM = 60.0, 18.0
TORUS_CELLS = (500, 300)  # around the ring and around the tube
TORUS_TEXTURE = 1024
TORUS_REPEATS = (3, -2)  # added to the texture coordinates, which repeat
CONFETTI = 250_000
CONFETTI_BOX_MM = np.array([200.0, 150.0, 100.0])
CONFETTI_MM = 0.2
MATERIALS = 500
NOISE_IMAGES, NOISE_PIXELS, NOISE_LEVELS = 12, 2048, 60
STRIP = (5000, 300)  # pixels
GAP = 1.5  # between the middles of squares of 1 mm


def lines(form: str, rows: np.ndarray) -> str:
    """One formatted line for each row."""
    return (form * len(rows)) % tuple(rows.reshape(-1).tolist())


@dataclass(frozen=True)
class Waves:
    """A picture that repeats: each channel is a sine along some direction."""
    turns: np.ndarray  # channels x 2, whole numbers: waves along u and v
    phase: np.ndarray

    def colours(self, uv: np.ndarray) -> np.ndarray:
        """sRGB (0 to 255) at each (u, v); v runs up."""
        return 128 + 100 * np.sin(2 * np.pi * (uv @ self.turns.T) + self.phase)

    def image(self, width: int, height: int) -> np.ndarray:
        u, v = np.meshgrid((np.arange(width) + 0.5) / width, 1 - (np.arange(height) + 0.5) / height)
        return np.rint(self.colours(np.stack([u, v], axis=2).reshape(-1, 2))).reshape(height, width, 3).astype(np.uint8)


def waves(random: np.random.Generator) -> Waves:
    return Waves(random.integers(1, 4, (3, 2)) * random.choice([-1, 1], (3, 2)), random.uniform(0, 2 * np.pi, 3))


# Torus: the point at (u, v) is at the angle 2 pi u around the z axis and 2 pi v around the tube.

def torus_points(uv: np.ndarray) -> np.ndarray:
    around, tube = 2 * np.pi * uv.T
    radius = RING_MM + TUBE_MM * np.cos(tube)
    return np.stack([radius * np.cos(around), radius * np.sin(around), TUBE_MM * np.sin(tube)], axis=1)


def torus_uv(points: np.ndarray) -> np.ndarray:
    """The nearest point of the torus."""
    x, y, z = points.T
    return np.stack([np.arctan2(y, x), np.arctan2(z, np.hypot(x, y) - RING_MM)], axis=1) / (2 * np.pi) % 1


def torus_distance_mm(points: np.ndarray) -> np.ndarray:
    x, y, z = points.T
    return np.abs(np.hypot(np.hypot(x, y) - RING_MM, z) - TUBE_MM)


def write_torus(folder: pathlib.Path, picture: Waves) -> pathlib.Path:
    """The seams of the texture are at u = 0 and at v = 0. Points there occur once, their texture coordinates twice."""
    across, along = TORUS_CELLS
    u, v = (each.reshape(-1) for each in np.meshgrid(np.arange(across), np.arange(along), indexing="ij"))
    points = torus_points(np.stack([u / across, v / along], axis=1))
    grid = np.stack(np.meshgrid(np.arange(across + 1) / across, np.arange(along + 1) / along, indexing="ij"), axis=2)
    corners = [((u + i) % across * along + (v + j) % along + 1, (u + i) * (along + 1) + v + j + 1)
               for i, j in ((0, 0), (1, 0), (1, 1), (0, 1))]
    faces = np.concatenate([np.stack([n for k in triple for n in corners[k]], axis=1) for triple in ((0, 1, 2), (0, 2, 3))])
    (folder / "torus.obj").write_text("mtllib torus.mtl\nusemtl skin\n" + lines("v %.7g %.7g %.7g\n", points)
                                      + lines("vt %.7g %.7g\n", grid.reshape(-1, 2) + TORUS_REPEATS)
                                      + lines("f %d/%d %d/%d %d/%d\n", faces))
    (folder / "torus.mtl").write_text("newmtl skin\nmap_Kd skin.png\n")
    png.write(folder / "skin.png", picture.image(TORUS_TEXTURE, TORUS_TEXTURE))
    return folder / "torus.obj"


# Confetti: separate tetrahedra

def confetti(random: np.random.Generator) -> np.ndarray:
    """Triangles x 3 x 3, mm."""
    middles = random.uniform(0, 1, (CONFETTI, 3)) * CONFETTI_BOX_MM
    tips = CONFETTI_MM / 2 * np.array([(1, 1, 1), (1, -1, -1), (-1, 1, -1), (-1, -1, 1)])
    faces = np.array([(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)])
    return (middles[:, None, None] + tips[faces][None]).reshape(-1, 3, 3)


def write_confetti(folder: pathlib.Path, triangles: np.ndarray) -> pathlib.Path:
    facets = np.zeros(len(triangles), np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")]))
    facets["corners"] = triangles
    (folder / "confetti.stl").write_bytes(b"confetti".ljust(80) + np.uint32(len(facets)).tobytes() + facets.tobytes())
    return folder / "confetti.stl"


# Squares: each has its material and its texture

def square_places(count: int, within: np.ndarray) -> np.ndarray:
    """The point at (u, v) of each square, mm: squares of 1 mm in rows of 25, in the plane z = 0."""
    number = np.arange(count)
    lower_left = GAP * np.stack([number % 25, number // 25], axis=1)
    return np.concatenate([lower_left + within, np.zeros((count, 1))], axis=1)


def write_squares(folder: pathlib.Path, images: list[bytes]) -> pathlib.Path:
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 1)], float)
    points = np.stack([square_places(len(images), corner) for corner in corners], axis=1)
    text = ["mtllib squares.mtl\n", lines("v %.7g %.7g %.7g\n", points.reshape(-1, 3)), lines("vt %g %g\n", corners)]
    materials = []
    for n, image in enumerate(images):
        (folder / f"picture-{n}.png").write_bytes(image)
        materials.append(f"newmtl m{n}\nmap_Kd picture-{n}.png\n")
        a, b, c, d = (f"{4 * n + k}/{k}" for k in (1, 2, 3, 4))
        text.append(f"usemtl m{n}\nf {a} {b} {c}\nf {a} {c} {d}\n")
    (folder / "squares.mtl").write_text("".join(materials))
    (folder / "squares.obj").write_text("".join(text))
    return folder / "squares.obj"


def quartered(colours: np.ndarray) -> bytes:
    """A picture of 8 x 8 pixels with four colours: upper left, upper right, lower left, lower right."""
    return png.encode(np.repeat(np.repeat(colours.reshape(2, 2, 3), 4, axis=0), 4, axis=1))


def noise(colour: np.ndarray, random: np.random.Generator) -> bytes:
    """A picture of noise around a mean colour, which compression does not make smaller."""
    values = random.integers(-NOISE_LEVELS, NOISE_LEVELS + 1, (NOISE_PIXELS, NOISE_PIXELS, 3), dtype=np.int16)
    return png.encode((values + colour.astype(np.int16)).astype(np.uint8), level=1)
