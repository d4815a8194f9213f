#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Server that drops one submission, has no room for the next, and takes the third. It prints its address.

  failing_server.py FILE   writes a line for each request: method, path, idempotency key
"""
import json
import sys
from http.server import BaseHTTPRequestHandler, HTTPServer


class Handler(BaseHTTPRequestHandler):
    submissions = 0

    def note(self):
        with open(sys.argv[1], "a", encoding="utf-8") as file:
            file.write(f"{self.command} {self.path} {self.headers.get('Idempotency-Key', '')}\n")

    def answer(self, status, body, *headers):
        self.send_response(status)
        for name, value in (*headers, ("Content-Length", len(body))):
            self.send_header(name, value)
        self.end_headers()
        self.wfile.write(body)

    def do_GET(self):
        self.note()
        self.answer(200, b"the archive")

    def do_POST(self):
        self.note()
        self.rfile.read(int(self.headers["Content-Length"]))
        Handler.submissions += 1
        if Handler.submissions == 2:
            self.answer(503, b"{}", ("Retry-After", "1"))
        elif Handler.submissions > 2:
            self.answer(201, json.dumps({"id": "swp_1"}).encode())

    def log_message(self, *_):
        pass


server = HTTPServer(("127.0.0.1", 0), Handler)
print(f"http://127.0.0.1:{server.server_port}", flush=True)
server.serve_forever()
