"""Inputs of the runs that do not come from other runs: small files, and frames of the virtual rig's depth camera."""
import contextlib
import json
import math
import pathlib
import socket
import struct
import subprocess
import tempfile

import programs
from build_comparison import decode

ROOT = pathlib.Path(__file__).resolve().parents[2]
LAYOUT = ROOT / "deploy/rig_layout.toml.example"
PROFILE = ROOT / "deploy/film_profile.toml.example"
CMYK_PROFILE = "/usr/share/color/icc/ghostscript/default_cmyk.icc"  # from libgs-common

WATER_MM = 240  # axis position of the water
GRIPPER_MM = 135  # height of the gripper above the water during the capture
VIEWS = 8  # number of views of the calibration board
OTHER_FILM = """\
swelling = [1.03, 1.02]
drag_length_mm = 60.0
poisson_ratio = 0.4
"""

# The smallest profile that the virtual rig accepts. Nothing moves.
DRIVE = """\
name = "virtual drive"
tried_on_hardware = false
virtual = true
unit = 1
[motion]
max_speed_mm_per_s = 20.0
acceleration_mm_per_s2 = 200.0
stopping_deceleration_mm_per_s2 = 200.0
jog_refresh_s = 0.05
jog_dead_man_s = 0.2
[timing]
response_timeout_s = 0.1
worst_delay_s = 0.25
[[identity]]
space = "holding"
address = 0
value = 0x4850
meaning = "maker"
[[block]]
space = "input"
address = 0x100
count = 7
mark = { address = 0x100, value = 0xa55a, meaning = "state" }
[position]
space = "input"
address = 0x103
words = 2
signed = true
counts_per_mm = 10000.0
[velocity]
space = "input"
address = 0x105
words = 2
signed = true
counts_per_mm_per_s = 1000.0
[alarm_code]
space = "input"
address = 0x102
[status]
enabled = { space = "input", address = 0x101, bit = 0 }
homed = { space = "input", address = 0x101, bit = 1 }
moving = { space = "input", address = 0x101, bit = 2 }
alarm = { space = "input", address = 0x101, bit = 3 }
[write]
position = { words = 2, signed = true, counts_per_mm = 10000.0 }
speed = { words = 2, counts_per_mm_per_s = 1000.0 }
acceleration = { words = 1, counts_per_mm_per_s2 = 10.0 }
deceleration = { words = 1, counts_per_mm_per_s2 = 10.0 }
[commands]
enable = []
disable = []
home = [{ address = 0x300, values = [3] }]
move = [{ address = 0x300, values = [4, "position", "speed", "acceleration"] }]
jog_positive = [{ address = 0x300, values = [5, 0, 0, "speed", "acceleration"] }]
jog_negative = [{ address = 0x300, values = [6, 0, 0, "speed", "acceleration"] }]
stop = [{ address = 0x300, values = [7] }]
reset_fault = [{ address = 0x300, values = [8] }]
[watchdog]
largest_time_s = 0.25
time = { space = "holding", address = 0x200, words = 1, counts_per_s = 1000.0 }
action = { space = "holding", address = 0x201 }
stopping_actions = [1]
"""


def product(a, b):
    """Product of two quaternions, w first."""
    return [a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]]


def turn(degrees, x, y, z):
    """The quaternion of a rotation about a unit vector."""
    half = math.radians(degrees) / 2
    return [math.cos(half), math.sin(half) * x, math.sin(half) * y, math.sin(half) * z]


def pose(rotation, at_mm):
    return json.dumps({"rotation_wxyz": rotation, "translation_mm": at_mm})


