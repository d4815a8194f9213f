# SPDX-License-Identifier: Apache-2.0
"""A log that nobody reads: requests are answered, SIGTERM ends the service, and lost lines are counted: unread_log.py PROGRAM"""

import os
import re
import subprocess
import sys
import threading
import time

from service import ENVIRONMENT, OPENER, check, temporary_folder

REQUESTS = 4000  # each with a line of some 600 bytes: the pipe and the queue take half of them


def start(program, folder):
    reading, writing = os.pipe()
    process = subprocess.Popen([program, "serve", "--db", str(folder / "store.db"), "--port", "0", "--log-level", "debug"],
                               stdout=subprocess.PIPE, stderr=writing, env={**ENVIRONMENT, "XDG_CONFIG_HOME": str(folder)})
    os.close(writing)
    return process, reading, process.stdout.readline().decode().split()[-1]


def ask(url, count):
    for i in range(count):
        try:
            OPENER.open(f"{url}/{i:0500}", timeout=5).read()
        except OSError as error:
            check(getattr(error, "code", 0) == 404, f"request {i}: {error!r}")


def end(process):
    started = time.monotonic()
    process.terminate()
    code = process.wait(timeout=10)
    check(code == 0, f"exit code {code}")
    return time.monotonic() - started


def main():
    folder = temporary_folder()
    process, reading, url = start(sys.argv[1], folder)
    ask(url, REQUESTS)
    took = end(process)  # while nobody reads
    os.close(reading)

    process, reading, url = start(sys.argv[1], folder)
    ask(url, REQUESTS)
    lines = []
    reader = threading.Thread(target=lambda: lines.extend(open(reading, "rb", closefd=True)))
    reader.start()  # somebody reads again
    time.sleep(0.5)
    ask(url, 1)
    end(process)
    reader.join()
    lost = [int(count) for line in lines for count in re.findall(rb"warning (\d+) lines of the log are lost", line)]
    shown = sum(b" 404 " in line for line in lines)
    check(lost, "no line tells of those that are lost")
    check(shown + sum(lost) == REQUESTS + 1, f"{shown} lines and {lost} lost of {REQUESTS + 1}")
    print(f"{2 * REQUESTS} requests answered; {sum(lost)} lines lost and told; SIGTERM ended it in {took:.2f} s")


main()
