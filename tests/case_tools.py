"""Tools of cases.py: runs commands, reads pictures, compares values."""
import os
import re
import resource
import signal
import struct
import subprocess
import threading
import zlib
from collections import namedtuple
from pathlib import Path

TREE = Path(__file__).resolve().parent.parent
Result = namedtuple("Result", "status text mib")  # status: below 0 for a signal; mib: greatest memory
Right = namedtuple("Right", "text test")


class Skip(Exception):
    """Says what is missing here."""


def read_picture(file):
    """Rows of pixels, from the top: floats of a PFM, bytes of an 8-bit PNG."""
    data = Path(file).read_bytes()
    if data.startswith(b"P"):
        kind, size, order, rest = data.split(b"\n", 3)
        width, height, channels = *map(int, size.split()), 3 if kind == b"PF" else 1
        values = struct.unpack(f"{'<' if float(order) < 0 else '>'}{width * height * channels}f", rest)
        rows = [values[y * width * channels:(y + 1) * width * channels] for y in reversed(range(height))]
    else:
        width, height, _, kind = struct.unpack(">IIBB", data[16:26])
        channels, packed, at, rows = {0: 1, 2: 3, 6: 4}[kind], b"", 8, []
        while at < len(data):
            length, name = struct.unpack(">I4s", data[at:at + 8])
            packed, at = packed + (data[at + 8:at + 8 + length] if name == b"IDAT" else b""), at + 12 + length
        raw, above = zlib.decompress(packed), bytes(width * channels)
        for y in range(height):
            line = bytearray(raw[y * (width * channels + 1):(y + 1) * (width * channels + 1)])
            method, row = line[0], line[1:]
            for i, _ in enumerate(row):
                a, b, c = row[i - channels] if i >= channels else 0, above[i], above[i - channels] if i >= channels else 0
                nearest = min((a, b, c), key=lambda v: abs(a + b - c - v))
                row[i] = (row[i] + (0, a, b, (a + b) // 2, nearest)[method]) & 255
            above = bytes(row)
            rows.append(above)
    return [[tuple(row[x * channels:(x + 1) * channels]) for x in range(width)] for row in rows]


def mean(picture, u0=0, v0=0, u1=1, v1=1, channel=1):
    """The mean of a channel between two places, in shares of the width and height from the upper left."""
    height, width = len(picture), len(picture[0])
    columns = range(int(u0 * width), max(int(u0 * width) + 1, int(u1 * width)))
    rows = range(int(v0 * height), max(int(v0 * height) + 1, int(v1 * height)))
    return sum(picture[y][x][channel] for y in rows for x in columns) / len(rows) / len(columns)


def pixel(picture, u=0.5, v=0.5):
    return picture[int(v * len(picture))][int(u * len(picture[0]))]


def share(picture, wanted, v0=0):
    """The share of pixels that fit, below a row."""
    pixels = [p for row in picture[int(v0 * len(picture)):] for p in row]
    return sum(map(wanted, pixels)) / len(pixels)


def different(a, b, by=0.1):
    pairs = [(p, q) for row, other in zip(a, b) for p, q in zip(row, other)]
    return sum(max(abs(x - y) for x, y in zip(p, q)) > by for p, q in pairs) / len(pairs)


def strays(picture):
    """Pixels that none of their eight neighbours is like: all of those are the background."""
    empty = [[p == picture[0][0] for p in row] for row in picture]
    around = [(dy, dx) for dy in (-1, 0, 1) for dx in (-1, 0, 1) if dy or dx]
    return sum(not empty[y][x] and all(empty[y + dy][x + dx] for dy, dx in around)
               for y in range(1, len(empty) - 1) for x in range(1, len(empty[0]) - 1))


class Case:
    """A copy of a case's folder, with what is run in it."""

    def __init__(self, folder, program, python):
        self.folder, self.program, self.python = folder, program, python
        self.environment = {**os.environ, "PATH": f"{folder.parent.parent / 'bin'}:{os.environ.get('PATH', '/usr/bin:/bin')}"}

    def run(self, *command, limits=None, seconds=300, **more):
        def prepare():
            for name, value in (limits or {}).items():
                resource.setrlimit(getattr(resource, name), (value, value))
        environment = {k: v for k, v in {**self.environment, **more.pop("env", {})}.items() if v is not None}
        process = subprocess.Popen([str(c) for c in command], cwd=self.folder, env=environment, preexec_fn=prepare,
                                   stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                   start_new_session=True, **more)
        guard = threading.Timer(seconds, lambda: os.killpg(process.pid, signal.SIGKILL))
        guard.start()
        text = process.stdout.read().decode(errors="replace")
        _, status, used = os.wait4(process.pid, 0)
        guard.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        return Result(process.returncode, text, used.ru_maxrss // 1024)

    def sundog(self, *arguments, **more):
        return self.run(self.program, *arguments, **more)

    def render(self, scene, *options, out="out.pfm", **more):
        return self.sundog("render", scene, "-q", "-o", out, *options, **more)

    def picture(self, scene, *options, out="out.pfm"):
        (self.folder / out).unlink(missing_ok=True)
        result = self.render(scene, *options, out=out)
        if result.status != 0:
            raise RuntimeError(f"status {result.status}: {result.text.strip()[:200]}")
        return read_picture(self.folder / out)


# Right answers.
near = lambda *wanted, within=0.02: Right(
    f"{wanted[0] if len(wanted) == 1 else wanted} +-{within}",
    lambda got: all(abs(g - w) <= within for g, w in zip(got if isinstance(got, tuple) else (got,), wanted)))
at_most = lambda most: Right(f"<= {most}", lambda got: max(got if isinstance(got, tuple) else (got,)) <= most)
at_least = lambda least: Right(f">= {least}", lambda got: min(got if isinstance(got, tuple) else (got,)) >= least)
is_ = lambda wanted: Right(str(wanted), lambda got: got == wanted)
quiet = Right("status 0, no warning", lambda got: got.status == 0 and "warning" not in got.text)


def says(pattern, status=tuple(range(1, 127)), mib=10**9):
    """An end with one of these statuses, by default an error, and a text with the pattern."""
    statuses = status if isinstance(status, tuple) else (status,)
    ends = "an error" if len(statuses) > 9 else f"status {' or '.join(map(str, statuses))}"
    text = ends + (f", /{pattern}/" if pattern else "") + (f", <= {mib} MiB" if mib < 10**9 else "")
    return Right(text, lambda got: got.status in statuses and re.search(pattern, got.text) is not None and got.mib <= mib)
