# SPDX-License-Identifier: Apache-2.0
"""What the tests of the package share: the program under test, and a server that answers as it is told."""

import contextlib
import json
import os
import socket
import threading
import unittest

import rpsup

PROGRAM = os.environ.get("RPSUP_TEST_PROGRAM", "")
SHORT = {"duration_s": 0.3, "run_up_s": 0.1}

for name in [name for name in os.environ if name.startswith("RPSUP_")]:
    del os.environ[name]  # options of whoever runs the tests are not part of a test


class WithProgram(unittest.TestCase):
    """Tests that share one started program, whose sweep of four jobs has ended."""

    @classmethod
    def setUpClass(cls):
        cls.client = rpsup.start(program=PROGRAM, threads=2)
        cls.addClassCleanup(cls.client.close)
        cls.sweep = cls.client.submit(clearance_mm=[0, 0.25], coupler=["rigid", "flexible"], **SHORT).wait()


def http(status, body, *headers, length=None):
    """Bytes of an answer. `length` may claim another length of the body than it has."""
    data = body if isinstance(body, bytes) else json.dumps(body).encode()
    lines = [
        f"HTTP/1.1 {status} Said",
        f"Content-Length: {len(data) if length is None else length}",
        *headers,
    ]
    return "\r\n".join([*lines, "Connection: close", "", ""]).encode() + data


class FakeServer:
    """Server that gives the next of its answers to each connection, and keeps the requests.

    An answer is a bytes object, or a function of the request that returns one. An empty one closes the
    connection without an answer.
    """

    def __init__(self, *answers):
        self.answers = list(answers)
        self.requests = []  # (first line, {header: value}, body)
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.url = f"http://127.0.0.1:{self._listener.getsockname()[1]}"
        self._thread = threading.Thread(target=self._serve, daemon=True)

    def client(self, **options):
        return rpsup.Client(self.url, patience_s=options.pop("patience_s", 5.0), **options)

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *_):
        with contextlib.suppress(OSError):
            self._listener.shutdown(socket.SHUT_RDWR)  # wakes the thread up
        self._thread.join(10)
        self._listener.close()

    def _serve(self):
        for answer in self.answers:
            try:
                connection, _ = self._listener.accept()
            except OSError:
                return
            with connection, connection.makefile("rb") as stream:
                first = stream.readline().decode().strip()
                headers = dict(
                    line.decode().strip().split(": ", 1) for line in iter(stream.readline, b"\r\n")
                )
                request = (first, headers, stream.read(int(headers.get("Content-Length", 0))))
                self.requests.append(request)
                connection.sendall(answer(request) if callable(answer) else answer)
        self._listener.close()  # further connections are refused
