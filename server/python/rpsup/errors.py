# SPDX-License-Identifier: Apache-2.0
"""Exceptions of the package. All of them are an `Error`."""

from __future__ import annotations

import json
from typing import NamedTuple, Sequence


class Fault(NamedTuple):
    """One fault of a refused request."""

    pointer: str  # JSON pointer to the place, "/parameters/restitution"; "" for the whole request
    detail: str  # what is wrong, and what is allowed


class Error(Exception):
    """Refusal of a request by the service, or any other failure of this package.

    Attributes:
        status: HTTP status; 0 if there was no answer.
        code: name of the kind of error, "Unprocessable Content"; "" if there was no answer.
        message: sentence for people. It is the first fault of a request with several.
        faults: all faults of the request, each with the place in the request.
    """

    def __init__(self, message: str, status: int = 0, code: str = "", faults: Sequence[Fault] = ()) -> None:
        self.message = message
        self.status = status
        self.code = code
        self.faults = list(faults)
        lines = [f"{status} {code}: {message}" if status else message]
        if len(self.faults) > 1:
            lines = [f"{status} {code}: {len(self.faults)} faults"]
            lines += [f"  {fault.pointer}: {fault.detail}" for fault in self.faults]
        super().__init__("\n".join(lines))


class Unreachable(Error):
    """No answer: the service is not there, or the connection broke, also when it was tried again."""


class BadAnswer(Error):
    """Answer that this package does not understand, such as that of another program at the address."""


class ProgramError(Error):
    """The program `rpsup` is not installed, or did not start."""


def error_of(status: int, reason: str, body: bytes) -> Error:
    """Error that an answer with a status of 400 or more stands for. `body` should be a problem (RFC 9457)."""
    try:
        problem = json.loads(body)
        faults = [Fault(str(fault["pointer"]), str(fault["detail"])) for fault in problem.get("errors", [])]
        return Error(str(problem["detail"]), status, str(problem["title"]), faults)
    except (ValueError, KeyError, TypeError, AttributeError):
        start = body[:200].decode("utf-8", "replace").strip()
        return BadAnswer(f"an error without an explanation{': ' if start else ''}{start}", status, reason)
