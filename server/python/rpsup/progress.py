# SPDX-License-Identifier: Apache-2.0
"""Progress of a study: a bar on a terminal and in a notebook, nothing elsewhere."""

from __future__ import annotations

import builtins
import importlib
import shutil
import sys
from typing import Any, Mapping, Optional


class Bar:
    """Bar that is drawn over itself. A context manager: the bar stays as it was drawn last."""

    def __init__(self, wanted: Optional[bool] = None) -> None:
        """`wanted`: False draws nothing, True draws everywhere, None on terminals and in notebooks."""
        self._handle: Any = None  # of the display in a notebook
        self._drawn = ""
        self._in_notebook = wanted is not False and _is_notebook()
        self._on_terminal = not self._in_notebook and (sys.stderr.isatty() if wanted is None else wanted)
        self.is_drawn = self._in_notebook or self._on_terminal

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._on_terminal and self._drawn:
            print(file=sys.stderr)

    def draw(self, status: Mapping[str, Any]) -> None:
        """Draws the bar of a status of the service, with `counts`, `progress` and `eta_s` if known."""
        text = text_of(status)
        if self._on_terminal:
            text = text[:shutil.get_terminal_size().columns - 1]
        if text == self._drawn or not self.is_drawn:
            return
        if self._on_terminal:
            print(f"\r{text.ljust(len(self._drawn))}", end="", file=sys.stderr, flush=True)
        elif self._handle is None:
            display = importlib.import_module("IPython.display").display  # there in every notebook
            self._handle = display(_Plain(text), display_id=True)
        else:
            self._handle.update(_Plain(text))
        self._drawn = text


class _Plain:
    """Object that a notebook shows as its text."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __repr__(self) -> str:
        return self._text


def text_of(status: Mapping[str, Any], width: int = 30) -> str:
    """Line for a status: "[#####-----] 4 of 8 jobs, 1 failed, 12 s left", or "running" for a job's."""
    counts = status.get("counts") or {}
    part = status.get("progress")
    if not counts and part is None:
        return str(status.get("state", ""))
    total = counts.get("total", 0)
    ended = sum(counts.get(state, 0) for state in ("succeeded", "failed", "cancelled"))
    if part is None:
        part = ended / total if total else 0.0
    full = round(width * min(max(part, 0.0), 1.0))
    text = f"[{'#' * full}{'-' * (width - full)}] {ended} of {total} jobs"
    for state in ("failed", "cancelled"):
        if counts.get(state):
            text += f", {counts[state]} {state}"
    if status.get("eta_s"):
        text += f", {status['eta_s']:.0f} s left"
    return text


def _is_notebook() -> bool:
    shell = getattr(builtins, "get_ipython", None)  # IPython puts it there
    return shell is not None and getattr(shell(), "kernel", None) is not None
