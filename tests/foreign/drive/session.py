"""Starts hydroprintd with the simulated drive, and commands the rig over its REST interface."""
from __future__ import annotations

import http.client
import json
import pathlib
import re
import subprocess
import tempfile
import threading
import time

import drive_profile
from simulator import Simulator

READY = re.compile(r"\bgrpc=(\S+:\d+) http=(\S+):(\d+)")
JOG_S = 0.08  # between two jog requests
AXIS = {"end_low_mm": -5.0, "end_high_mm": 305.0, "keep_out_mm": 13.0, "max_speed_mm_per_s": drive_profile.MAX_SPEED}


class NotStarted(Exception):
    """Raised if the daemon does not start."""


class Refused(Exception):
    """Raised if the daemon refuses a command."""


class Daemon:
    """hydroprintd with a state folder of its own, connected to a simulator."""

    def __init__(self, program: pathlib.Path, simulator: Simulator, timing: drive_profile.Timing,
                 axis: dict | None = None):
        self.folder = tempfile.TemporaryDirectory(prefix="drive-judge-")
        folder = pathlib.Path(self.folder.name)
        (folder / "drive.toml").write_text(drive_profile.text(timing))
        lines = [f"{key} = {value}" for key, value in {**AXIS, **(axis or {})}.items()]
        (folder / "hydroprintd.toml").write_text("[rig]\n" + "\n".join(lines) + "\n")
        self.lines: list[str] = []
        try:
            self.process = subprocess.Popen(
                [program, "--config", folder / "hydroprintd.toml", "--state-dir", folder / "state", "--grpc",
                 "127.0.0.1:0", "--http", "127.0.0.1:0", "--rig", simulator.endpoint, "--rig-profile",
                 folder / "drive.toml"],
                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        except OSError as error:
            raise NotStarted(str(error)) from error
        self.host, self.port = self.wait_until_ready()
        threading.Thread(target=lambda: self.lines.extend(self.process.stdout), daemon=True).start()

    def wait_until_ready(self) -> tuple[str, int]:
        for line in self.process.stdout:
            self.lines.append(line)
            if found := READY.search(line):
                return found[2], int(found[3])
        raise NotStarted("".join(self.lines)[-600:])

    def ask(self, method: str, path: str, body: dict | None = None) -> dict:
        connection = http.client.HTTPConnection(self.host, self.port, timeout=30)
        try:
            connection.request(method, path, None if body is None else json.dumps(body),
                               {} if body is None else {"Content-Type": "application/json"})
            reply = connection.getresponse()
            value = json.loads(reply.read() or b"{}")
        finally:
            connection.close()
        if reply.status != 200:
            error = value.get("error", {})
            reasons = [detail["reason"] for detail in error.get("details", []) if detail.get("reason")]
            raise Refused(f"{path}: {' '.join(reasons)} {error.get('message', '')}")
        return value

    def __enter__(self) -> "Daemon":
        return self

    def __exit__(self, *_: object) -> None:
        self.process.terminate()
        try:
            self.process.wait(20)
        except subprocess.TimeoutExpired:
            self.process.kill()
        self.folder.cleanup()


class Operator:
    """A client that holds the lease."""

    def __init__(self, daemon: Daemon):
        self.daemon = daemon
        self.lease = daemon.ask("POST", "/v1/rig/lease:acquire", {"purpose": "judge", "ttl": "7200s"})["leaseId"]
        self.jog_end = threading.Event()
        self.jogger: threading.Thread | None = None
        self.refusals: list[str] = []

    def command(self, verb: str, **fields: object) -> dict:
        return self.daemon.ask("POST", f"/v1/rig:{verb}", {"leaseId": self.lease, **fields})

    def rig(self) -> dict:
        return self.daemon.ask("GET", "/v1/rig")

    def wait(self, *states: str, seconds: float = 30) -> dict:
        """Waits for one of these states. Returns the rig as it then is, whether or not it got there."""
        end = time.monotonic() + seconds
        while (rig := self.rig()).get("state") not in states and time.monotonic() < end:
            time.sleep(0.01)
        return rig

    def prepare(self) -> dict:
        """Arms and homes."""
        self.wait("DISARMED", seconds=10)
        self.command("arm")
        return self.home()

    def home(self) -> dict:
        self.command("home")
        return self.wait("IDLE", "FAULT", "ESTOPPED", "UNHOMED", "OFFLINE")

    def move(self, position_mm: float, speed: float) -> dict:
        self.command("moveTo", positionMm=position_mm, speedMmPerS=speed)
        return self.wait("IDLE", "FAULT", "ESTOPPED", "OFFLINE", "DISARMED", seconds=60)

    def jog(self, speed: float) -> None:
        """Jogs from now on, in the background; another call changes the speed."""
        self.jog_speed = speed
        if self.jogger is None:
            self.jog_end.clear()
            self.jogger = threading.Thread(target=self.keep_jogging, daemon=True)
            self.jogger.start()

    def keep_jogging(self) -> None:
        while not self.jog_end.is_set():
            try:
                self.command("jog", speedMmPerS=self.jog_speed)
            except Refused as error:
                self.refusals.append(str(error))
                return
            self.jog_end.wait(JOG_S)

    def end_jog(self) -> None:
        self.jog_end.set()
        if self.jogger:
            self.jogger.join()
            self.jogger = None

    def dip(self, depth_mm: float, speed: float, hold_s: float = 0.2) -> str:
        """Starts a dip at the present position, without confirmations. Returns the job's name."""
        spec = {"depthMm": depth_mm, "speedMmPerS": speed, "holdS": hold_s, "clearanceMm": 5, "yesToAll": True}
        return self.daemon.ask("POST", f"/v1/jobs?leaseId={self.lease}", {"dip": spec})["name"]
