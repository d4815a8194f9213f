# SPDX-License-Identifier: Apache-2.0
"""Damages what a killed service has left and starts it again: damage_loop.py PROGRAM [--rounds N] [--seed N]

The log (WAL) is cut short or has bits flipped at random places, the index (-shm) is deleted or overwritten: the service starts, the store
is sound, and what was in the main file is there. The main file is damaged: the service either refuses with exit code 3 and a sentence, and
leaves every file as it was; or it starts, answers whatever is asked, by an error if need be, and ends in order. A file of SQLite's has no
checksums: what a flipped bit makes of a number in a table cannot be seen, and how often that happened is printed.
"""

import argparse
import json
import random
import re
import shutil
import subprocess
import sys

from service import ENVIRONMENT, Service, check, check_integrity, small_sweep, store_files, temporary_folder


def make_store(program, folder):
    """A store whose process was killed: two sweeps in the main file, as a copy of it shows, and one more in its log."""
    store = folder / "store.db"
    service = Service(program, store, "--threads", "2")
    settled = [service.submit(small_sweep(n)) for n in range(2)]
    for sweep_id in settled:
        service.wait_for_end(sweep_id)
    tables = {sweep_id: service.results(sweep_id) for sweep_id in settled}
    service.terminate()  # moves the log into the file
    service = Service(program, store, "--threads", "2")
    service.wait_for_end(service.submit(small_sweep(2)))
    service.kill()
    check(store_files(store)[1].stat().st_size > 0, "the last sweep is in the log")
    return store, tables


def damage(path, dice):
    """Cuts the file short or flips some bits; says what it did."""
    content = bytearray(path.read_bytes())
    if dice.random() < 0.4:
        size = dice.randrange(len(content))
        path.write_bytes(content[:size])
        return f"cut at {size} of {len(content)}"
    places = [dice.randrange(len(content)) for _ in range(dice.choice((1, 4, 64)))]
    for place in places:
        content[place] ^= 1 << dice.randrange(8)
    path.write_bytes(content)
    return f"bits flipped at {places[:4]}"


def check_log_damage(program, store, tables, dice):
    _, log, index = store_files(store)
    what = damage(log, dice)
    if index.exists():
        index.unlink() if dice.random() < 0.5 else index.write_bytes(dice.randbytes(index.stat().st_size))
    service = Service(program, store, "--threads", "1")
    for sweep_id, table in tables.items():
        check(service.results(sweep_id) == table, f"results after the log was {what}")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code} after the log was {what}")
    check_integrity(store)


def refuses(program, store):
    """Whether the service refuses to start. If it does, it says so and changes nothing."""
    before = {path: path.read_bytes() for path in store_files(store)[:2] if path.exists()}
    run = subprocess.Popen([program, "serve", "--db", str(store), "--port", "0"], stdout=subprocess.PIPE, stderr=subprocess.PIPE, env=ENVIRONMENT)
    line = run.stdout.readline()
    if line:
        run.terminate()
    _, errors = run.communicate(timeout=20)
    if line:
        check(run.returncode == 0, f"exit code {run.returncode} of a start that was not refused: {errors}")
        return False
    check(run.returncode == 3, f"exit code {run.returncode}: {errors}")
    check(re.search(rb"rpsup: .*store", errors), f"no sentence: {errors}")
    for path, content in before.items():
        check(path.exists() and path.read_bytes() == content, f"{path.name} was changed by a start that was refused: {errors}")
    return True


def serves_as_before(program, store, tables):
    """Uses a service that has started on a damaged store. Whether the tables that it gives are what they were."""
    service = Service(program, store, "--threads", "1")
    same = True
    for sweep_id, table in tables.items():
        status, _, text = service.ask("GET", f"/v1/sweeps/{sweep_id}/results?format=csv")
        check(status in (200, 404, 500, 503), f"results: {status} {text[:300]}")
        same = same and (status != 200 or [line.partition(b",")[2] for line in text.splitlines()] == table)
        for job in json.loads(service.ask("GET", f"/v1/jobs?sweep={sweep_id}")[2]).get("items", []):
            status, _, text = service.ask("GET", f"/v1/jobs/{job['id']}/trajectory")
            check(status in (200, 404, 500, 503), f"trajectory: {status} {text[:300]}")
    status, _, text = service.ask("POST", "/v1/sweeps", small_sweep(3))
    check(status in (201, 500, 503), f"a new sweep: {status} {text[:300]}")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    return same


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=8, help="of each kind")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    dice = random.Random(options.seed)
    folder = temporary_folder()
    store, tables = make_store(options.program, folder)
    refused = unlike = 0
    for number in range(2 * options.rounds):
        copy = folder / f"{number}.db"
        for source, target in zip(store_files(store), store_files(copy)):
            shutil.copyfile(source, target)
        if number % 2 == 0:
            check_log_damage(options.program, copy, tables, dice)
            continue
        if number % 4 == 1:
            # The log alone would repair the pages that it has.
            store_files(copy)[1].unlink()
            store_files(copy)[2].unlink()
        what = damage(copy, dice)
        try:
            if refuses(options.program, copy):
                refused += 1
            else:
                unlike += not serves_as_before(options.program, copy, tables)
        except AssertionError as error:
            sys.exit(f"the main file {what}: {error}")
    check(refused > 0, "no damage to the main file was seen")
    print(f"seed {options.seed}: {options.rounds} damaged logs, nothing of the main file lost; "
          f"{options.rounds} damaged main files, {refused} refused and left as they were, {unlike} served with a table that is not what it was")


main()
