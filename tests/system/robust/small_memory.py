# SPDX-License-Identifier: Apache-2.0
"""Everything at once in 512 MB: small_memory.py PROGRAM [--seconds N] [--megabytes N] [--store FILE] [--without LOAD ...] [--judge]

The service runs in a group of processes whose memory is limited, as by MemoryMax= of its unit, without swap. For that time it has connections
that stay open, sorted tables of 10,000 rows, trajectories of 1.85 million samples, bodies of 8 MB and sweeps of 10,000 jobs, each of many
clients, while it computes; and a probe asks for health. It lives, answers each client or tells it to come again, and loses nothing.
--store    a file in which the long run is kept for other runs of this test; computing it takes some minutes
--without  a load that is left out: to find the one that is too much
--judge    also fails if health takes longer than 100 ms at p99; not on a machine that is busy with other things
"""

import argparse
import atexit
import http.client
import json
import multiprocessing
import os
import random
import re
import resource
import shutil
import socket
import subprocess
import threading
import time
from collections import Counter
from pathlib import Path
from urllib.parse import urlsplit

from loads import TOKEN, Holders, post_values
from service import NoAnswer, Service, check, check_integrity, skip, temporary_folder

MEGABYTE = 1 << 20
ACCESS = {"Authorization": f"Bearer {TOKEN}"}
LONG_RUN = {"coupler": "rigid", "run_up_s": 0.02, "output_rate_hz": 10000, "clearance_mm": 0}
ENVIRONMENT = {"RPSUP_TOKEN": TOKEN}
HOLDERS, READERS, DOWNLOADERS, SENDERS, SUBMITTERS = 4000, 16, 8, 16, 2



def groups_of(process):
    """The group of a process in each hierarchy: {"memory": path, "": path of the unified one}."""
    lines = Path(f"/proc/{process}/cgroup").read_text(encoding="ascii").splitlines()
    return {name: path for line in lines for names, path in [line.split(":", 2)[1:]] for name in names.split(",")}


def folder_of_group(process):
    """Where the kernel shows the memory of the group, and whether that is the unified hierarchy."""
    groups, root = groups_of(process), Path("/sys/fs/cgroup")
    if "memory" in groups:
        return root / "memory" / groups["memory"].lstrip("/"), False
    return root / groups.get("", "/").lstrip("/"), True


class MemoryGroup:
    """A group below this process's own, made by hand or by systemd; gone with the test."""

    def __init__(self, megabytes):
        self.folder, self.wrapper, self.preexec = None, (), None
        atexit.register(self.remove)  # after the service, which is begun later, has ended
        user = ["--user"] if os.getuid() != 0 else []
        scope = ["systemd-run", *user, "--scope", "--quiet", "-p", f"MemoryMax={megabytes}M", "-p", "MemorySwapMax=0"]
        if Path("/run/systemd/system").exists() and subprocess.run([*scope, "true"], check=False, capture_output=True).returncode == 0:
            self.wrapper = scope
            return
        own, unified = folder_of_group("self")
        try:
            self.folder = own / f"rpsup-test-{os.getpid()}"
            self.folder.mkdir()
            self.limit(unified, megabytes * MEGABYTE)
        except OSError as error:
            skip(f"no group of processes with a limit of memory can be made here: {error}")
        self.preexec = lambda: (self.folder / "cgroup.procs").write_text(str(os.getpid()), encoding="ascii")

    def limit(self, unified, size):
        if unified:
            (self.folder / "memory.max").write_text(str(size), encoding="ascii")
            (self.folder / "memory.swap.max").write_text("0", encoding="ascii")
            return
        (self.folder / "memory.limit_in_bytes").write_text(str(size), encoding="ascii")
        with_swap = self.folder / "memory.memsw.limit_in_bytes"
        if with_swap.exists():
            with_swap.write_text(str(size), encoding="ascii")

    def remove(self):
        if self.folder and self.folder.exists():
            self.folder.rmdir()


