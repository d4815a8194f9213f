# SPDX-License-Identifier: Apache-2.0
"""Kills the service with SIGKILL at random moments while clients submit sweeps and studies, cancel and read, again and again, in one store.

kill_loop.py PROGRAM [--rounds N] [--seed N] [--longest SECONDS]

After every kill: the files as they were left are sound, a new start is ready within 1 s, and every sweep and study that was acknowledged is
there. At the end: each was stored once (requests that were cut off are sent again under their key), each job has one result, studies have gone
on to their ends, and tables of results, limits, cycles and points are equal to the byte to those of a service that nobody disturbed.
"""

import argparse
import csv
import io
import json
import random
import threading
import time
from collections import Counter

from service import NoAnswer, Service, check, check_integrity, copy_store, small_sweep, temporary_folder

KINDS = 12  # different requests; the same again reuses results, unless it asks not to
STUDIES = {1: "/v1/fits", 4: "/v1/searches", 7: "/v1/wear-studies", 10: "/v1/optimisations"}  # by kind; the others are sweeps


class Ledger:
    """What clients were told. Guarded by its lock."""

    def __init__(self):
        self.lock = threading.Lock()
        self.acknowledged = {}  # number of the submission -> path
        self.cut_off = set()    # numbers of submissions without an answer
        self.cancelled = set()  # paths whose cancelling was acknowledged
        self.asked_to_cancel = set()
        self.interrupted = set()  # paths of studies that were going on when the service was killed
        self.submissions = 0
        self.done = Counter()   # operation -> answers

    def count(self, operation):
        with self.lock:
            self.done[operation] += 1


def kind_path(number):
    return STUDIES.get(number % KINDS, "/v1/sweeps")


def request_of(number):
    kind, path = number % KINDS, kind_path(number)
    request = {**small_sweep(kind), "name": f"kill {number}", "reuse": number % 3 != 0}
    if path == "/v1/sweeps":
        return request
    del request["sweep"]
    request["reuse"] = number // KINDS % 2 == 1
    if path == "/v1/wear-studies":
        return {**request, "parameters": {**request["parameters"], "clearance_mm": 0.2}, "hours": 1e4, "max_cycles": 3}
    if path == "/v1/optimisations":  # the second generation with what the first has shown
        over = {"clearance_mm": {"from": 0.02, "to": 0.5}}
        return {**request, "over": over, "objectives": [{"metric": "peak_slider_acceleration_m_s2"}], "budget": 12, "starts": 1}
    if path == "/v1/fits":
        return {**request, "over": {"clearance_mm": {"from": 0.02, "to": 0.5}}, "budget": 20, "population": 5, "intervals": "linearised"}
    over = {"from": 0.02, "to": 0.5, "first": 3, "tolerance": 0.02}  # then it halves, each time with what the last job has shown
    return {**request, "over": {"clearance_mm": over}, "metric": "peak_slider_acceleration_m_s2", "bound": 100}


def stored_measurement(service):
    """Id of a measurement that every store has once."""
    times = [k / 1000 for k in range(40)]
    measurement = {"channels": [{"name": "slider_position_m"}],
                   "runs": [{"time_s": times, "values": {"slider_position_m": [0.1 + 0.2 * t * t for t in times]}}]}
    status, _, text = service.ask("POST", "/v1/measurements", measurement, {"Idempotency-Key": "kill-measurement"})
    check(status == 201, f"POST /v1/measurements: {status} {text[:300]}")
    return json.loads(text)["id"]


def submit(service, ledger, number):
    path = kind_path(number)
    request = request_of(number)
    if path == "/v1/fits":
        request["measurements"] = [{"id": stored_measurement(service), "fitted": [[0, 1]]}]
    with ledger.lock:
        ledger.cut_off.add(number)
    status, _, text = service.ask("POST", path, request, {"Idempotency-Key": f"kill-{number}"})
    check(status == 201, f"POST {path}: {status} {text[:300]}")
    with ledger.lock:
        ledger.cut_off.discard(number)
        ledger.acknowledged[number] = f"{path}/{json.loads(text)['id']}"
    ledger.count(f"submitted to {path}")


def table(service, path):
    """Rows without the ids of jobs, which are others in every store."""
    status, _, text = service.ask("GET", f"{path}/results?format=csv")
    check(status == 200, f"{path}/results: {status}")
    rows = csv.DictReader(io.StringIO(text.decode()))
    return [{name: value for name, value in row.items() if name != "job_id"} for row in rows]


def cancel(service, ledger, path):
    with ledger.lock:
        ledger.asked_to_cancel.add(path)
    status, _, _ = service.ask("POST", f"{path}/cancel")
    check(status in (200, 202, 409), f"cancelling: {status}")
    if status != 409:
        with ledger.lock:
            ledger.cancelled.add(path)
    ledger.count("cancelled" if status != 409 else "ended before it was cancelled")


def client(service, ledger, seed, stop):
    """Asks one thing after another until the service is gone."""
    dice = random.Random(seed)
    try:
        while not stop.is_set():
            with ledger.lock:
                known = list(ledger.acknowledged.values())
                ledger.submissions += 1
                number = ledger.submissions
            submit(service, ledger, number)
            if known and dice.random() < 0.2:
                cancel(service, ledger, dice.choice(known))
            if known:
                table(service, dice.choice(known))
                ledger.count("tables read")
            service.get(f"{dice.choice(('/v1/sweeps', *sorted(set(STUDIES.values()))))}?limit=20")
            ledger.count("lists read")
            time.sleep(dice.random() * 0.05)
    except NoAnswer:
        return


