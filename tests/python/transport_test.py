# SPDX-License-Identifier: Apache-2.0
"""Requests that fail: each is sent again exactly where no harm can come of it."""

import os
import socket
import tempfile
import time
import unittest

import rpsup
from support import FakeServer, WithProgram, http

CREATED = http(201, {"id": "swp_1"})
BUSY, FULL = (
    http(
        status,
        {"type": "about:blank", "title": title, "status": status, "detail": "too many"},
        "Retry-After: 1",
    )
    for status, title in ((503, "Service Unavailable"), (429, "Too Many Requests"))
)


def free_url():
    with socket.create_server(("127.0.0.1", 0)) as listener:
        return f"http://127.0.0.1:{listener.getsockname()[1]}"


class SendsAgain(unittest.TestCase):
    def test_after_the_seconds_that_the_service_asks_for(self):
        with FakeServer(BUSY, FULL, CREATED) as server:
            start = time.monotonic()
            sweep = server.client().submit(clearance_mm=[0])
            self.assertGreaterEqual(time.monotonic() - start, 2.0)
        self.assertEqual(sweep.id, "swp_1")
        self.assertEqual(len(server.requests), 3)

    def test_with_the_same_idempotency_key_after_a_dropped_connection(self):
        with FakeServer(b"", b"HTTP/1.1 201 Crea", http(201, b'{"id":', length=100), CREATED) as server:
            self.assertEqual(server.client().submit(clearance_mm=[0]).id, "swp_1")
        self.assertEqual(len(server.requests), 4)
        self.assertEqual(len({headers["Idempotency-Key"] for _, headers, _ in server.requests}), 1)
        self.assertEqual(len({body for _, _, body in server.requests}), 1)

    def test_with_another_key_for_another_request(self):
        with FakeServer(CREATED, CREATED) as server:
            client = server.client()
            client.submit(clearance_mm=[0])
            client.submit(clearance_mm=[0])
        self.assertEqual(len({headers["Idempotency-Key"] for _, headers, _ in server.requests}), 2)

    def test_while_the_first_request_is_being_stored(self):
        conflict = http(409, {"title": "Conflict", "status": 409, "detail": "is being stored"})
        with FakeServer(b"", conflict, CREATED) as server:
            self.assertEqual(server.client().submit(clearance_mm=[0]).id, "swp_1")
        with FakeServer(conflict) as server, self.assertRaises(rpsup.Error) as caught:
            server.client().submit(clearance_mm=[0])  # the first answer: no earlier request of its own
        self.assertEqual(caught.exception.status, 409)

    def test_no_request_without_a_key_that_may_have_been_taken(self):
        with FakeServer(b"", CREATED) as server, self.assertRaises(rpsup.Unreachable):
            server.client().sweep("swp_1").retry()
        self.assertEqual(len(server.requests), 1)

    def test_a_request_without_a_key_that_was_not_taken(self):
        with FakeServer(BUSY, http(200, {"state": "queued"})) as server:
            self.assertEqual(server.client().sweep("swp_1").retry()["state"], "queued")
        self.assertEqual(len(server.requests), 2)

    def test_a_deletion_whose_answer_was_lost(self):
        missing = http(404, {"title": "Not Found", "status": 404, "detail": "no such sweep"})
        with FakeServer(b"", missing) as server:
            server.client().sweep("swp_1").delete()
        with FakeServer(missing) as server, self.assertRaises(rpsup.Error):
            server.client().sweep("swp_1").delete()

    def test_a_request_that_waited_long_before_its_connection_broke(self):
        def late_and_nothing(_):
            time.sleep(1.5)
            return b""

        with FakeServer(late_and_nothing, http(200, {"state": "running"})) as server:
            status = server.client(patience_s=1.0).get("/v1/sweeps/swp_1")
        self.assertEqual((status["state"], len(server.requests)), ("running", 2))

    def test_lists_of_other_libraries_as_lists(self):
        class Names:
            def tolist(self):
                return ["a", "b"]

        with FakeServer(http(200, {})) as server:
            server.client().get("/v1/jobs", {"channels": Names()})
        self.assertIn("channels=a,b ", server.requests[0][0])

    def test_only_as_long_as_the_client_is_patient(self):
        with FakeServer(BUSY, BUSY) as server, self.assertRaises(rpsup.Error) as caught:
            server.client(patience_s=0.5).submit(clearance_mm=[0])
        self.assertEqual((caught.exception.status, len(server.requests)), (503, 1))


class Waits(unittest.TestCase):
    def test_no_longer_than_the_client_waits_for_an_answer(self):
        for timeout_s, wanted in ((90.0, "wait=30"), (5.0, "wait=2"), (1.0, None)):
            with self.subTest(timeout_s), FakeServer(http(200, {"state": "succeeded"})) as server:
                server.client(timeout_s=timeout_s).sweep("swp_1").wait(progress=False)
                self.assertEqual(server.requests[0][1].get("Prefer"), wanted)


    def test_for_a_service_that_starts_anew(self):
        with FakeServer(http(200, {"state": "running"}), BUSY, http(502, {}), b"", http(200, {"state": "succeeded"})) as server:
            server.client(patience_s=1.0).sweep("swp_1").wait(progress=False)
        self.assertEqual(len(server.requests), 5)


