"""Starts our programs, for what drives them from outside."""
import contextlib
import pathlib
import re
import subprocess
import tempfile
import threading


def start(command, ready):
    """Starts a program and waits for the line that says where it listens. Returns it and what `ready` caught."""
    child = subprocess.Popen([str(part) for part in command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                             text=True)
    said = []
    for line in child.stdout:
        said.append(line)
        found = re.search(ready, line)
        if found:
            # What it says from here on must not fill the pipe.
            threading.Thread(target=lambda: [None for _ in child.stdout], daemon=True).start()
            return child, found[1]
    raise RuntimeError(f"{command[0]} did not start: {''.join(said)[-2000:]}")


@contextlib.contextmanager
def daemon_with_rig(programs, profile, *arguments):
    """A daemon with a virtual rig, its camera, and a state folder of its own; yields the daemon and its address of
    HTTP."""
    programs, children = pathlib.Path(programs), []
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "hydroprintd.toml").write_text(f'[camera]\ndevice = "hydroprint:{folder}/control"\n')
        (folder / "scene.toml").write_text("[water]\nat_mm = 240\n[camera]\nseed = 4\n")
        try:
            rig, rig_address = start([programs / "hydroprint-virtual-rig", "--profile", profile, "--tcp", "0",
                                      "--control", folder / "control", "--scene", folder / "scene.toml"],
                                     r"(127\.0\.0\.1:\d+)")
            children.append(rig)
            daemon, address = start([programs / "hydroprintd", "--grpc", "127.0.0.1:0", "--http", "127.0.0.1:0",
                                     "--config", folder / "hydroprintd.toml", "--state-dir", folder / "state",
                                     "--rig", f"tcp:{rig_address}", "--rig-profile", profile, *arguments],
                                    r"\bhttp=(\S+:\d+)")
            children.append(daemon)
            yield daemon, address
        finally:
            for child in reversed(children):
                child.terminate()
                child.wait()
