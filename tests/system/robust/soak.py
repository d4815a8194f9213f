# SPDX-License-Identifier: Apache-2.0
"""Months of use in a few minutes: soak.py PROGRAM [--jobs N] [--gets N]

Sweeps are submitted, computed, read in every form and deleted again, and what is missing is asked for. The memory of the process, its files,
its threads and the log of the store do not grow.
"""

import argparse
import os
import random
import threading

from service import Service, check, check_integrity, store_files, temporary_folder

JOBS_PER_SWEEP = 100
KEPT_SWEEPS = 5
LOG_BYTES = 64 << 20


def sweep(number):
    return {"name": f"soak {number}", "parameters": {"duration_s": 0.01, "run_up_s": 0.005, "crank_velocity_rad_s": 5 + 0.001 * (number % 1000)},
            "reuse": number % 2 == 0, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": JOBS_PER_SWEEP}}}


class Usage:
    def __init__(self, service, store):
        self.service, self.store = service, store
        self.seen = []

    def look(self):
        process = f"/proc/{self.service.process.pid}"
        with open(f"{process}/status", encoding="ascii") as file:
            fields = dict(line.split(":", 1) for line in file)
        log = store_files(self.store)[1]
        self.seen.append({"rss_mb": int(fields["VmRSS"].split()[0]) / 1024, "threads": int(fields["Threads"]),
                          "files": len(os.listdir(f"{process}/fd")), "log": log.stat().st_size if log.exists() else 0})

    def largest(self, what, part):
        return max(one[what] for one in part)

    def check_flat(self):
        """The second half of the time against its first quarter, in which everything has been used once."""
        begin, rest = self.seen[len(self.seen) // 4:len(self.seen) // 2], self.seen[len(self.seen) // 2:]
        for what, allowed in (("rss_mb", 8), ("files", 8), ("threads", 0)):
            before, after = self.largest(what, begin), self.largest(what, rest)
            check(after <= before + allowed, f"{what} grew from {before} to {after}")
            print(f"{what}: at most {before:.0f} in the second quarter, {after:.0f} in the second half")
        log = self.largest("log", self.seen)
        check(log <= LOG_BYTES, f"the log of the store grew to {log} bytes")
        print(f"the store's log: at most {log / 1e6:.0f} MB")


def read_everything(service, ids, dice, count):
    for _ in range(count):
        sweep_id = dice.choice(ids)
        path = dice.choice((f"/v1/sweeps/{sweep_id}", f"/v1/sweeps/{sweep_id}/results", f"/v1/sweeps/{sweep_id}/results?format=csv", "/v1/sweeps?limit=5",
                            "/v1/jobs?limit=20", "/metrics", "/healthz", "/v1/parameters", "/", "/v1/jobs/none", "/nothing"))
        status, _, text = service.ask("GET", path)
        check(status in (200, 404), f"{path}: {status} {text[:200]}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--jobs", type=int, default=16 * JOBS_PER_SWEEP)
    parser.add_argument("--gets", type=int, default=2000)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    store = temporary_folder() / "store.db"
    service = Service(options.program, store, "--threads", "2")
    usage = Usage(service, store)
    rounds = options.jobs // JOBS_PER_SWEEP
    kept, failures = [], []
    dice = random.Random(options.seed)

    def read(seed, ids):
        try:
            read_everything(service, ids, random.Random(seed), options.gets // rounds // 2)
        except Exception as error:
            failures.append(error)

    for number in range(rounds):
        kept.append(service.submit(sweep(number)))
        readers = [threading.Thread(target=read, args=(dice.random(), list(kept))) for _ in range(2)]
        for reader in readers:
            reader.start()
        check(service.wait_for_end(kept[-1]) == "succeeded", f"sweep {number}")
        for reader in readers:
            reader.join()
        check(not failures, str(failures[:1]))
        if len(kept) > KEPT_SWEEPS:
            status, _, _ = service.ask("DELETE", f"/v1/sweeps/{kept.pop(0)}")
            check(status == 204, f"deleting: {status}")
        usage.look()
    usage.check_flat()
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    print(f"{rounds * JOBS_PER_SWEEP} jobs, {options.gets} GETs")


main()
