# SPDX-License-Identifier: Apache-2.0
"""Kills the service with SIGKILL at random moments while clients submit, cancel and read, again and again, in one store.

kill_loop.py PROGRAM [--rounds N] [--seed N] [--longest SECONDS]

After every kill: the files as they were left are sound, a new start is ready within 1 s, and every sweep that was acknowledged is there.
At the end: each was stored once (requests that were cut off are sent again under their key), each job has one result, and the results are
byte for byte those of a service that nobody disturbed.
"""

import argparse
import random
import threading
import time

from service import NoAnswer, Service, check, check_integrity, copy_store, small_sweep, temporary_folder

KINDS = 12  # different sweeps; the same again reuses results, unless it asks not to


class Ledger:
    """What clients were told. Guarded by its lock."""

    def __init__(self):
        self.lock = threading.Lock()
        self.acknowledged = {}  # number of the submission -> id
        self.cut_off = set()    # numbers of submissions without an answer
        self.cancelled = set()  # ids whose cancelling was acknowledged
        self.asked_to_cancel = set()
        self.submissions = 0
        self.answers = 0


def request_of(number):
    sweep = small_sweep(number % KINDS)
    return {**sweep, "name": f"kill {number}", "reuse": number % 3 != 0}


def submit(service, ledger, number):
    with ledger.lock:
        ledger.cut_off.add(number)
    sweep_id = service.submit(request_of(number), {"Idempotency-Key": f"kill-{number}"})
    with ledger.lock:
        ledger.cut_off.discard(number)
        ledger.acknowledged[number] = sweep_id


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
                sweep_id = dice.choice(known)
                with ledger.lock:
                    ledger.asked_to_cancel.add(sweep_id)
                status, _, _ = service.ask("POST", f"/v1/sweeps/{sweep_id}/cancel")
                check(status in (200, 202, 409), f"cancelling: {status}")
                if status != 409:
                    with ledger.lock:
                        ledger.cancelled.add(sweep_id)
            if known:
                service.results(dice.choice(known))
            service.get("/v1/sweeps?limit=20")
            with ledger.lock:
                ledger.answers += 1
            time.sleep(dice.random() * 0.05)
    except NoAnswer:
        return


def all_sweeps(service):
    sweeps, cursor = [], ""
    while True:
        page = service.get(f"/v1/sweeps?limit=1000&fields=id,name&cursor={cursor}")
        sweeps += page["items"]
        cursor = page["next_cursor"]
        if not cursor:
            return sweeps


def run_round(program, store, folder, ledger, dice, longest):
    service = Service(program, store, "--threads", "2")
    ready = service.seconds_until_ready()
    missing = set(ledger.acknowledged.values()) - {sweep["id"] for sweep in all_sweeps(service)}
    check(not missing, f"acknowledged and lost: {missing}")
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


def undisturbed_results(program, folder):
    service = Service(program, folder / "undisturbed.db", "--threads", "2")
    ids = [service.submit(request_of(number)) for number in range(KINDS)]
    check(all(service.wait_for_end(i) == "succeeded" for i in ids), "the undisturbed run")
    tables = [service.results(i) for i in ids]
    service.terminate()
    return tables


def check_end(service, ledger, expected):
    for number in sorted(ledger.cut_off):
        submit(service, ledger, number)
    service.wait_until_idle()
    compared = 0
    for number, sweep_id in ledger.acknowledged.items():
        state = service.wait_for_end(sweep_id)
        if sweep_id in ledger.cancelled:
            check(state == "cancelled", f"{sweep_id} was cancelled and is {state}")
        elif state == "succeeded":
            check(service.results(sweep_id) == expected[number % KINDS], f"other results in {sweep_id}")
            compared += 1
        else:  # cancelled, and killed before it could answer so
            check(sweep_id in ledger.asked_to_cancel, f"{sweep_id} is {state}")
    names = [sweep["name"] for sweep in all_sweeps(service)]
    check(sorted(names) == sorted(f"kill {n}" for n in ledger.acknowledged), "each sweep is to be stored once")
    check(compared > 0, "nothing was compared")
    return compared


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
    compared = check_end(service, ledger, expected)
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    print(f"{options.rounds} kills, seed {options.seed}: {len(ledger.acknowledged)} sweeps acknowledged, {len(ledger.cancelled)} cancelled, "
          f"0 lost, {compared} tables equal to the undisturbed run; ready after at most {max(ready):.3f} s")
    check(max(ready) <= 1.0, "a start took longer than 1 s")


main()
