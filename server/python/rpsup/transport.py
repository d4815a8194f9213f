# SPDX-License-Identifier: Apache-2.0
"""Requests to the service, sent again where no harm can come of it."""

from __future__ import annotations

import contextlib
import enum
import http.client
import json
import os
import random
import ssl
import time
import uuid
from typing import Any, Iterator, Mapping, NamedTuple, Optional, Tuple, Union
from urllib.parse import quote, urlencode, urlsplit

from .errors import BadAnswer, Error, Unreachable, error_of
from .version import VERSION

Body = Union[bytes, Mapping[str, Any], None]
Query = Optional[Mapping[str, Any]]

SHORTEST_WAIT_S = 0.2  # before a request is sent for the second time; each further wait is twice as long
LONGEST_WAIT_S = 10.0
BLOCK_BYTES = 1 << 20  # of a download, in memory at a time


class Again(enum.Enum):
    """Whether a request may be sent again after it may have reached the service."""

    SAFELY = "reading, or a request that changes nothing when it is done twice"
    BY_KEY = "with an idempotency key, by which the service knows the request again"
    NEVER = "only if the service has not taken it: no connection, or an answer of 429 or 503"

    @property
    def refusals(self) -> Tuple[int, ...]:
        """Statuses after which it may be sent again. With 502 or 504 the service may have taken it."""
        return (429, 503) if self is Again.NEVER else (429, 502, 503, 504)


class Answer(NamedTuple):
    """Answer of the service with a status below 400. Names of headers are in lower case."""

    status: int
    headers: Mapping[str, str]
    body: bytes

    def json(self) -> Any:
        """Value of a JSON body."""
        try:
            return json.loads(self.body)
        except ValueError:
            start = self.body[:100].decode("utf-8", "replace")
            raise BadAnswer(f"the answer is not JSON; it begins with {start!r}", self.status) from None


class _Lost(Exception):
    """The connection broke. `reached`: the request may have reached the service."""

    def __init__(self, cause: Exception, reached: bool) -> None:
        super().__init__(str(cause) or type(cause).__name__)
        self.reached = reached


class Transport:
    """Connection data of a service.

    A request that finds no connection, loses it, or is answered with 429 or 503 is sent again for
    `patience_s`, after as many seconds as `Retry-After` says or else longer and longer waits. So is one that
    a proxy answers with 502 or 504, unless it must not be sent twice.
    """

    def __init__(self, url: str, token: Optional[str], timeout_s: float, patience_s: float) -> None:
        parts = urlsplit(url if "://" in url else f"http://{url}")
        if parts.scheme not in ("http", "https") or not parts.hostname:
            raise ValueError(f"the address of the service must be like http://127.0.0.1:8080, not {url!r}")
        self.url = f"{parts.scheme}://{parts.netloc}{parts.path}".rstrip("/")
        self._parts = parts
        self._token = token
        self.timeout_s = timeout_s
        self.patience_s = patience_s

    def send(self, method: str, path: str, query: Query = None, body: Body = None, *,
             headers: Optional[Mapping[str, str]] = None, content_type: str = "application/json",
             again: Again = Again.SAFELY, file: Optional[str] = None,
             timeout_s: Optional[float] = None, patience_s: Optional[float] = None) -> Answer:
        """Sends a request and returns the answer. `file` takes the body of the answer, block by block.

        Raises:
            Error: the service refused the request.
            Unreachable: there was no answer within `patience_s` after the first failure.
        """
        data = body if body is None or isinstance(body, bytes) else _json_of(body)
        sent = {"User-Agent": f"rpsup-python/{VERSION}", "Accept": "*/*", **(headers or {})}
        if data is not None:
            sent["Content-Type"] = content_type
        if self._token:
            sent["Authorization"] = f"Bearer {self._token}"
        if again is Again.BY_KEY:
            sent["Idempotency-Key"] = str(uuid.uuid4())
        target = self._parts.path.rstrip("/") + quote(path) + _query_of(query)

        first_failure: Optional[float] = None
        wait_s, is_repeated = SHORTEST_WAIT_S, False
        while True:
            refusal: Error
            try:
                answer = self._send_once(method, target, data, sent, file, timeout_s or self.timeout_s)
                if answer.status < 300:
                    return answer
                if method == "DELETE" and is_repeated and answer.status == 404:
                    return answer  # the first request has deleted it, and its answer was lost
                refusal = error_of(answer.status, http.client.responses.get(answer.status, ""), answer.body)
                being_stored = again is Again.BY_KEY and is_repeated and answer.status == 409
                if not (answer.status in again.refusals or being_stored):
                    raise refusal
                is_repeated = is_repeated or answer.status in (502, 504)
                pause_s = _seconds_of(answer.headers.get("retry-after"), wait_s)
            except _Lost as lost:
                refusal = Unreachable(f"no answer from {self.url}: {lost}")
                if lost.reached and again is Again.NEVER:
                    raise refusal from lost
                is_repeated = is_repeated or lost.reached
                pause_s = wait_s * random.uniform(0.5, 1.0)  # clients return one by one
            now = time.monotonic()
            first_failure = first_failure or now
            if now + pause_s - first_failure > (self.patience_s if patience_s is None else patience_s):
                raise refusal
            time.sleep(pause_s)
            wait_s = min(2 * wait_s, LONGEST_WAIT_S)

    def _send_once(self, method: str, target: str, data: Optional[bytes], headers: Mapping[str, str],
                   file: Optional[str], timeout_s: float) -> Answer:
        connection = self._connection(timeout_s)
        try:
            try:
                connection.connect()
            except ssl.SSLCertVerificationError as error:
                raise Unreachable(f"{self.url} has no valid certificate: {error}") from error
            except OSError as error:
                raise _Lost(error, reached=False) from error
            with _loss_of_answer():
                connection.request(method, target, data, dict(headers))
                response = connection.getresponse()
            got = {name.lower(): value for name, value in response.getheaders()}
            if not {"content-length", "transfer-encoding"} & set(got) and response.status not in (204, 304):
                raise _Lost(EOFError("the head of the answer ended early"), reached=True)
            if file is not None and response.status < 300:
                _write_blocks(response, file)
                return Answer(response.status, got, b"")
            with _loss_of_answer():
                return Answer(response.status, got, response.read())
        finally:
            connection.close()

    def _connection(self, timeout_s: float) -> http.client.HTTPConnection:
        host = self._parts.hostname or ""
        if self._parts.scheme == "https":
            context = ssl.create_default_context()
            return http.client.HTTPSConnection(host, self._parts.port or http.client.HTTPS_PORT,
                                               timeout=timeout_s, context=context)
        return http.client.HTTPConnection(host, self._parts.port or http.client.HTTP_PORT,
                                          timeout=timeout_s)


