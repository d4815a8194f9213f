# SPDX-License-Identifier: Apache-2.0
"""Clients without the token that keep their answered connections open: hold.py PROGRAM [--connections N] [--seconds N] [--judge]

Each asks, is refused, and stays; as soon as it is cut off it comes again. Beside them one with the token asks, from another address and from
theirs, and a probe asks for health. Everybody is answered, and the service ends in time.
--judge    also fails if a p99 is above 100 ms; not on a machine that is busy with other things
"""

import argparse
import os
import resource
import socket
import time
from urllib.parse import urlsplit

from loads import TOKEN, Holders
from service import Service, check, temporary_folder

def ask(address, source, path, headers=b""):
    started = time.monotonic()
    with socket.create_connection(address, timeout=20, source_address=(source, 0)) as connection:
        connection.sendall(b"GET " + path + b" HTTP/1.1\r\nHost: localhost\r\n" + headers + b"\r\n")
        answer = b""
        while part := connection.recv(65536):
            answer += part
    check(answer.startswith(b"HTTP/1.1 200 "), f"{path}: {answer[:100]}")
    return time.monotonic() - started


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("--connections", type=int, default=800)
    parser.add_argument("--seconds", type=float, default=4)
    parser.add_argument("--judge", action="store_true")
    options = parser.parse_args()
    hard = resource.getrlimit(resource.RLIMIT_NOFILE)[1]
    resource.setrlimit(resource.RLIMIT_NOFILE, (min(hard, 16384), hard))
    service = Service(options.program, temporary_folder() / "store.db", "--threads", "2", environment={"RPSUP_TOKEN": TOKEN})
    url = urlsplit(service.url)
    address = (url.hostname, url.port)
    token = b"Authorization: Bearer " + TOKEN.encode() + b"\r\n"
    holders = Holders(address, options.connections)
    asked = {"a client elsewhere": ("127.0.0.2", b"/v1/sweeps", token), "a client beside them": ("127.0.0.1", b"/v1/sweeps", token),
             "health": ("127.0.0.2", b"/healthz", b""), "readiness": ("127.0.0.2", b"/readyz", b"")}
    times = {what: [] for what in asked}
    while holders.begun < options.connections:
        time.sleep(0.01)
    end = time.monotonic() + options.seconds
    while time.monotonic() < end:
        for what, request in asked.items():
            times[what].append(ask(address, *request))
        time.sleep(0.005)
    holders.end()
    beyond = []
    for what, each in times.items():
        each.sort()
        p99 = each[int(0.99 * len(each))]
        print(f"{what}: {len(each)} answers, p50 {each[len(each) // 2] * 1e3:.1f} ms, p99 {p99 * 1e3:.1f} ms, largest {each[-1] * 1e3:.1f} ms")
        if p99 > 0.1:
            beyond.append(f"{what}: p99 {p99:.3f} s")
    print(f"beside {options.connections} connections that stay open, {holders.begun} begun in all")
    check(len(os.listdir(f"/proc/{service.process.pid}/fd")) < 4096, "too many files")
    code, _ = service.terminate()
    check(code == 0, f"exit code {code}")
    check(not (options.judge and beyond), "; ".join(beyond))


main()
