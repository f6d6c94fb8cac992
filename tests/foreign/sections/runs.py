"""Runs hydroprint-worker on a body, with its processor time and memory."""
from __future__ import annotations

import json
import os
import pathlib
import resource
import signal
import subprocess
import threading
from dataclasses import dataclass

import numpy as np

import meshes
from bodies import Body
from claims import Outcome

import ply

PAINT = {"base_colour": "#d02020"}
WARNING = "hydroprint-worker: warning:"


class WorkerFailed(Exception):
    """The worker could not be run, or does not know its flags."""


@dataclass(frozen=True)
class Surface:
    """surface_map.ply: where the film lands. Film is NaN where none arrives."""
    points: np.ndarray
    triangles: np.ndarray
    film: np.ndarray


def write_inputs(body: Body, folder: pathlib.Path) -> list[str]:
    """Writes mesh, pose and paint. Returns the flags for them."""
    mesh = folder / ("body" + body.suffix)
    meshes.write(mesh, body.shape)
    (folder / "pose.json").write_text(json.dumps(body.pose()))
    (folder / "paint.json").write_text(json.dumps(PAINT))
    return ["--mesh", str(mesh), "--scale", f"{body.scale:.17g}", "--pose", str(folder / "pose.json"), "--paint",
            str(folder / "paint.json"), "--film", body.film]


def command_of(worker: pathlib.Path, body: Body, folder: pathlib.Path) -> list[str]:
    return [str(worker), "simulate", *write_inputs(body, folder), "--model", "stokes", "--ink-passes", "0", "--dpi",
            "100", "--out", str(folder / "print")]


def run(worker: pathlib.Path, body: Body, folder: pathlib.Path, most_cpu_s: float, most_wall_s: float) -> Outcome:
    """Runs the worker; stops it after a time. Its artifacts are in the folder `print`."""
    folder.mkdir()
    command = command_of(worker, body, folder)
    progress, out, err = (folder / name for name in ("progress.txt", "stdout.txt", "stderr.txt"))
    with progress.open("wb") as progress_file, out.open("wb") as out_file, err.open("wb") as err_file:
        number = progress_file.fileno()
        try:
            child = subprocess.Popen([*command, "--progress-fd", str(number)], stdout=out_file, stderr=err_file,
                                     pass_fds=[number])
        except OSError as error:
            raise WorkerFailed(f"{worker}: {error.strerror}") from error
        outcome = watched(child, most_cpu_s, most_wall_s)
    if outcome[0] == 2:
        raise WorkerFailed(f"exit status 2: {err.read_text(errors='replace').strip()}")
    return Outcome(*outcome, stages_of(progress), errors_of(err))


def watched(child: subprocess.Popen, most_cpu_s: float, most_wall_s: float) -> tuple[int, bool, float, float]:
    """Waits. Returns the exit status, whether the child was stopped, and its processor time and peak memory."""
    most = int(most_cpu_s)
    resource.prlimit(child.pid, resource.RLIMIT_CPU, (most, most + 10))  # ends with SIGXCPU
    stopped = threading.Event()

    def stop() -> None:
        stopped.set()
        child.kill()

    timer = threading.Timer(most_wall_s, stop)
    timer.start()
    try:
        _, status, usage = os.wait4(child.pid, 0)
    finally:
        timer.cancel()
    child.returncode = os.waitstatus_to_exitcode(status)
    seconds = usage.ru_utime + usage.ru_stime
    killed = stopped.is_set() or child.returncode == -signal.SIGXCPU
    return child.returncode, killed, seconds, usage.ru_maxrss * 1024.0


def stages_of(path: pathlib.Path) -> tuple[str, ...]:
    out: list[str] = []
    for line in path.read_text(errors="replace").splitlines():
        try:
            stage = json.loads(line)["stage"]
        except (ValueError, KeyError, TypeError):
            continue
        if stage not in out:
            out.append(stage)
    return tuple(out)


def errors_of(path: pathlib.Path) -> tuple[str, ...]:
    lines = path.read_text(errors="replace").splitlines()
    return tuple(line for line in lines if line.strip() and not line.startswith(WARNING))


def read_surface(path: pathlib.Path) -> Surface:
    found = ply.read(path)
    film = np.stack([found.vertices["film_x"], found.vertices["film_y"]], axis=1).astype(float)
    return Surface(found.points_mm, found.triangles, film)
