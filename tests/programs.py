"""Starts the project's programs for tests that drive them from outside."""
import contextlib
import pathlib
import re
import subprocess
import tempfile
import threading
import typing


def start(command, ready):
    """Starts a program and waits for an output line that matches `ready`. Returns the process and the match."""
    child = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             text=True)
    said = []
    for line in child.stdout:
        said.append(line)
        found = re.search(ready, line)
        if found:
            # Reads further output, so that it cannot fill the pipe.
            threading.Thread(target=lambda: [None for _ in child.stdout], daemon=True).start()
            return child, found
    raise RuntimeError(f"{command[0]} did not start: {''.join(said)[-2000:]}")


class Daemon(typing.NamedTuple):
    """A running daemon: its process, its addresses, and a folder for files of the test."""
    process: subprocess.Popen
    http: str
    grpc: str
    folder: pathlib.Path


@contextlib.contextmanager
def daemon_with_rig(programs, profile, *arguments):
    """Yields a Daemon with a virtual rig, a virtual camera, and its own state folder."""
    programs, children = pathlib.Path(programs), []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "hydroprintd.toml").write_text(f'[camera]\ndevice = "hydroprint:{folder}/control"\n')
        (folder / "scene.toml").write_text("[water]\nat_mm = 240\n[camera]\nseed = 4\n")
        try:
            rig, found = start([programs / "hydroprint-virtual-rig", "--profile", profile, "--tcp", "0",
                                "--control", folder / "control", "--scene", folder / "scene.toml"],
                               r"(127\.0\.0\.1:\d+)")
            children.append(rig)
            daemon, found = start([programs / "hydroprintd", "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0",
                                   "--config", folder / "hydroprintd.toml", "--state-dir", folder / "state",
                                   "--rig", f"tcp:{found[1]}", "--rig-profile", profile, *arguments],
                                  r"\bgrpc=(\S+:\d+) http=(\S+:\d+)")
            children.append(daemon)
            yield Daemon(daemon, found[2], found[1], folder)
        finally:
            for child in reversed(children):
                child.terminate()
                child.wait()
