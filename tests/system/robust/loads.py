# SPDX-License-Identifier: Apache-2.0
"""Much at once, for the tests of what the service still does beside it."""

import http.client
import selectors
import socket
import threading
from urllib.parse import urlsplit

TOKEN = "0123456789abcdef0123456789abcdef"
ASK = b"GET /v1/sweeps HTTP/1.1\r\nHost: localhost\r\n"
VALUES = b'{"x":[' + b'"",' * 2_700_000 + b'""]}'  # 8 MB, 130 MB once it is parsed


class Holders:
    """Connections without the token that are kept open once they are answered. As soon as one is cut off, another begins."""

    def __init__(self, address, count):
        self.address, self.count, self.begun, self.held = address, count, 0, []
        self.stop = threading.Event()
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def open(self, selector):
        connection = socket.create_connection(self.address, timeout=20)
        connection.sendall(ASK + b"\r\n")
        selector.register(connection, selectors.EVENT_READ)
        self.begun += 1

    def run(self):
        selector = selectors.EpollSelector()
        for _ in range(self.count):
            self.open(selector)
        while not self.stop.is_set():
            for key, _ in selector.select(0.1):
                try:
                    # The end of the service's side comes with the answer; the connection stays open until it is reset.
                    if key.fileobj.recv(65536):
                        continue
                except OSError:
                    pass
                selector.unregister(key.fileobj)
                self.held.append(key.fileobj)
            while len(self.held) > self.count // 2:
                self.held.pop(0).close()
                self.open(selector)

    def end(self):
        self.stop.set()
        self.thread.join()


def post_values(url, headers=None):
    """Status of a body that is refused for the number of its values."""
    connection = http.client.HTTPConnection(urlsplit(url).netloc, timeout=60)
    try:
        connection.request("POST", "/v1/sweeps", VALUES, {"Content-Type": "application/json", **(headers or {})})
        return connection.getresponse().status
    except OSError:  # refused while it was sent
        return 503
    finally:
        connection.close()
