# SPDX-License-Identifier: Apache-2.0
"""The installed program, started for this process alone."""

from __future__ import annotations

import os
import secrets
import select
import shutil
import signal
import subprocess
import tempfile
import time
import weakref
from typing import Optional

from .errors import ProgramError

START_S = 60.0  # a store of many gigabytes that was not closed is read at the start
STOP_S = 60.0  # running jobs are put back into the queue
LAST_S = 0.2  # a program may close its output a moment before its end, by which its exit code is known
SAID = "rpsup listens on "
# The shell ends the program when its own input ends, which it does however this process ends.
WATCH = '"$@" </dev/null & exec >&-; read -r _; kill "$!" 2>/dev/null; wait "$!"'


class Program:
    """Running `rpsup serve` on a free port, which only who knows the token may use.

    The program ends with `stop()`, with the last reference to this object, and with this process, also if
    that is killed.
    """

    def __init__(self, db: Optional[str], threads: Optional[int], program: Optional[str]) -> None:
        found = find_program(program)
        self.token = secrets.token_hex(24)
        self._folder = tempfile.TemporaryDirectory(prefix="rpsup-")
        log_name = os.path.join(self._folder.name, "log")
        store = db or os.path.join(self._folder.name, "study.db")
        command = [found, "serve", "--port", "0", "--db", store]
        if threads is not None:
            command += ["--threads", str(threads)]
        # Neither variables nor the file of options: another port or token of theirs would be used.
        environment = {name: value for name, value in os.environ.items() if not name.startswith("RPSUP_")}
        environment.update(RPSUP_TOKEN=self.token, XDG_CONFIG_HOME=self._folder.name)
        with open(log_name, "wb") as log:
            # A session of its own: Ctrl-C ends what waits for the program, not the program.
            self._process = subprocess.Popen(
                ["/bin/sh", "-c", WATCH, "rpsup", *command], stdin=subprocess.PIPE, stdout=subprocess.PIPE,
                stderr=log, env=environment, start_new_session=True)
        self._end = weakref.finalize(self, _end, self._process, self._folder)
        try:
            self.url = _read_address(self._process, log_name)
        except BaseException:
            self._end()
            raise

    def stop(self) -> None:
        """Ends the program and waits for its end. Jobs that were running begin again at the next start."""
        self._end()


def find_program(program: Optional[str] = None) -> str:
    """Path of the program: as it is named, or on the PATH."""
    found = shutil.which(program or "rpsup")
    if found is None:
        where = f"{program} is not there, or cannot be run" if program else "no folder of PATH has rpsup"
        raise ProgramError(f"the program rpsup is not installed: {where}; its README says how to install it")
    return found


def _read_address(process: subprocess.Popen[bytes], log_name: str) -> str:
    assert process.stdin is not None and process.stdout is not None
    said, end = b"", time.monotonic() + START_S
    while b"\n" not in said:
        left_s = end - time.monotonic()
        if left_s <= 0 or not select.select([process.stdout], [], [], left_s)[0]:
            raise ProgramError(f"rpsup was not ready within {START_S:.0f} s{_end_of_log(log_name)}")
        block = os.read(process.stdout.fileno(), 4096)
        if not block:
            time.sleep(LAST_S)
            process.stdin.close()
            code = process.wait()
            raise ProgramError(f"rpsup ended at its start with exit code {code}{_end_of_log(log_name)}")
        said += block
    line = said.decode("utf-8", "replace").splitlines()[0]
    if not line.startswith(SAID):
        raise ProgramError(f"this is not the program rpsup: it said {line!r}")
    return line[len(SAID):].strip()


def _end_of_log(log_name: str) -> str:
    with open(log_name, encoding="utf-8", errors="replace") as log:
        lines = log.read().strip().splitlines()[-5:]
    return ":\n  " + "\n  ".join(lines) if lines else ""


def _end(process: subprocess.Popen[bytes], folder: tempfile.TemporaryDirectory[str]) -> None:
    assert process.stdin is not None and process.stdout is not None
    process.stdin.close()
    try:
        process.wait(STOP_S)
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)  # the shell, whose session this is, and the program
        process.wait()
    process.stdout.close()
    folder.cleanup()
