# SPDX-License-Identifier: Apache-2.0
"""SIGTERM while two jobs run, a client follows events and others are in the middle of a request: drain_test.py PROGRAM"""

import http.client
import sys
import threading
import time
from pathlib import Path
from urllib.parse import urlsplit

from service import NoAnswer, Service, check, check_integrity, small_sweep, temporary_folder

LONG = {"parameters": {"duration_s": 600, "coupler": "flexible"}, "sweep": {"clearance_mm": [0.2, 0.3, 0.4, 0.5]}}


def wait_until(holds, what):
    deadline = time.monotonic() + 20
    while not holds():
        check(time.monotonic() < deadline, what)
        time.sleep(0.02)


def begin_request(service, sweep):
    """A POST of which all but the last byte has been sent; returns what sends that and reads the status."""
    connection = http.client.HTTPConnection(urlsplit(service.url).netloc, timeout=20)
    body = sweep.encode()
    connection.putrequest("POST", "/v1/sweeps")
    connection.putheader("Content-Type", "application/json")
    connection.putheader("Content-Length", str(len(body)))
    connection.endheaders(body[:-1])

    def finish():
        connection.send(body[-1:])
        answer = connection.getresponse()
        check(answer.status != 503 or answer.headers["Retry-After"], "a 503 without a time to come again")
        return answer.status
    return finish


def follow(service, sweep_id, seen):
    try:
        seen["events"] = service.ask("GET", f"/v1/sweeps/{sweep_id}/events")[2]
    except NoAnswer as error:
        seen["events"] = str(error).encode()


def main():
    folder = temporary_folder()
    store = folder / "store.db"
    service = Service(sys.argv[1], store, "--threads", "2")
    done = service.submit(small_sweep(1))
    service.wait_for_end(done)
    long = service.submit(LONG)
    wait_until(lambda: service.get(f"/v1/sweeps/{long}")["counts"]["running"] == 2, "two jobs run")
    seen = {}
    follower = threading.Thread(target=follow, args=(service, long, seen))
    follower.start()
    requests = [begin_request(service, '{"parameters": {"duration_s": 0.05}}') for _ in range(5)]
    time.sleep(0.2)

    started = time.monotonic()
    service.process.terminate()
    time.sleep(0.05)
    statuses = [finish() for finish in requests]
    code = service.process.wait(timeout=10)
    took = time.monotonic() - started
    follower.join()
    check(set(statuses) <= {201, 503}, f"open requests are answered: {statuses}")
    check(code == 0, f"exit code {code}")
    check(b"event: progress" in seen["events"], f"the events that were sent: {seen['events'][:200]}")
    wal = Path(f"{store}-wal")
    check(not wal.exists() or wal.stat().st_size == 0, "the log was not moved into the file")
    check_integrity(store)

    service = Service(sys.argv[1], store, "--threads", "1")
    row = service.get(f"/v1/sweeps/{long}")
    check(row["counts"]["queued"] + row["counts"]["running"] == 4, f"jobs that did not end: {row['counts']}")
    stored = len(service.get("/v1/sweeps")["items"])
    check(stored == 2 + statuses.count(201), f"{stored} sweeps after {statuses}")
    service.terminate()
    print(f"ended in {took:.2f} s with exit code 0; five open requests: {statuses}")


main()
