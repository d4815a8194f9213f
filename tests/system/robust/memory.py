# SPDX-License-Identifier: Apache-2.0
"""Memory runs out: memory.py PROGRAM [--rounds N] [--seed N]

Allocations fail at random while clients submit and read (libfiu): the service lives, refuses with 503, and everything that was acknowledged is
computed afterwards. Then the whole process gets less and less address space: it serves as before, or says at once why it cannot.
"""

import argparse
import random
import resource
import time

from clients import ask_for_a_while, check_acknowledged, request_of, undisturbed_tables
from faults import Faults, can_inject
from service import NoAnswer, Service, check, check_integrity, skip, temporary_folder

POINTS = ("libc/mm/malloc", "libc/mm/realloc", "libc/mm/calloc")
MEGABYTE = 1 << 20


def fail_at_random(program, folder, tables, dice, rounds, seconds):
    store = folder / "store.db"
    faults = Faults(folder)
    service = Service(program, store, "--threads", "2", environment=faults.environment())
    acknowledged, refused = {}, 0
    for number in range(rounds):
        point = POINTS[0] if number % 2 == 0 else POINTS[number // 2 % len(POINTS)]
        probability = dice.choice((0.00001, 0.0001, 0.001, 0.01, 0.2))
        faults.tell(service, f"enable_random name={point},probability={probability}")
        refused += ask_for_a_while(service, dice, acknowledged, seconds)
        faults.tell(service, f"disable name={point}")
    check(refused > 0 and acknowledged, f"{refused} requests were refused, {len(acknowledged)} sweeps acknowledged")
    acknowledged[service.submit(request_of(1))] = 1  # it has recovered
    retried = check_acknowledged(service, acknowledged, tables)
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    print(f"{rounds} rounds of failing allocations: {len(acknowledged)} sweeps acknowledged, 0 lost, {refused} requests refused, {retried} sweeps tried again")


def limit_memory(program, folder, tables, dice, megabytes):
    """Whether the service starts with so much address space. If it does, it loses nothing."""
    store = folder / f"{megabytes}.db"
    try:
        service = Service(program, store, "--threads", "2",
                          preexec=lambda: resource.setrlimit(resource.RLIMIT_AS, (megabytes * MEGABYTE, resource.RLIM_INFINITY)))
    except AssertionError as error:
        of_loader = ("error while loading shared libraries", "cannot allocate TLS data structures")
        check("rpsup: " in str(error) or any(said in str(error) for said in of_loader), f"with {megabytes} MiB: {error}")
        return False
    acknowledged = {}
    ask_for_a_while(service, dice, acknowledged, 0.3)
    check_large_answers(service, acknowledged)
    check(service.is_alive(), f"the service died with {megabytes} MiB")
    resource.prlimit(service.process.pid, resource.RLIMIT_AS, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))
    check_acknowledged(service, acknowledged, tables)
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)
    return True


def check_large_answers(service, acknowledged):
    """A job whose trajectory takes 200 MB fails for want of memory or succeeds; nothing else ends."""
    try:
        status, _, text = service.ask("POST", "/v1/jobs", {"duration_s": 100, "run_up_s": 0.02, "output_rate_hz": 10000, "clearance_mm": 0})
    except NoAnswer:
        return
    check(status in (201, 503, 507), f"a large job: {status} {text[:200]}")
    time.sleep(0.3)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=0.2, help="that each round lasts")
    options = parser.parse_args()
    dice = random.Random(options.seed)
    folder = temporary_folder()
    tables = undisturbed_tables(options.program, folder)
    limits = (50, 70, 80, 90, 150, 340, 400, 450, 500, 600)
    started = [limit for limit in limits if limit_memory(options.program, folder, tables, dice, limit)]
    check(started and len(started) < len(limits), f"starts with {started} of {limits} MiB")
    print(f"address space of {limits} MiB: serves with {started}, says why not with the others; nothing lost")
    if not can_inject():
        skip("fiu-utils is not installed, so no allocation could be made to fail")
    fail_at_random(options.program, folder, tables, dice, options.rounds, options.seconds)


main()
