"""Modbus as servers speak it, over TCP and on a serial line: frames, checksums, and replies that go wrong."""
from __future__ import annotations

import os
import socket
import struct
import tty
from dataclasses import dataclass, field

from drive import Drive
from registers import NoRegister

UNIT = 7
READS, WRITES = (3, 4), (6, 16)
NO_FUNCTION, NO_ADDRESS, NO_VALUE = 1, 2, 3
TURNAROUND_S, BYTE_S = 0.001, 11 / 115200
BAD = ("lost", "damaged", "doubled", "late", "delayed")  # delayed: replies behind the late one wait for it
LATE_S = 0.120


def crc(data: bytes) -> bytes:
    """CRC-16 of the serial line, low byte first (MODBUS over Serial Line, V1.02, 6.2.2)."""
    out = 0xFFFF
    for byte in data:
        out ^= byte
        for _ in range(8):
            out = out >> 1 ^ (0xA001 if out & 1 else 0)
    return struct.pack("<H", out)


def answer(drive: Drive, pdu: bytes) -> bytes:
    """Carries out a request and returns the reply, which may be an exception."""
    function = pdu[0]
    try:
        if function in READS and len(pdu) == 5:
            address, count = struct.unpack(">HH", pdu[1:])
            if not 1 <= count <= 125:
                return bytes([function | 0x80, NO_VALUE])
            words = drive.read(address, count)
            return struct.pack(f">BB{count}H", function, 2 * count, *words)
        if function == 6 and len(pdu) == 5:
            address, value = struct.unpack(">HH", pdu[1:])
            drive.write(address, [value])
            return pdu
        if function == 16 and len(pdu) >= 6:
            address, count, size = struct.unpack(">HHB", pdu[1:6])
            if size != 2 * count or len(pdu) != 6 + size:
                return bytes([function | 0x80, NO_VALUE])
            drive.write(address, list(struct.unpack(f">{count}H", pdu[6:])))
            return pdu[:5]
    except NoRegister:
        return bytes([function | 0x80, NO_ADDRESS])
    return bytes([function | 0x80, NO_FUNCTION])


def request_size(frame: bytes) -> int | None:
    """Length of the serial request that begins here, with its checksum; None if more bytes are needed."""
    if len(frame) < 2:
        return None
    if frame[1] == 16:
        return None if len(frame) < 7 else 9 + frame[6]
    return 8


@dataclass
class Strike:
    """One bad reply: the first one to a read, or to a write that starts nothing, from this time on."""
    kind: str
    from_s: float
    hit_s: float | None = None


@dataclass
class Outgoing:
    """Bytes that wait for their time."""
    due_s: float
    data: bytes


@dataclass
class Channel:
    """One connection of a client, or the serial line."""
    file: int
    received: bytes = b""
    waiting: list[Outgoing] = field(default_factory=list)
    busy_until_s: float = 0.0

    def flush(self, now_s: float) -> None:
        for item in [each for each in self.waiting if each.due_s <= now_s]:
            self.waiting.remove(item)
            os.write(self.file, item.data)


class Wire:
    """What both kinds of wires have in common."""
    channels: list[Channel]

    def __init__(self, drive: Drive):
        self.drive, self.strike, self.channels = drive, None, []

    def take(self, channel: Channel) -> bytes | None:
        """The next complete request of a channel, without its frame; None if there is none yet."""
        raise NotImplementedError

    def framed(self, pdu: bytes, damaged: bool) -> bytes:
        raise NotImplementedError

    def serve(self, channel: Channel) -> None:
        try:
            data = os.read(channel.file, 4096)
        except BlockingIOError:
            return
        if not data:
            raise ConnectionError
        channel.received += data
        while (pdu := self.take(channel)) is not None:
            if self.drive.off:
                continue
            self.drive.heard()
            started = sum(event.what.startswith("start") for event in self.drive.events)
            reply = answer(self.drive, pdu)
            starts = started != sum(event.what.startswith("start") for event in self.drive.events)
            self.send(channel, reply, starts)

    def send(self, channel: Channel, reply: bytes, starts: bool) -> None:
        now_s, kind = self.drive.now_s, None
        if self.strike and self.strike.hit_s is None and now_s >= self.strike.from_s and not starts:
            self.strike.hit_s, kind = now_s, self.strike.kind
        data = self.framed(reply, kind == "damaged")
        due_s = max(channel.busy_until_s, now_s + TURNAROUND_S + BYTE_S * len(data))
        if kind in ("late", "delayed"):
            due_s = now_s + LATE_S
        if kind != "late":
            channel.busy_until_s = due_s
        for _ in range({"lost": 0, "doubled": 2}.get(kind, 1)):
            channel.waiting.append(Outgoing(due_s, data))

    def drop(self, channel: Channel) -> None:
        """The power is off, or the client is gone. A serial line stays."""

    def close(self) -> None:
        """Closes all files."""
        for channel in list(self.channels):
            self.drop(channel)


class TcpWire(Wire):
    def __init__(self, drive: Drive):
        super().__init__(drive)
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.listener.setblocking(False)
        self.sockets: dict[int, socket.socket] = {}
        self.transaction = b""

    @property
    def endpoint(self) -> str:
        return f"tcp:127.0.0.1:{self.listener.getsockname()[1]}"

    def close(self) -> None:
        super().close()
        self.listener.close()

    def accept(self) -> None:
        client, _ = self.listener.accept()
        client.setblocking(False)
        client.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self.sockets[client.fileno()] = client
        self.channels.append(Channel(client.fileno()))

    def drop(self, channel: Channel) -> None:
        if channel in self.channels:
            self.channels.remove(channel)
            self.sockets.pop(channel.file).close()

    def take(self, channel: Channel) -> bytes | None:
        frame = channel.received
        if len(frame) < 7 or len(frame) < 6 + int.from_bytes(frame[4:6], "big"):
            return None
        size = 6 + int.from_bytes(frame[4:6], "big")
        self.transaction, channel.received = frame[:2], frame[size:]
        return frame[7:size] if frame[6] == UNIT else self.take(channel)

    def framed(self, pdu: bytes, damaged: bool) -> bytes:
        if damaged:
            pdu = bytes([pdu[0] ^ 0x40]) + pdu[1:]
        return self.transaction + struct.pack(">HHB", 0, len(pdu) + 1, UNIT) + pdu


class RtuWire(Wire):
    def __init__(self, drive: Drive):
        super().__init__(drive)
        master, self.slave = os.openpty()
        tty.setraw(self.slave)
        os.set_blocking(master, False)
        self.listener = None
        self.channels = [Channel(master)]

    @property
    def endpoint(self) -> str:
        return f"rtu:{os.ttyname(self.slave)}?baud=115200&parity=E&stop=1"

    def close(self) -> None:
        os.close(self.channels[0].file)
        os.close(self.slave)

    def take(self, channel: Channel) -> bytes | None:
        size = request_size(channel.received)
        if size is None or len(channel.received) < size:
            return None
        frame, channel.received = channel.received[:size], channel.received[size:]
        if crc(frame[:-2]) != frame[-2:]:
            channel.received = b""  # not in step: waits for the next request
            return None
        return frame[1:-2] if frame[0] == UNIT else self.take(channel)

    def framed(self, pdu: bytes, damaged: bool) -> bytes:
        frame = bytes([UNIT]) + pdu
        frame += crc(frame)
        return frame[:3] + bytes([frame[3] ^ 0x04]) + frame[4:] if damaged else frame


WIRES = {"tcp": TcpWire, "rtu": RtuWire}