class GroupMemory:
    """What the kernel says of the group that a process is in."""

    def __init__(self, process):
        self.folder, self.unified = folder_of_group(process)

    def number(self, file, key=r"\A"):
        try:
            found = re.search(key + r"\s*(\d+)", (self.folder / file).read_text(encoding="ascii"), re.MULTILINE)
        except FileNotFoundError:  # systemd's is gone with its last process
            return 0
        return int(found[1]) if found else 0

    def limit_mb(self):
        return self.number("memory.max" if self.unified else "memory.limit_in_bytes") // MEGABYTE

    def anonymous_mb(self):
        """Without the pages of files, which the kernel takes back when it needs them."""
        return self.number("memory.stat", "^anon" if self.unified else "^total_rss") // MEGABYTE

    def times_at_limit(self):
        return self.number("memory.events", "^max") if self.unified else self.number("memory.failcnt")

    def kills(self):
        return self.number("memory.events", "^oom_kill") if self.unified else self.number("memory.oom_control", "^oom_kill")



def in_threads(count, ask, stop):
    """Repeats ask(dice), which returns a status, in so many threads."""
    statuses = Counter()

    def repeat(seed):
        dice = random.Random(seed)
        while not stop.is_set():
            try:
                status = ask(dice)
            except NoAnswer:
                status = "no answer"
            statuses.update([status])
            if status != 200:
                stop.wait(0.05)

    threads = [threading.Thread(target=repeat, args=(seed,)) for seed in range(count)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    return dict(statuses)


def hold(service, stop, _):
    address = urlsplit(service.url)
    holders = Holders((address.hostname, address.port), HOLDERS)
    stop.wait()
    holders.end()
    return {"begun": holders.begun}


def read_tables(service, stop, table):
    def ask(dice):
        order = dice.choice(("-clearance_mm", "state,clearance_mm", "job_id"))
        return service.ask("GET", f"/v1/sweeps/{table}/results?order_by={order}&format={dice.choice(('json', 'csv', 'ndjson'))}", None, ACCESS, 60)[0]
    return in_threads(READERS, ask, stop)


def download(service, stop, job):
    """Takes a trajectory as fast as it comes, or slowly, for some seconds, or leaves after the first piece."""
    address = urlsplit(service.url).netloc

    def ask(dice):
        connection = http.client.HTTPConnection(address, timeout=30)
        try:
            method = "HEAD" if dice.random() < 0.2 else "GET"
            connection.request(method, f"/v1/jobs/{job}/trajectory?format={dice.choice(('json', 'csv', 'npz'))}", headers=ACCESS)
            answer = connection.getresponse()
        except (OSError, http.client.HTTPException) as error:
            connection.close()
            raise NoAnswer(repr(error)) from error
        end, pause = time.monotonic() + dice.choice((0, 2, 15)), dice.choice((0, 0, 0.1))
        try:
            while answer.read(65536) and time.monotonic() < end and not stop.wait(pause):
                pass
        except (OSError, http.client.HTTPException):
            return "cut off"  # as whoever takes slowly is, once others wait
        finally:
            connection.close()
        return answer.status
    return in_threads(DOWNLOADERS, ask, stop)


def send_values(service, stop, _):
    return in_threads(SENDERS, lambda dice: post_values(service.url, ACCESS), stop)


def sweep_of(jobs, duration_s, crank_velocity_rad_s):
    parameters = {"duration_s": duration_s, "run_up_s": 0.01, "crank_velocity_rad_s": crank_velocity_rad_s}
    return {"name": "large", "parameters": parameters, "sweep": {"clearance_mm": {"from": 0.1, "to": 0.5, "count": jobs}}}


def submit_sweeps(service, stop, jobs):
    """Returns also what was acknowledged: id -> "cancelled" or "deleted"."""
    acknowledged, seconds = {}, []

    def ask(dice):
        started = time.monotonic()
        request = sweep_of(jobs, dice.choice((100, 0.011)), round(dice.uniform(5, 12), 6))
        if dice.random() < 0.3:  # 90 kB that every job would have
            request["parameters"]["wear_depth_um"] = [[0.001 * dice.randint(0, 999) for _ in range(4000)] for _ in range(3)]
        status, _, text = service.ask("POST", "/v1/sweeps", request, ACCESS, 60)
        if status != 201:
            return status
        seconds.append(time.monotonic() - started)
        sweep = json.loads(text)["id"]
        acknowledged[sweep] = "submitted"
        stop.wait(1)
        while (cancelled := service.ask("POST", f"/v1/sweeps/{sweep}/cancel", None, ACCESS, 60)[0]) != 200:
            check(cancelled in (503, 409), f"cancelling: {cancelled}")
            if cancelled == 409:  # it has ended
                return status
        acknowledged[sweep] = "cancelled"
        if dice.random() < 0.5 and service.ask("DELETE", f"/v1/sweeps/{sweep}", None, ACCESS, 60)[0] == 204:
            acknowledged[sweep] = "deleted"
        return status

    return {**in_threads(SUBMITTERS, ask, stop), "acknowledged": acknowledged, "slowest": max(seconds, default=0)}


LOADS = {"connections": hold, "tables": read_tables, "trajectories": download, "bodies": send_values, "sweeps": submit_sweeps}
ALLOWED = {"connections": {"begun"}, "tables": {200, 503}, "trajectories": {200, 503, "cut off"}, "bodies": {400, 503}, "sweeps": {201, 422, 429, 503}}


def run_load(name, service, stop, argument, pipe):
    os.nice(5)  # clients are on other machines
    pipe.send(LOADS[name](service, stop, argument))



def submit_and_wait(service, path, request):
    """The id, also if the store has it already."""
    status, _, text = service.ask("POST", path, request, {**ACCESS, "Idempotency-Key": path}, 60)
    check(status == 201, f"POST {path}: {status} {text[:200]}")
    resource_id = json.loads(text)["id"]
    while (state := json.loads(service.ask("GET", f"{path}/{resource_id}", None, {**ACCESS, "Prefer": "wait=10"})[2])["state"]) != "succeeded":
        check(state in ("queued", "running"), f"{path} {state}")
    return resource_id


def prepare(program, store, run_s, jobs):
    """The table and the long run, which takes more memory while it is computed than its trajectory does afterwards."""
    service = Service(program, store, "--threads", "2", "--job-memory-mb", "1100", environment=ENVIRONMENT)
    job = submit_and_wait(service, "/v1/jobs", {**LONG_RUN, "duration_s": run_s})
    table = submit_and_wait(service, "/v1/sweeps", sweep_of(jobs, 0.011, 7.5))
    service.terminate(60)
    return {"trajectories": job, "tables": table, "sweeps": jobs}


def ask_health(service):
    """Seconds until the whole answer, on a connection of an address of its own."""
    address, started = urlsplit(service.url), time.monotonic()
    with socket.create_connection((address.hostname, address.port), timeout=20, source_address=("127.0.0.2", 0)) as connection:
        connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n")
        answer = b""
        while part := connection.recv(65536):
            answer += part
    check(answer.startswith(b"HTTP/1.1 200 "), f"health: {answer[:100]}")
    return time.monotonic() - started


def probe(service, group, seconds):
    """Times that health took, and the most memory that was not of files."""
    times, most, end = [], 0, time.monotonic() + seconds
    while time.monotonic() < end and service.is_alive():
        try:
            times.append(ask_health(service))
        except OSError as error:
            time.sleep(0.5)  # until a process that is killed has ended
            check(not service.is_alive(), f"health: {error}")
        if len(times) % 10 == 0:
            most = max(most, group.anonymous_mb())
        time.sleep(0.01)
    return sorted(times), most


def start_loads(names, service, arguments):
    stop = multiprocessing.Event()
    loads = {}
    for name in names:
        reading, writing = multiprocessing.Pipe(duplex=False)
        process = multiprocessing.Process(target=run_load, args=(name, service, stop, arguments.get(name), writing), daemon=True)
        process.start()
        writing.close()
        loads[name] = (process, reading)
    return stop, loads


def end_loads(stop, loads):
    stop.set()
    said = {}
    for name, (process, reading) in loads.items():
        try:
            check(reading.poll(90), f"the clients of {name} do not end")
            said[name] = reading.recv()
        except EOFError as error:
            raise AssertionError(f"the clients of {name} died") from error
        process.join()
    return said


def check_kept(service, acknowledged, jobs):
    """Whether each sweep is as it was acknowledged. One whose end nobody asked for, or saw, is any way but gone."""
    for sweep, state in acknowledged.items():
        status, _, text = service.ask("GET", f"/v1/sweeps/{sweep}", None, ACCESS, 60)
        if state == "deleted":
            check(status == 404, f"{sweep} was deleted: {status}")
            continue
        check(status == 200, f"{sweep} was acknowledged: {status} {text[:200]}")
        sweep_now = json.loads(text)
        check(sweep_now["counts"]["total"] == jobs, f"{sweep}: {sweep_now['counts']}")
        check(state != "cancelled" or sweep_now["state"] == "cancelled", f"{sweep} was cancelled and is {sweep_now['state']}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--seconds", type=float, default=60)
    parser.add_argument("--run-s", type=float, default=185, help="of the long run, 10,000 samples each")
    parser.add_argument("--jobs", type=int, default=10_000, help="of a sweep")
    parser.add_argument("--megabytes", type=int, default=512)
    parser.add_argument("--store", type=Path)
    parser.add_argument("--without", nargs="*", choices=LOADS, default=[])
    parser.add_argument("--judge", action="store_true")
    options = parser.parse_args()
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 16384), hard))
    group = MemoryGroup(options.megabytes)
    store = temporary_folder() / "store.db"
    if options.store and options.store.exists():
        shutil.copyfile(options.store, store)
        store.chmod(0o600)
    prepared = prepare(options.program, store, options.run_s, options.jobs)
    if options.store:
        shutil.copyfile(store, options.store)
    service = Service(options.program, store, "--threads", "2", environment=ENVIRONMENT, wrapper=group.wrapper, preexec=group.preexec)
    beyond = try_all(service, options, prepared)
    check_integrity(store)
    check(not (options.judge and beyond), beyond)


