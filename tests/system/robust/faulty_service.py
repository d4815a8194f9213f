# SPDX-License-Identifier: Apache-2.0
"""The service behind a proxy that puts a fault into what it says: faulty_service.py FAULT PROGRAM serve OPTION...

It prints an address, and ends on SIGTERM, as the service does. FAULTS lists the faults: each takes the nth exchange, and changes it or not.
"""

import ctypes
import http.client
import json
import os
import re
import signal
import subprocess
import sys
import threading
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import urlsplit

HOP_BY_HOP = ("connection", "transfer-encoding", "content-length", "host")
PR_SET_PDEATHSIG = 1
SWEEP = r"/v1/sweeps/[a-z0-9_]+"


class Exchange:
    """A request, and then its answer."""

    def __init__(self, number, method, path, headers, body):
        self.number, self.method, self.path, self.headers, self.body = number, method, path, headers, body
        self.asked = method, path  # by the client
        self.status, self.answer_headers, self.text = 0, {}, b""

    def is_good(self, method, path):
        return self.asked[0] == method and self.status == 200 and re.fullmatch(path, self.asked[1])


def request_fault(wanted, change):
    """Of every third request of a kind."""
    def change_request(exchange):
        if re.fullmatch(wanted, f"{exchange.method} {exchange.path}") and exchange.number % 3 == 0:
            change(exchange)
    return change_request


def answer_fault(path, change):
    """Of every third good answer to a GET of a path."""
    def change_answer(exchange):
        if exchange.is_good("GET", path) and exchange.number % 3 == 0:
            change(exchange)
    return change_answer


def look_instead(exchange):
    exchange.method, exchange.path = "GET", exchange.path.removesuffix("/cancel")


def say_no_content(exchange):
    if exchange.asked[0] == "DELETE" and exchange.method == "GET" and exchange.status == 200:
        exchange.status, exchange.text = 204, b""


def forget_key(exchange):
    exchange.headers.pop("Idempotency-Key", None)


def change_json(change):
    def change_text(exchange):
        try:
            value = json.loads(exchange.text)
        except ValueError:  # CSV
            return
        exchange.text = json.dumps(change(value) or value).encode()
    return change_text


def drop_item(page):
    if not page["next_cursor"]:  # the others are known to be full
        del page["items"][1:2]


def repeat_item(page):
    if not page["next_cursor"] and len(page["items"]) < 7:  # nor larger than was asked for
        page["items"][1:1] = page["items"][:1]


def count_one_more(sweep):
    sweep["counts"]["succeeded"] += 1


def lower_peak(trajectory):
    for name, values in trajectory["columns"].items():
        if name != "t_s" and None not in values:
            values[values.index(max(values))] = min(values)


def tag_alike(exchange):
    if "ETag" in exchange.answer_headers:
        exchange.answer_headers["ETag"] = '"alike"'


def replace(pattern, text):
    def change(exchange):
        exchange.text = re.sub(pattern, text, exchange.text)
    return change


class Memory:
    """Answers with what was true when it was asked first."""

    def __init__(self):
        self.first = {}

    def __call__(self, exchange):
        exchange.answer_headers, exchange.text = self.first.setdefault(exchange.path, (exchange.answer_headers, exchange.text))


# Changes of a request, of an answer, and of the nth event of a stream.
FAULTS = {
    "none": (None, None, None),
    "a deletion is only acknowledged": (request_fault("DELETE .*", look_instead), say_no_content, None),
    "a cancelling is only acknowledged": (request_fault(r"POST .*/cancel", look_instead), None, None),
    "keys are ignored": (forget_key, None, None),
    "a page leaves out an item": (None, answer_fault(r"/v1/sweeps\?.*cursor=.*", change_json(drop_item)), None),
    "a page has an item twice": (None, answer_fault(r"/v1/sweeps\?.*cursor=.*", change_json(repeat_item)), None),
    "one ETag for all": (None, answer_fault(".*", tag_alike), None),
    "an old answer": (None, answer_fault(SWEEP, Memory()), None),
    "a count is wrong": (None, answer_fault(SWEEP, change_json(count_one_more)), None),
    "a number changes": (None, answer_fault(SWEEP + "/results", replace(rb'"steps":(?=\d)', b'"steps":1')), None),
    "an order is ignored": (None, answer_fault(r".*order_by=-.*", change_json(lambda rows: rows[::-1])), None),
    "a peak is lost": (None, answer_fault(r".*points=8", change_json(lower_peak)), None),
    "an event is lost": (None, None, lambda number, event: b"" if number == 2 else event),
    "an event comes twice": (None, None, lambda number, event: event * 2 if number == 2 else event),
}


class Proxy(BaseHTTPRequestHandler):
    protocol_version = "HTTP/1.1"
    numbers, lock = 0, threading.Lock()
    host = fault = None

    def log_message(self, *_):
        pass

    def answer(self):
        with Proxy.lock:
            Proxy.numbers += 1
            number = Proxy.numbers
        change_request, change_answer, change_event = Proxy.fault
        body = self.rfile.read(int(self.headers.get("Content-Length", 0)))
        headers = {name: value for name, value in self.headers.items() if name.lower() not in HOP_BY_HOP}
        exchange = Exchange(number, self.command, self.path, headers, body)
        if change_request:
            change_request(exchange)
        connection = http.client.HTTPConnection(Proxy.host, timeout=70)
        try:
            connection.request(exchange.method, exchange.path, body, exchange.headers)
            found = connection.getresponse()
            exchange.status = found.status
            exchange.answer_headers = {name: value for name, value in found.getheaders() if name.lower() not in HOP_BY_HOP}
            if found.getheader("Content-Type") == "text/event-stream":
                self.begin(exchange)
                self.pass_events(found, change_event or (lambda _, event: event))
                return
            exchange.text = found.read()
            if change_answer:
                change_answer(exchange)
            self.begin(exchange, [] if exchange.status in (204, 304) else [("Content-Length", str(len(exchange.text)))])
            if self.command != "HEAD":
                self.wfile.write(exchange.text)
        except OSError:
            pass
        finally:
            connection.close()
            self.close_connection = True

    do_GET = do_HEAD = do_POST = do_DELETE = answer

    def begin(self, exchange, more=()):
        self.send_response_only(exchange.status)
        for name, value in (*exchange.answer_headers.items(), *more, ("Connection", "close")):
            self.send_header(name, value)
        self.end_headers()

    def pass_events(self, found, change_event):
        number, event = 0, b""
        while line := found.readline():
            event += line
            if line == b"\n":
                if b"event: job\n" in event:
                    number += 1
                    event = change_event(number, event)
                self.wfile.write(event)
                self.wfile.flush()
                event = b""


class Server(ThreadingHTTPServer):
    request_queue_size = 256
    daemon_threads = True


def main():
    Proxy.fault = FAULTS[sys.argv[1]]
    libc = ctypes.CDLL(None)  # the service ends with this process
    process = subprocess.Popen(sys.argv[2:], stdout=subprocess.PIPE, preexec_fn=lambda: libc.prctl(PR_SET_PDEATHSIG, signal.SIGKILL))
    signal.signal(signal.SIGTERM, lambda *_: os.kill(process.pid, signal.SIGTERM))
    Proxy.host = urlsplit(process.stdout.readline().decode().split()[-1]).netloc
    server = Server(("127.0.0.1", 0), Proxy)
    threading.Thread(target=server.serve_forever, daemon=True).start()
    print(f"rpsup listens on http://127.0.0.1:{server.server_port}", flush=True)
    os._exit(process.wait())


if __name__ == "__main__":
    main()
