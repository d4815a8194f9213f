# SPDX-License-Identifier: Apache-2.0
"""64 clients that ask for much at once: greed.py PROGRAM [--judge]

Large bodies of many small values, and sorted tables of 10,000 rows, beside a probe that asks for health. Each is answered, or told to come
again; the process grows by no more than 300 MB at its largest, and gives most of that back.
--judge    also fails if health takes longer than 100 ms at p99; not on a machine that is busy with other things
"""

import argparse
import re
import threading
import time
from collections import Counter

from loads import post_values
from service import NoAnswer, Service, check, temporary_folder

CLIENTS = 64
GROWTH_MB = 300


def memory_mb(service, key):
    with open(f"/proc/{service.process.pid}/status", encoding="ascii") as file:
        return int(re.search(key + r":\s+(\d+)", file.read())[1]) // 1024


def reset_peak(service):
    with open(f"/proc/{service.process.pid}/clear_refs", "w", encoding="ascii") as file:
        file.write("5")


def at_once(service, ask):
    """Statuses of a request of each client, and the times that health took meanwhile."""
    statuses, health = Counter(), []
    clients = [threading.Thread(target=lambda: statuses.update([ask()])) for _ in range(CLIENTS)]
    for client in clients:
        client.start()
    while any(client.is_alive() for client in clients):
        started = time.monotonic()
        check(service.get("/healthz")["status"] == "ok", "health")
        health.append(time.monotonic() - started)
        time.sleep(0.01)
    return statuses, sorted(health)


def read(service, path):
    try:
        return service.ask("GET", path, timeout=60)[0]
    except NoAnswer as error:
        return str(error)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--judge", action="store_true")
    options = parser.parse_args()
    service = Service(options.program, temporary_folder() / "store.db", "--threads", "1")
    service.get("/v1/sweeps")
    sweep = {"parameters": {"duration_s": 500}, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": 10_000}}}
    started = time.monotonic()
    sweep_id = service.submit(sweep)
    print(f"a sweep of 10,000 jobs: answered in {time.monotonic() - started:.2f} s")
    idle = memory_mb(service, "VmRSS")
    beyond = []
    rows = f"/v1/sweeps/{sweep_id}/results?order_by=-clearance_mm&format="
    for what, ask, allowed in (("bodies of 8 MB", lambda: post_values(service.url), {400, 503}),
                               ("sorted tables as JSON", lambda: read(service, rows + "json"), {200, 503}),
                               ("sorted tables as CSV", lambda: read(service, rows + "csv"), {200, 503})):
        reset_peak(service)
        statuses, health = at_once(service, ask)
        peak, after = memory_mb(service, "VmHWM") - idle, memory_mb(service, "VmRSS") - idle
        p99 = health[int(0.99 * len(health))]
        print(f"{CLIENTS} {what}: {dict(statuses)}; grown by {peak} MB at most, {after} MB afterwards; health p99 {p99 * 1e3:.1f} ms")
        check(set(statuses) <= allowed, f"{what}: {statuses}")
        check(peak <= GROWTH_MB, f"{what}: grown by {peak} MB")
        if p99 > 0.1:
            beyond.append(f"{what}: health p99 {p99:.3f} s")
    service.ask("POST", f"/v1/sweeps/{sweep_id}/cancel")
    code, _ = service.terminate(20)
    check(code == 0, f"exit code {code}")
    check(not (options.judge and beyond), "; ".join(beyond))


main()