@contextlib.contextmanager
def _loss_of_answer() -> Iterator[None]:
    try:
        yield
    except (OSError, http.client.RemoteDisconnected, http.client.IncompleteRead) as error:
        raise _Lost(error, reached=True) from error
    except http.client.HTTPException as error:
        raise BadAnswer(f"the answer is not HTTP: {type(error).__name__} {error}") from error


def _write_blocks(response: http.client.HTTPResponse, file: str) -> None:
    """Writes the body of an answer. The file has its name only once it is complete."""
    part = f"{file}.part"
    try:
        with open(part, "wb") as out:
            while True:
                with _loss_of_answer():
                    block = response.read(BLOCK_BYTES)
                if not block:
                    break
                out.write(block)
        if response.length:  # http.client is silent about a body that ends early if it is read in blocks
            raise _Lost(EOFError(f"{response.length} bytes are missing"), reached=True)
        os.replace(part, file)
    finally:
        if os.path.exists(part):
            os.remove(part)


def _json_of(value: Mapping[str, Any]) -> bytes:
    return json.dumps(value, allow_nan=False, default=_plain).encode()


def _plain(value: Any) -> Any:
    """Arrays and numbers of NumPy as lists and numbers of Python."""
    if hasattr(value, "tolist"):
        return value.tolist()
    if isinstance(value, (range, set, frozenset)):
        return list(value)
    raise TypeError(f"{type(value).__name__} cannot be sent as JSON: {value!r}")


def _query_of(query: Query) -> str:
    """Lists are joined by commas, truth values are those of JSON; what is None is left out."""
    pairs = []
    for key, value in (query or {}).items():
        if hasattr(value, "tolist"):
            value = value.tolist()
        if isinstance(value, (list, tuple)):
            pairs.append((key, ",".join(map(str, value))))
        elif value is not None:
            pairs.append((key, str(value).lower() if isinstance(value, bool) else str(value)))
    return f"?{urlencode(pairs, safe=',:', quote_via=quote)}" if pairs else ""


def _seconds_of(retry_after: Optional[str], otherwise: float) -> float:
    try:
        return max(0.0, float(retry_after)) if retry_after else otherwise
    except ValueError:  # a date: the service sends none, a proxy may
        return otherwise
