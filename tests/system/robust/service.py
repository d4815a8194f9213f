# SPDX-License-Identifier: Apache-2.0
"""The program itself, driven from outside, for the tests of what must not get lost. Python's standard library only."""

import atexit
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time
import urllib.error
import urllib.request
from pathlib import Path

# Neither the caller's options nor a proxy are part of a test.
ENVIRONMENT = {k: v for k, v in os.environ.items() if not k.startswith("RPSUP_") and not k.lower().endswith("_proxy")}
OPENER = urllib.request.build_opener(urllib.request.ProxyHandler({}))
SKIPPED = 77


def skip(why):
    print(f"skipped: {why}")
    sys.exit(SKIPPED)


def check(holds, what):
    """Like assert, but also under python -O."""
    if not holds:
        raise AssertionError(what)


def temporary_folder():
    folder = Path(tempfile.mkdtemp(prefix="rpsup-test-"))
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return folder


class NoAnswer(Exception):
    """The connection ended before there was an answer, as when the service is killed."""


class Service:
    """One `rpsup serve`; ended with the test if it is still there."""

    def __init__(self, program, store, *options, wrapper=(), environment=None, preexec=None, log=None):
        self.log = Path(log or f"{store}.log")
        self.started = time.monotonic()
        with open(self.log, "ab") as log_file:
            self.process = subprocess.Popen(
                [*wrapper, program, "serve", "--db", str(store), "--port", "0", *options], stdout=subprocess.PIPE, stderr=log_file,
                env={**ENVIRONMENT, "XDG_CONFIG_HOME": f"{store}.config", **(environment or {})}, preexec_fn=preexec)
        atexit.register(self.kill)
        line = self.process.stdout.readline().decode()
        found = re.match(r"rpsup listens on (\S+)", line)
        if not found:
            self.process.wait()
            raise AssertionError("the service did not start: " + self.log.read_text(errors="replace")[-600:])
        self.url = found[1]

    def seconds_until_ready(self):
        """From the start of the process to the first good answer of /readyz."""
        check(self.get("/readyz")["status"] == "ready", "it listens but is not ready")
        return time.monotonic() - self.started

    def ask(self, method, path, body=None, headers=None, timeout=20):
        """Returns status, headers and body, whatever the status is."""
        data = None if body is None else json.dumps(body).encode()
        request = urllib.request.Request(self.url + path, data=data, method=method,
                                         headers={"Content-Type": "application/json", **(headers or {})})
        try:
            try:
                answer = OPENER.open(request, timeout=timeout)
            except urllib.error.HTTPError as refusal:
                answer = refusal
            with answer:
                return answer.status, answer.headers, answer.read()
        except (OSError, EOFError, ValueError) as error:
            raise NoAnswer(str(error)) from error
        except Exception as error:  # http.client has its own family of them
            raise NoAnswer(repr(error)) from error

    def get(self, path):
        status, _, text = self.ask("GET", path)
        check(status == 200, f"GET {path}: {status} {text[:300]}")
        return json.loads(text)

    def submit(self, sweep, headers=None):
        status, _, text = self.ask("POST", "/v1/sweeps", sweep, headers)
        check(status == 201, f"POST /v1/sweeps: {status} {text[:300]}")
        return json.loads(text)["id"]

    def wait_for_end(self, sweep_id, seconds=120):
        deadline = time.monotonic() + seconds
        while time.monotonic() < deadline:
            state = self.get(f"/v1/sweeps/{sweep_id}")["state"]
            if state not in ("queued", "running"):
                return state
            time.sleep(0.02)
        raise AssertionError(f"{sweep_id} has not ended after {seconds} s")

    def wait_until_idle(self, seconds=120):
        """Until no job is left to compute; so long without any progress is a failure."""
        left, deadline = None, 0.0
        while left != (0, 0):
            _, _, text = self.ask("GET", "/metrics")
            now = tuple(int(float(re.search(rb"^rpsup_jobs_%s (\S+)" % state, text, re.MULTILINE)[1])) for state in (b"queued", b"running"))
            if now != left:
                left, deadline = now, time.monotonic() + seconds
            check(time.monotonic() < deadline, f"jobs queued and running: {left}, for {seconds} s")
            time.sleep(0.05)

    def results(self, sweep_id):
        """The table as CSV without job_id, which is another one in every store."""
        status, _, text = self.ask("GET", f"/v1/sweeps/{sweep_id}/results?format=csv")
        check(status == 200, f"results: {status}")
        return [line.partition(b",")[2] for line in text.splitlines()]

    def is_alive(self):
        return self.process.poll() is None

    def kill(self):
        if self.is_alive():
            self.process.kill()
        self.process.wait()

    def terminate(self, seconds=10):
        """SIGTERM; returns the exit code and how long the end took."""
        started = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        return self.process.wait(timeout=seconds), time.monotonic() - started


def store_files(store):
    return [Path(f"{store}{suffix}") for suffix in ("", "-wal", "-shm")]


def copy_store(store, folder):
    """The files as they lie there. A look at the copy changes nothing of the store."""
    target = folder / "copy.db"
    for old in store_files(target):
        old.unlink(missing_ok=True)
    for source, copy in zip(store_files(store), store_files(target)):
        if source.exists() and not copy.name.endswith("-shm"):
            shutil.copyfile(source, copy)
    return target


def check_integrity(store):
    """Also that every job which has succeeded has a result, and that no result is without its job."""
    database = sqlite3.connect(store)
    try:
        check(database.execute("PRAGMA integrity_check").fetchall() == [("ok",)], "integrity_check")
        check(database.execute("PRAGMA foreign_key_check").fetchall() == [], "foreign_key_check")
        if not database.execute("SELECT 1 FROM sqlite_schema WHERE name = 'jobs'").fetchall():
            return
        for what, query in (
                ("jobs that succeeded without a result", "jobs WHERE state = 'succeeded' AND result IS NULL"),
                # The result of a failed job that was tried again stays until its sweep is deleted.
                ("results of no job", "results WHERE error_reason IS NULL AND seq NOT IN (SELECT result FROM jobs WHERE result IS NOT NULL)"),
                ("results without a trajectory", "results WHERE error_reason IS NULL AND seq NOT IN (SELECT result FROM trajectories)")):
            count = database.execute("SELECT count(*) FROM " + query).fetchone()[0]
            check(count == 0, f"{count} {what}")
    finally:
        database.close()


def small_sweep(number):
    """One of any number of different sweeps of three jobs that take some milliseconds each."""
    return {"name": f"small {number}", "parameters": {"duration_s": 0.05, "run_up_s": 0.02 + 1e-4 * (number % 97)},
            "sweep": {"clearance_mm": [0, 0.2, 0.5]}}
