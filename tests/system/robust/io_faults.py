"""System calls fail now and then while clients submit and read (libfiu): io_faults.py PROGRAM [--rounds N] [--seed N]

In every round one kind of call fails with some probability for a second. Whatever is acknowledged meanwhile is there afterwards; the service
lives, answers only as the interface allows, and, once calls succeed again, computes everything to the same bytes as if nothing had been.
"""

import argparse
import random
import time

from faults import Faults, can_inject
from service import NoAnswer, Service, check, check_integrity, skip, small_sweep, temporary_folder

# Reads of the index and calls on sockets may end a connection without an answer; that loses nothing.
POINTS = ("posix/io/rw/pwrite", "posix/io/rw/pread", "posix/io/sync/fsync", "posix/io/sync/fdatasync", "posix/io/rw/ftruncate",
          "posix/io/rw/pwrite/reduce", "posix/mm/mmap", "posix/io/oc/open", "posix/io/net/recv", "posix/io/net/send")
EIO = 5
KINDS = 8


def request_of(number):
    return {**small_sweep(number % KINDS), "reuse": number % 2 == 0}


def ask_under_faults(service, dice, acknowledged, seconds):
    refused = 0
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        number = dice.randrange(1000)
        try:
            status, headers, text = service.ask("POST", "/v1/sweeps", request_of(number))
            if status == 201:
                acknowledged[headers["Location"].rpartition("/")[2]] = number
            else:
                refused += 1
                # A body that could not be received is a bad request.
                check(status in (400, 408, 503, 507) and headers["Content-Type"] == "application/problem+json", f"refused with {status} {text[:200]}")
            if acknowledged:
                service.ask("GET", f"/v1/sweeps/{dice.choice(list(acknowledged))}/results")
        except NoAnswer:
            refused += 1
        check(service.is_alive(), f"the service died: {service.log.read_text(errors='replace')[-600:]}")
    return refused


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=len(POINTS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=0.2, help="that each round lasts")
    options = parser.parse_args()
    if not can_inject():
        skip("fiu-utils is not installed")
    dice = random.Random(options.seed)
    folder = temporary_folder()
    undisturbed = Service(options.program, folder / "undisturbed.db", "--threads", "2")
    twins = [undisturbed.submit(request_of(number)) for number in range(KINDS)]
    check(all(undisturbed.wait_for_end(twin) == "succeeded" for twin in twins), "the undisturbed sweeps")
    tables = [undisturbed.results(twin) for twin in twins]
    undisturbed.terminate()

    store = folder / "store.db"
    faults = Faults(folder)
    service = Service(options.program, store, "--threads", "2", environment=faults.environment())
    acknowledged, refused = {}, {}
    for number in range(options.rounds):
        point = POINTS[number % len(POINTS)]
        probability = dice.choice((0.02, 0.2, 0.5))
        faults.tell(service, f"enable_random name={point},probability={probability},failinfo={EIO}")
        refused[point] = refused.get(point, 0) + ask_under_faults(service, dice, acknowledged, options.seconds)
        faults.tell(service, f"disable name={point}")
    for sweep_id, number in acknowledged.items():
        state = service.wait_for_end(sweep_id)
        check(state == "succeeded", f"{sweep_id} is {state}: {service.get(f'/v1/jobs?state=failed')}")
        check(service.results(sweep_id) == tables[number % KINDS], f"other results in {sweep_id}")
    check(sum(refused.values()) > 0, "no call has failed")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    print(f"seed {options.seed}, {options.rounds} rounds: {len(acknowledged)} sweeps acknowledged, 0 lost, results equal; refused: {refused}")


main()
