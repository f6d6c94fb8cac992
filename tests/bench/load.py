"""Measures a daemon with a rig under load over HTTP: 100 watching pages and 20 simultaneous uploads.

Prints one JSON object per row. Usage: load.py FOLDER_OF_PROGRAMS RIG_PROFILE [--quick]
"""
import asyncio
import hashlib
import json
import os
import pathlib
import random
import re
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import programs

WATCHERS, UPLOADS = 100, 20
LEAST_NEWS = 50
UPLOAD_BYTES, PIECE_BYTES = 64 * 2**20, 2**18
MIB = 2**20
PATIENCE_S = 60


class Connection:
    """An HTTP/1.1 connection with one request at a time."""

    def __init__(self, address):
        self.address = address

    async def __aenter__(self):
        host, port = self.address.rsplit(":", 1)
        self.reader, self.writer = await asyncio.open_connection(host, int(port), limit=MIB)
        return self

    async def __aexit__(self, *_):
        self.writer.close()

    def head(self, method, target, length, fields):
        text = "".join(f"{name}: {value}\r\n" for name, value in fields.items())
        self.writer.write(f"{method} {target} HTTP/1.1\r\nHost: localhost\r\nContent-Length: {length}\r\n"
                          f"{text}\r\n".encode())

    async def answer(self):
        head = (await self.reader.readuntil(b"\r\n\r\n")).decode()
        status = int(head.split(None, 2)[1])
        length = re.search(r"\r\ncontent-length: (\d+)", head, re.I)
        body = await self.reader.readexactly(int(length[1])) if length else b""
        if status >= 400:
            raise RuntimeError(f"{status}: {body.decode(errors='replace')[:300]}")
        return json.loads(body) if body else None

    async def ask(self, method, target, body=None):
        data = b"" if body is None else json.dumps(body).encode()
        self.head(method, target, len(data), {})
        self.writer.write(data)
        return await self.answer()


async def watch(address, board):
    """Acts as a page: reads all events and reports every cancelled job to the board."""
    async with Connection(address) as connection:
        connection.head("GET", "/v1/events:watch", 0, {})
        await connection.reader.readuntil(b"\r\n\r\n")
        while True:
            line = await connection.reader.readline()
            if not line:
                raise RuntimeError("the daemon closed the connection of a watcher")
            if line.startswith(b"data:") and b'"CANCELLED"' in line:
                news = json.loads(line[5:])["job"]
                # An earlier event that arrives late also holds the job, which is cancelled by now.
                if news["event"]["state"] == "CANCELLED":
                    board.hear(news["job"]["name"])


class Board:
    """Counts the watchers that have received the latest event, and records the delays since its cause."""

    def __init__(self):
        self.job, self.delays_s, self.missing, self.all_heard = None, [], 0, asyncio.Event()

    def ask_for(self, job):
        self.job, self.asked, self.missing = job, time.monotonic(), WATCHERS
        self.all_heard.clear()

    def hear(self, job):
        if job != self.job:
            return
        self.delays_s.append(time.monotonic() - self.asked)
        self.missing -= 1
        if self.missing == 0:
            self.all_heard.set()


class File:
    """A file to upload: one random piece, repeated. It is hashed in advance, because hashing takes time."""

    def __init__(self, seed, size_bytes):
        self.piece, self.pieces = random.Random(seed).randbytes(PIECE_BYTES), size_bytes // PIECE_BYTES
        self.size_bytes = self.pieces * PIECE_BYTES
        digest = hashlib.sha256()
        for _ in range(self.pieces):
            digest.update(self.piece)
        self.sha256 = digest.hexdigest()


async def upload(address, file):
    """Uploads a whole file. Returns the asset's name."""
    async with Connection(address) as connection:
        begun = await connection.ask("POST", "/v1/uploads", {"sizeBytes": str(file.size_bytes), "sha256": file.sha256})
        connection.head("PATCH", "/v1/" + begun["upload"]["name"], file.size_bytes, {"Upload-Offset": "0"})
        for _ in range(file.pieces):
            connection.writer.write(file.piece)
            await connection.writer.drain()
        return (await connection.answer())["name"]