class Refuses(unittest.TestCase):
    def test_a_service_that_is_not_there(self):
        start = time.monotonic()
        with self.assertRaisesRegex(rpsup.Unreachable, "Connection refused"):
            rpsup.Client(free_url(), patience_s=0.5).get("/v1/sweeps")
        self.assertLess(time.monotonic() - start, 5)

    def test_answers_that_are_no_answers_of_the_service(self):
        for name, answer in {
            "no HTTP": b"SSH-2.0-OpenSSH\r\n\r\n",
            "no JSON": http(200, b"<html>"),
            "no id": http(201, ["swp_1"]),
            "an error of a proxy": http(500, b"<html>bad gateway"),
            "an error that is a list": http(500, []),
        }.items():
            with self.subTest(name), FakeServer(answer) as server, self.assertRaises(rpsup.BadAnswer):
                server.client().submit(clearance_mm=[0])
            self.assertEqual(len(server.requests), 1)

    def test_addresses_that_are_none(self):
        for url in ("ftp://host", "http://", "file:///etc/passwd"):
            with self.subTest(url), self.assertRaises(ValueError):
                rpsup.Client(url)


class Downloads(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.file = os.path.join(folder.name, "study.npz")

    def test_a_whole_file_with_the_names_of_the_interface(self):
        body = os.urandom(3_000_000)
        with FakeServer(http(200, body)) as server:
            sweep = server.client().sweep("swp_1")
            written = sweep.trajectories(
                self.file, channels=["journal_x_mm", "journal_y_mm"], from_s=0.5, to_s=2
            )
        self.assertEqual(
            server.requests[0][0],
            "GET /v1/sweeps/swp_1/trajectories?format=npz"
            "&channels=journal_x_mm,journal_y_mm&from=0.5&to=2 HTTP/1.1",
        )
        with open(written, "rb") as file:
            self.assertEqual(file.read(), body)

    def test_again_what_ended_early_and_leaves_nothing_half(self):
        with open(self.file, "wb") as file:
            file.write(b"older")
        cut = http(200, b"x" * 2_000_000, length=3_000_000)
        with FakeServer(cut) as server, self.assertRaises(rpsup.Unreachable):
            server.client(patience_s=0.5).trajectories("swp_1", self.file)
        self.assertEqual(os.listdir(os.path.dirname(self.file)), ["study.npz"])
        with open(self.file, "rb") as file:
            self.assertEqual(file.read(), b"older")
        with FakeServer(cut, http(200, b"whole")) as server:
            server.client().trajectories("swp_1", self.file)
        with open(self.file, "rb") as file:
            self.assertEqual(file.read(), b"whole")

    def test_in_chunks_that_end_early(self):
        chunked = b"HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\n\r\n5\r\nwhole\r\n"
        with FakeServer(chunked, chunked + b"0\r\n\r\n") as server:
            server.client().trajectories("swp_1", self.file)
        self.assertEqual(len(server.requests), 2)

    def test_says_which_format_by_the_name_of_the_file(self):
        for name, format in {"a.h5": "h5", "a.hdf5": "h5", "a.mat": "mat"}.items():
            with FakeServer(http(200, b"")) as server:
                server.client().trajectories("swp_1", os.path.join(os.path.dirname(self.file), name))
            self.assertIn(f"format={format} ", server.requests[0][0])
        with self.assertRaisesRegex(ValueError, "h5, .npz or .mat"):
            rpsup.Client().trajectories("swp_1", "a.txt")

    def test_no_other_failure_for_a_file_that_cannot_be_written(self):
        with FakeServer(http(200, b"body")) as server, self.assertRaises(FileNotFoundError):
            server.client().trajectories("swp_1", "/nowhere/a.npz")
        self.assertEqual(len(server.requests), 1)


class Relay(FakeServer):
    """Relay to a real service that swallows the answer to its first request."""

    def __init__(self, service):
        self.swallow = True

        def relay(request):
            first, headers, body = request
            with socket.create_connection(("127.0.0.1", int(service.url.rsplit(":", 1)[1]))) as connection:
                head = "".join(f"{name}: {value}\r\n" for name, value in headers.items() if name != "Host")
                connection.sendall(f"{first}\r\nHost: 127.0.0.1\r\n{head}\r\n".encode() + body)
                answer = b"".join(iter(lambda: connection.recv(65536), b""))
            swallowed, self.swallow = self.swallow, False
            return b"" if swallowed else answer

        super().__init__(relay, relay)


class SubmitsOnce(WithProgram):
    def test_though_the_answer_was_lost(self):
        before = {sweep.id for sweep in self.client.newest(rpsup.Sweep)}
        with Relay(self.client) as relay:
            client = rpsup.Client(relay.url, self.client._program.token)
            sweep = client.submit(name="once", clearance_mm=[0.1], duration_s=0.05, run_up_s=0.02)
        self.assertEqual(len(relay.requests), 2)
        after = {sweep.id for sweep in self.client.newest(rpsup.Sweep)}
        self.assertEqual(after - before, {sweep.id})


if __name__ == "__main__":
    unittest.main()
