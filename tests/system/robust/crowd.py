# SPDX-License-Identifier: Apache-2.0
"""Many clients that do little beside one that wants answers: crowd.py PROGRAM [--seconds N] [--judge]

Slow heads, slow bodies and slow readers, each on more connections than there are threads, at a byte a second; then a thousand connections
that say nothing, beside 300 requests at once. Everybody who asks properly is answered, and the number of files stays what it was.
--judge    also fails if a figure is beyond its bound; not on a machine that is busy with other things
"""

import argparse
import os
import selectors
import socket
import threading
import time
from urllib.parse import urlsplit

from service import Service, check, small_sweep, temporary_folder

SLOW_CLIENTS = 40  # the service has 32 threads
IDLE_CLIENTS = 1000
AT_ONCE = 300
ASK = b"GET /v1/sweeps HTTP/1.1\r\nHost: localhost\r\n\r\n"


def connect(service):
    address = urlsplit(service.url)
    connection = socket.create_connection((address.hostname, address.port), timeout=20)
    return connection


class SlowClients:
    """Keeps so many connections open, each of which begins anew when the service has had enough of it."""

    def __init__(self, service, begin, go_on):
        self.service, self.begin, self.go_on = service, begin, go_on
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.begun = threading.Event()
        self.thread.start()
        self.begun.wait()

    def open(self):
        connection = connect(self.service)
        self.begin(connection)
        return connection

    def run(self):
        connections = [self.open() for _ in range(SLOW_CLIENTS)]
        self.begun.set()
        while not self.stop.wait(1):
            for number, connection in enumerate(connections):
                try:
                    self.go_on(connection)
                except OSError:
                    connection.close()
                    connections[number] = self.open()
        for connection in connections:
            connection.close()

    def end(self):
        self.stop.set()
        self.thread.join()


def send_a_byte(connection):
    connection.send(b"a")


def take_a_byte(connection):
    if not connection.recv(1):
        raise OSError("closed")


def slow_head(connection):
    connection.send(b"GET / HTTP/1.1\r\nX: ")


def slow_body(connection):
    connection.send(b"POST /v1/sweeps HTTP/1.1\r\nHost: localhost\r\nContent-Length: 1000\r\n\r\n{")


def slow_reader(path):
    def begin(connection):
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 2048)
        connection.send(f"GET {path} HTTP/1.1\r\nHost: localhost\r\n\r\n".encode())
    return begin


def percentile(times, share):
    return sorted(times)[min(len(times) - 1, int(share * len(times)))]


def times_of_healthy_client(service, seconds):
    times, end = [], time.monotonic() + seconds
    while time.monotonic() < end:
        started = time.monotonic()
        service.get("/v1/sweeps")
        times.append(time.monotonic() - started)
        time.sleep(0.01)
    return times


def times_of_requests_at_once(service):
    """Sends them all, then takes the answers as they come; each is timed from its own sending."""
    waiting = selectors.DefaultSelector()
    answers, sent, times = {}, {}, []
    for _ in range(AT_ONCE):
        connection = connect(service)
        waiting.register(connection, selectors.EVENT_READ)
        answers[connection] = b""
    for connection in answers:
        sent[connection] = time.monotonic()
        connection.send(ASK)
    while waiting.get_map():
        for key, _ in waiting.select(20):
            part = key.fileobj.recv(65536)
            answers[key.fileobj] += part
            if not part:
                times.append(time.monotonic() - sent[key.fileobj])
                waiting.unregister(key.fileobj)
                key.fileobj.close()
    check(all(answer.startswith(b"HTTP/1.1 200 ") and answer.endswith(b"}\n") for answer in answers.values()), "an answer is not whole")
    return times


def files_of(service):
    return len(os.listdir(f"/proc/{service.process.pid}/fd"))


def wait_for_files(service, most):
    deadline = time.monotonic() + 30
    while files_of(service) > most:
        check(time.monotonic() < deadline, f"{files_of(service)} files are open instead of {most}")
        time.sleep(0.1)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=3, help="of each kind of slow clients")
    parser.add_argument("--judge", action="store_true")
    options = parser.parse_args()
    service = Service(options.program, temporary_folder() / "store.db", "--threads", "2")
    sweep_id = service.submit({**small_sweep(1), "parameters": {"duration_s": 1, "run_up_s": 0.02, "output_rate_hz": 2000}, "sweep": {"clearance_mm": [0]}})
    service.wait_for_end(sweep_id)
    large = f"/v1/jobs/{service.get(f'/v1/sweeps/{sweep_id}/results')[0]['job_id']}/trajectory"
    beyond = []

    def tell(what, times, bound):
        worst = percentile(times, 0.99)
        print(f"{what}: {len(times)} answers, p50 {percentile(times, 0.5) * 1e3:.1f} ms, p99 {worst * 1e3:.1f} ms, largest {max(times) * 1e3:.1f} ms")
        if worst > bound:
            beyond.append(f"{what}: p99 is above {bound} s")

    for what, begin, go_on in (("heads", slow_head, send_a_byte), ("bodies", slow_body, send_a_byte), ("readers", slow_reader(large), take_a_byte)):
        clients = SlowClients(service, begin, go_on)
        tell(f"beside {SLOW_CLIENTS} slow {what}", times_of_healthy_client(service, options.seconds), 3)
        clients.end()
    idle = [connect(service) for _ in range(IDLE_CLIENTS)]
    rounds = [times_of_requests_at_once(service) for _ in range(5)]
    tell(f"{AT_ONCE} at once beside {IDLE_CLIENTS} idle connections, the best of {len(rounds)} rounds", min(rounds, key=lambda times: percentile(times, 0.99)), 0.1)
    for connection in idle:
        connection.close()
    wait_for_files(service, 64)  # those of the store, and none of a former client
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check(not (options.judge and beyond), "; ".join(beyond))


main()