def try_all(service, options, prepared):
    memory = GroupMemory(service.process.pid)
    check(memory.limit_mb() == options.megabytes, f"the group has {memory.limit_mb()} MB")
    idle = memory.anonymous_mb()

    names = [name for name in LOADS if name not in options.without]
    stop, loads = start_loads(names, service, prepared)
    times, most = probe(service, memory, options.seconds)
    alive, kills = service.is_alive(), memory.kills()
    said = end_loads(stop, loads)
    acknowledged = said.get("sweeps", {}).pop("acknowledged", {})
    slowest = said.get("sweeps", {}).pop("slowest", 0)
    check(times, "nobody was told of health")
    p99 = times[int(0.99 * len(times))]
    print(f"{options.seconds:.0f} s in {options.megabytes} MB with {', '.join(names)}: {said}")
    print(f"anonymous memory {idle} MB before, {most} MB at most, {memory.anonymous_mb()} MB afterwards; "
          f"{memory.times_at_limit()} times at the limit, {kills} kills")
    print(f"health: {len(times)} answers, p50 {times[len(times) // 2] * 1e3:.1f} ms, p99 {p99 * 1e3:.1f} ms, largest {times[-1] * 1e3:.1f} ms")
    print(f"{len(acknowledged)} sweeps of {options.jobs} jobs acknowledged ({dict(Counter(acknowledged.values()))}), after {slowest:.1f} s at most")
    check(alive and kills == 0, f"the service died: {service.log.read_text(errors='replace')[-600:]}")
    for name, statuses in said.items():
        check(set(statuses) <= ALLOWED[name], f"{name}: {statuses}")
        check(not set(statuses) <= {503}, f"{name}: nobody was answered: {statuses}")
    check_kept(service, {**acknowledged, prepared["tables"]: "submitted"}, options.jobs)
    check(json.loads(service.ask("GET", f"/v1/jobs/{prepared['trajectories']}", None, ACCESS)[2])["state"] == "succeeded", "the long run is lost")
    code, _ = service.terminate(20)
    check(code == 0, f"exit code {code}")
    return f"health p99 {p99:.3f} s" if p99 > 0.1 else ""


main()