def all_of(service, path, state=""):
    """Sweeps or studies, each as {"id", "name"}, and sweeps with their study."""
    fields = "id,name,study_id" if path == "/v1/sweeps" else "id,name"
    items, cursor = [], ""
    while True:
        page = service.get(f"{path}?limit=1000&fields={fields}&state={state}&cursor={cursor}")
        items += page["items"]
        cursor = page["next_cursor"]
        if not cursor:
            return items


def run_round(program, store, folder, ledger, dice, longest):
    service = Service(program, store, "--threads", "2")
    ready = service.seconds_until_ready()
    for path in ("/v1/sweeps", *sorted(set(STUDIES.values()))):
        there = {f"{path}/{item['id']}" for item in all_of(service, path)}
        missing = {one for one in ledger.acknowledged.values() if one.startswith(path + "/")} - there
        check(not missing, f"acknowledged and lost: {missing}")
        if path != "/v1/sweeps":
            ledger.interrupted |= {f"{path}/{item['id']}" for item in all_of(service, path, "running")}
    for number in sorted(ledger.cut_off):
        submit(service, ledger, number)
    stop = threading.Event()
    failures = []

    def guarded(seed):
        try:
            client(service, ledger, seed, stop)
        except Exception as error:
            failures.append(error)

    clients = [threading.Thread(target=guarded, args=(dice.random(),)) for _ in range(3)]
    for thread in clients:
        thread.start()
    time.sleep(dice.uniform(0, longest))
    service.kill()
    stop.set()
    for thread in clients:
        thread.join()
    if failures:
        raise failures[0]
    check_integrity(copy_store(store, folder))
    return ready


def wait_for_end(service, path, seconds=120):
    deadline = time.monotonic() + seconds
    while (state := service.get(path)["state"]) in ("queued", "running"):
        check(time.monotonic() < deadline, f"{path} has not ended after {seconds} s")
        time.sleep(0.02)
    return state


def undisturbed_results(program, folder):
    service, ledger = Service(program, folder / "undisturbed.db", "--threads", "2"), Ledger()
    for number in range(KINDS):
        submit(service, ledger, number)
    paths = [ledger.acknowledged[number] for number in range(KINDS)]
    check(all(wait_for_end(service, path) == "succeeded" for path in paths), "the undisturbed run")
    for path in paths:
        check("/searches/" not in path or service.get(path)["limits"][0]["verdict"] == "found", f"{path} has found nothing")
    tables = [table(service, path) for path in paths]
    service.terminate()
    return tables


def check_end(service, ledger, expected):
    """How many tables were compared, by path of their kind, and how many studies had been interrupted and have succeeded."""
    for number in sorted(ledger.cut_off):
        submit(service, ledger, number)
    service.wait_until_idle()
    compared, gone_on = Counter(), 0
    for number, path in ledger.acknowledged.items():
        state = wait_for_end(service, path)
        if path in ledger.cancelled:
            check(state == "cancelled", f"{path} was cancelled and is {state}")
        elif state == "succeeded":
            check(table(service, path) == expected[number % KINDS], f"another table of {path}")
            compared[kind_path(number)] += 1
            gone_on += path in ledger.interrupted
        else:  # cancelled, and killed before it could answer so
            check(path in ledger.asked_to_cancel, f"{path} is {state}")
    for path in ("/v1/sweeps", *sorted(set(STUDIES.values()))):
        names = [item["name"] for item in all_of(service, path) if not item.get("study_id")]
        submitted = [f"kill {number}" for number in ledger.acknowledged if kind_path(number) == path]
        check(sorted(names) == sorted(submitted), f"each of {path} is to be stored once")
    owners = [item["study_id"] for item in all_of(service, "/v1/sweeps") if item["study_id"]]
    studies = [path.rpartition("/")[2] for number, path in ledger.acknowledged.items() if kind_path(number) != "/v1/sweeps"]
    check(sorted(owners) == sorted(studies), "each study is to have one sweep")
    check(compared["/v1/sweeps"] > 0 and compared.total() > compared["/v1/sweeps"], f"no sweep or no study was compared: {compared}")
    return compared, gone_on


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=6)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--longest", type=float, default=0.6)
    options = parser.parse_args()
    dice = random.Random(options.seed)
    folder = temporary_folder()
    store = folder / "killed.db"
    expected = undisturbed_results(options.program, folder)
    ledger = Ledger()
    ready = [run_round(options.program, store, folder, ledger, dice, options.longest) for _ in range(options.rounds)]
    service = Service(options.program, store, "--threads", "2")
    compared, gone_on = check_end(service, ledger, expected)
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    for operation, count in sorted(ledger.done.items()):
        print(f"{operation:<32} {count:>6}")
    print(f"{options.rounds} kills, seed {options.seed}: {len(ledger.acknowledged)} sweeps and studies acknowledged, {len(ledger.cancelled)} cancelled, "
          f"0 lost; tables equal to the undisturbed run: {dict(compared)}; {len(ledger.interrupted)} studies were going on at a kill, "
          f"{gone_on} of them have succeeded, the others were cancelled; ready after at most {max(ready):.3f} s")
    check(max(ready) <= 1.0, "a start took longer than 1 s")


main()