async def make_news(connection, board, asset):
    """Causes an event that all watchers receive: cancels a job in a paused queue."""
    spec = {"simulate": {"mesh": {"name": "m.obj", "asset": asset}}}
    job = (await connection.ask("POST", "/v1/jobs", spec))["name"]
    board.ask_for(job)
    await connection.ask("POST", f"/v1/{job}:cancel", {})
    await asyncio.wait_for(board.all_heard.wait(), PATIENCE_S)
    await connection.ask("DELETE", "/v1/" + job)


async def keep_making_news(address, board, asset, calls_s, is_over):
    async with Connection(address) as connection:
        number = 0
        while not is_over.is_set() or number < LEAST_NEWS:
            number += 1
            await make_news(connection, board, asset)
            began = time.monotonic()
            await connection.ask("GET", "/v1/jobs")
            calls_s.append(time.monotonic() - began)
            await asyncio.sleep(0.02)


def resident_mib(pid):
    pages = int(pathlib.Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / MIB


async def follow_memory(pid, seen_mib):
    while True:
        seen_mib.append(resident_mib(pid))
        await asyncio.sleep(0.05)


def share(values, part):
    return sorted(values)[min(len(values) - 1, int(part * len(values)))]


async def link_quality(address):
    async with Connection(address) as connection:
        return (await connection.ask("GET", "/v1/rig"))["linkQuality"]


def row(name, delays_s, calls_s, memory_mib, before_mib):
    return {"row": name, "news": len(delays_s) // WATCHERS,
            "news_p50_s": share(delays_s, 0.5), "news_p99_s": share(delays_s, 0.99), "news_max_s": max(delays_s),
            "call_p99_s": share(calls_s, 0.99), "call_max_s": max(calls_s),
            "daemon_mib": max(memory_mib), "more_mib": max(memory_mib) - before_mib}


async def measure(address, pid, size_bytes):
    before_mib, memory_mib = resident_mib(pid), []
    background = [asyncio.create_task(follow_memory(pid, memory_mib))]
    board = Board()
    background += [asyncio.create_task(watch(address, board)) for _ in range(WATCHERS)]
    async with Connection(address) as connection:
        await connection.ask("POST", "/v1/queue:pause", {"reason": "measured"})
    asset = await upload(address, File(-1, PIECE_BYTES))
    files = [File(seed, size_bytes) for seed in range(UPLOADS)]
    await asyncio.sleep(1)
    for name, sent in (("load-watchers", []), ("load-uploads", files)):
        board.delays_s, calls_s, is_over = [], [], asyncio.Event()
        news = asyncio.create_task(keep_making_news(address, board, asset, calls_s, is_over))
        began = time.monotonic()
        await asyncio.gather(*(upload(address, file) for file in sent))
        seconds = time.monotonic() - began
        is_over.set()
        await news
        for task in background:
            if task.done():
                task.result()  # raises the error that ended it
        found = row(name, board.delays_s, calls_s, memory_mib, before_mib)
        if sent:
            found["upload_mib_per_s"] = sum(file.size_bytes for file in sent) / MIB / seconds
        quality = await link_quality(address)
        found |= {"rig_late_max_s": quality["largestLatenessS"], "rig_late_rms_s": quality["rmsLatenessS"]}
        print(json.dumps(found), flush=True)
    for task in background:
        task.cancel()


def main():
    size_bytes = UPLOAD_BYTES // 8 if "--quick" in sys.argv else UPLOAD_BYTES
    with programs.daemon_with_rig(sys.argv[1], sys.argv[2]) as daemon:
        time.sleep(2)  # start-up is not measured
        asyncio.run(measure(daemon.http, daemon.process.pid, size_bytes))


if __name__ == "__main__":
    main()
