# SPDX-License-Identifier: Apache-2.0
"""Requests that are too large in every way: flood.py PROGRAM

Each is refused or cut off before it has been sent, and the process does not grow with it.
"""

import socket
import sys
import time
from urllib.parse import urlsplit

from service import Service, check, temporary_folder

PIECE = b"a" * 65536
HOST = b"Host: localhost\r\n"
POST = b"POST /v1/sweeps HTTP/1.1\r\n" + HOST


def chunks(size):
    for _ in range(size // len(PIECE)):
        yield b"10000\r\n" + PIECE + b"\r\n"
    yield b"0\r\n\r\n"


def headers(count):
    for number in range(0, count, 1000):
        yield b"".join(b"X-%d: 1\r\n" % n for n in range(number, number + 1000))
    yield b"\r\n"


# Parts that are sent, and the status if one comes: a client that is cut off while it still sends may not get to see the status.
FLOODS = {
    "a line of 200 MiB": ([b"GET / HTTP/1.1\r\n" + HOST + b"X: "] + [PIECE] * 3200, 431),
    "a million headers": ([b"GET / HTTP/1.1\r\n" + HOST, *headers(1_000_000)], 431),
    "a body of 1 TB": ([POST + b"Content-Length: 1000000000000\r\n\r\n"] + [PIECE] * 1024, 413),
    "chunks of 64 MiB": ([POST + b"Transfer-Encoding: chunked\r\n\r\n", *chunks(64 << 20)], 413),
    "a thousand ranges": ([b"GET / HTTP/1.1\r\n" + HOST + b"Range: bytes=" + b",".join([b"0-9"] * 1000) + b"\r\n\r\n"], 200),
}


def send_flood(service, parts):
    """Returns the status (0: none), how many bytes were taken, and how long it took."""
    address = urlsplit(service.url)
    started, sent, answer = time.monotonic(), 0, b""
    with socket.create_connection((address.hostname, address.port), timeout=20) as connection:
        try:
            for part in parts:
                connection.sendall(part)
                sent += len(part)
        except OSError:
            pass
        try:
            while part := connection.recv(65536):
                answer += part
        except OSError:
            pass
    return int(answer[9:12] or 0), sent, time.monotonic() - started


def resident_mb(service):
    with open(f"/proc/{service.process.pid}/status", encoding="ascii") as file:
        return next(int(line.split()[1]) for line in file if line.startswith("VmRSS")) / 1024


def main():
    service = Service(sys.argv[1], temporary_folder() / "store.db", "--threads", "1")
    send_flood(service, [POST + b"Content-Length: 2\r\n\r\n{]"])
    before = resident_mb(service)
    for what, (parts, expected) in FLOODS.items():
        status, sent, seconds = send_flood(service, parts)
        grown = resident_mb(service) - before
        check(status in (expected, 0), f"{what}: {status}")
        check(status != 0 or sent < sum(map(len, parts)), f"{what}: taken whole without an answer")
        check(grown < 32, f"{what}: the process grew by {grown:.1f} MiB")
        print(f"{what}: {status or 'cut off'} after {sent / (1 << 20):.1f} MiB and {seconds * 1e3:.0f} ms; grown by {grown:.1f} MiB")
    check(service.get("/healthz")["status"] == "ok", "not healthy afterwards")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")


main()
