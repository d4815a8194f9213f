# SPDX-License-Identifier: Apache-2.0
"""System calls fail now and then while clients submit and read (libfiu): io_faults.py PROGRAM [--rounds N] [--seed N]

First each kind of call fails for sure, and whoever needs it is refused: the faults do reach the service. Then, in every round, one kind fails
with some probability for a while. Whatever is acknowledged meanwhile is there afterwards; the service lives, answers only as the interface
allows, and, once calls succeed again, computes everything to the same bytes as if nothing had been. At last calls fail while it starts and
ends: it refuses to start, or it does start, and the store is whole.
"""

import argparse
import random
import signal

from clients import ask_for_a_while, check_acknowledged, undisturbed_tables
from faults import Faults, can_inject
from service import NoAnswer, Service, check, check_integrity, skip, small_sweep, store_files, temporary_folder

NEW_SWEEP = ("POST", "/v1/sweeps", {**small_sweep(0), "reuse": False})
COPY = ("GET", "/v1/store")
# Requests that are refused when every call of the kind fails. Failing calls on sockets end a connection without an answer; nothing is lost.
POINTS = {
    "posix/io/rw/pwrite": NEW_SWEEP,
    "posix/io/rw/pread": COPY,
    "posix/io/sync/fdatasync": NEW_SWEEP,
    "posix/io/oc/open": COPY,
    "posix/io/net/recv": NEW_SWEEP,
    "posix/io/net/send": NEW_SWEEP,
}
AT_START = ("posix/mm/mmap", "posix/io/oc/open", "posix/io/rw/pread", "posix/io/rw/pwrite", "posix/io/sync/fdatasync")
EIO = 5


def is_refused(service, question):
    try:
        return service.ask(*question)[0] == 503
    except NoAnswer:
        return True


def check_that_faults_arrive(service, faults):
    for point, question in POINTS.items():
        faults.tell(service, f"enable name={point},failinfo={EIO}")
        check(is_refused(service, question), f"{point} fails and {question[:2]} does not notice")
        faults.tell(service, f"disable name={point}")
        check(not is_refused(service, question), f"{question[:2]} does not recover from {point}")


def start_and_end_under_faults(program, store, faults, dice, rounds):
    """Returns how often it refused to start."""
    refused = 0
    for number in range(rounds):
        fault = f"enable_random name={AT_START[number % len(AT_START)]},probability={dice.choice((0.1, 0.5, 1))},failinfo={EIO}"
        try:
            service = Service(program, store, "--threads", "1", environment=faults.environment(fault))
        except AssertionError as error:
            check("rpsup: " in str(error), f"{fault}: no sentence: {error}")
            refused += 1
            continue
        code, _ = service.terminate()
        # The thread of libfiu does not block signals: before the program waits for one, that thread may get it.
        check(code in (0, -signal.SIGTERM), f"{fault}: exit code {code}")
    return refused


def end_without_ftruncate(program, store, faults):
    """The log is moved into the file and cannot be cut: the next start reads it once more, and nothing is wrong."""
    service = Service(program, store, "--threads", "1", environment=faults.environment())
    last = service.submit(small_sweep(1))
    service.wait_for_end(last)
    faults.tell(service, f"enable name=posix/io/rw/ftruncate,failinfo={EIO}")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    log = store_files(store)[1]
    check(not log.exists() or log.stat().st_size > 0, "the log was cut although that fails")
    return last


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=2 * len(POINTS))
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=0.2, help="that each round lasts")
    options = parser.parse_args()
    if not can_inject():
        skip("fiu-utils is not installed")
    dice = random.Random(options.seed)
    folder = temporary_folder()
    tables = undisturbed_tables(options.program, folder)

    store = folder / "store.db"
    faults = Faults(folder)
    service = Service(options.program, store, "--threads", "2", environment=faults.environment())
    check_that_faults_arrive(service, faults)
    acknowledged, refused = {}, {}
    for number in range(options.rounds):
        point = list(POINTS)[number % len(POINTS)]
        probability = dice.choice((0.02, 0.2, 0.5))
        faults.tell(service, f"enable_random name={point},probability={probability},failinfo={EIO}")
        refused[point] = refused.get(point, 0) + ask_for_a_while(service, dice, acknowledged, options.seconds)
        faults.tell(service, f"disable name={point}")
    retried = check_acknowledged(service, acknowledged, tables)
    check(retried == 0, "jobs have failed")
    check(sum(refused.values()) > 0, "no call has failed")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check_integrity(store)

    starts = max(len(AT_START), options.rounds // 4)
    not_started = start_and_end_under_faults(options.program, store, faults, dice, starts)
    check(not_started > 0, "no fault kept it from starting")
    last = end_without_ftruncate(options.program, store, faults)
    service = Service(options.program, store, "--threads", "2")
    check(service.get(f"/v1/sweeps/{last}")["state"] == "succeeded", "the last sweep")
    check_acknowledged(service, acknowledged, tables)
    service.terminate()
    check_integrity(store)
    print(f"seed {options.seed}, {options.rounds} rounds: {len(acknowledged)} sweeps acknowledged, 0 lost, results equal; refused: {refused}; "
          f"{starts} starts under faults, {not_started} refused, nothing lost")


main()