def board_obj():
    """The calibration board: two plates of 140 x 210 mm that slope down by 30 degrees on both sides of a ridge along y,
    with eleven pyramids of 44 mm width and 25 mm height."""
    points, faces = [], []

    def add(side, local, triangles):
        first = len(points) + 1
        cos, sin = math.cos(math.pi / 6), math.sin(math.pi / 6)
        points.extend((side * (cos * x + sin * z), side * y, cos * z - sin * x) for x, y, z in local)
        faces.extend([first + corner for corner in triangle] for triangle in triangles)

    for side in (1, -1):
        add(side, [(0, -105, 0), (140, -105, 0), (140, 105, 0), (0, 105, 0)], [(0, 1, 2), (0, 2, 3)])
        for x in (33, 99):
            for y in (-66, 0, 66):
                if (side, x, y) != (1, 99, 66):
                    add(side, [(x - 22, y - 22, 0), (x + 22, y - 22, 0), (x + 22, y + 22, 0), (x - 22, y + 22, 0),
                               (x, y, 25)], [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    return "".join("v %.12g %.12g %.12g\n" % point for point in points) + \
        "".join("f %d %d %d\n" % tuple(face) for face in faces)


def held_board(view):
    """Pose of the calibration board in the camera's frame: tilted in all directions, near and far, all over the image."""
    way, away_mm = 1.7 * view, 560 + 60 * (view % 5)
    facing = product(turn(view % 3 * 16, math.cos(way), math.sin(way), 0), [0, 1, 0, 0])
    aside = 0.5 - 126 / away_mm
    x, y = aside * math.cos(2.4 * view), 0.66 * aside * math.sin(2.4 * view)
    return pose(facing, [away_mm * x, away_mm * y, away_mm])


def binary_stl(obj):
    """The triangles of an OBJ file as STL."""
    points = [tuple(map(float, line.split()[1:4])) for line in obj.splitlines() if line.startswith("v ")]
    out = []
    for line in obj.splitlines():
        if line.startswith("f "):
            corners = [points[int(word.split("/")[0]) - 1] for word in line.split()[1:]]
            for i in range(1, len(corners) - 1):
                out.append(struct.pack("<12fH", 0, 0, 0, *corners[0], *corners[i], *corners[i + 1], 0))
    return bytes(80) + struct.pack("<I", len(out)) + b"".join(out)


def measured_points(surface_map, count=150):
    """Points for `fit`, spread over the vertices of a surface_map.ply that the film reaches."""
    _, names, vertices, _ = decode.read_ply(surface_map)
    columns = [names.index(name) for name in ("film_x", "film_y", "x", "y", "z", "stretch")]
    rows = [[vertex[column] for column in columns] for vertex in vertices]
    landed = [row[:5] for row in rows if row[5] < 2]  # leaves out NaN, where no film reaches
    lines = [",".join("%.6f" % x for x in landed[i * len(landed) // count]) for i in range(count)]
    return "\n".join(["film_x_mm,film_y_mm,X_mm,Y_mm,Z_mm", *lines, ""])


def motion():
    """A downward path that is not exactly vertical."""
    return "t_s,x_mm,y_mm,z_mm\n" + "".join(f"{0.5 * i},{0.02 * i},{-0.01 * i},{100 - 2.5 * i}\n" for i in range(60))


def write_all(folder):
    """Writes the inputs shared by all runs."""
    folder.mkdir()
    (folder / "pose.json").write_text(pose(product(turn(20, 1, 0, 0), turn(15, 0, 0, 1)), [6, -9, 0]))
    (folder / "hung.json").write_text(pose(product(turn(-30, 1, 0, 0), turn(45, 0, 0, 1)), [0, 0, -95]))
    (folder / "film.toml").write_text(OTHER_FILM)
    (folder / "film_with_icc.toml").write_text(f'ink_icc_profile = "{CMYK_PROFILE}"\nink_ratio_mm = 0.08\n')
    (folder / "octagon.json").write_text(
        "[[-100, -60], [-60, -100], [60, -100], [100, -60], [100, 60], [60, 100], [-60, 100], [-100, 60]]")
    (folder / "motion.csv").write_text(motion())
    (folder / "drive.toml").write_text(DRIVE)
    (folder / "calibration-board.obj").write_text(board_obj())
    for view in range(VIEWS):
        (folder / f"view{view}.json").write_text(held_board(view))
    (folder / "not a mesh.obj").write_text("v 0 0 0\nf 1 2 3\n")
    (folder / "bad pose.json").write_text('{"rotation_wxyz": [0, 0, 0, 0]}')
    (folder / "far pose.json").write_text(pose([1, 0, 0, 0], [200, 0, 0]))
    (folder / "bad film.toml").write_text("\nthick_mm = 1\n")


def scene(mesh, hung, camera):
    return (f'[object]\nmesh = "{mesh}"\npose = "{hung}"\n[water]\nat_mm = {WATER_MM}\n'
            f'[axis]\nstart_mm = {WATER_MM - GRIPPER_MM}\n[camera]\nseed = 7\nclock = "frames"\n{camera}')


SWEEP = ("[camera.sweep]\nvia_mm = [[-150.0, -300.0, 700.0], [0.0, -250.0, 760.0], [150.0, -300.0, 700.0]]\n"
         "period_s = 8.0\n")


class Camera:
    """A virtual rig and hydroprint-capture of one build. The same scene gives identical frames."""

    def __init__(self, bin_folder, control):
        self.bin_folder, self.control = bin_folder, control

    def tell(self, line):
        with socket.socket(socket.AF_UNIX) as connection:
            connection.connect(str(self.control))
            connection.sendall(line.encode() + b"\n")
            connection.shutdown(socket.SHUT_WR)
            answer = b"".join(iter(lambda: connection.recv(4096), b"")).decode()
        if not answer or answer.startswith("error"):
            raise RuntimeError(f"the virtual rig does not take '{line}': {answer}")

    def take(self, folder, frames):
        subprocess.run([self.bin_folder / "hydroprint-capture", "--device", f"hydroprint:{self.control}", "--seconds",
                        str(frames / 30), "--patience-s", "300", "--out", folder],
                       check=True, capture_output=True, timeout=600)


@contextlib.contextmanager
def camera(bin_folder, inputs, scene_text):
    with tempfile.TemporaryDirectory() as name:  # sockets need a short path
        folder = pathlib.Path(name)
        (folder / "scene.toml").write_text(scene_text)
        rig, _ = programs.start([bin_folder / "hydroprint-virtual-rig", "--profile", inputs / "drive.toml",
                                 "--tcp", "0", "--scene", folder / "scene.toml", "--control", folder / "control"],
                                "(ready)")
        try:
            yield Camera(bin_folder, folder / "control")
        finally:
            rig.terminate()
            rig.wait()


def take_frames(bin_folder, inputs, mesh, out):
    """Captures the frames for calibrate ("hung"), calibrate-camera ("view0" and so on) and fuse ("sweep")."""
    with camera(bin_folder, inputs, scene(mesh, inputs / "hung.json", "")) as still:
        still.take(out / "hung", 12)
        for view in range(VIEWS):
            still.tell(f'show "{inputs}/view{view}.json" "{inputs}/calibration-board.obj"')
            still.take(out / f"view{view}", 5)
    with camera(bin_folder, inputs, scene(mesh, inputs / "hung.json", SWEEP)) as swept:
        swept.take(out / "sweep", 20)
