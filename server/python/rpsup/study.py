# SPDX-License-Identifier: Apache-2.0
"""What the service computes for a client: studies, which have rows of results, and single jobs."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, Dict, List, Mapping, Optional, Sequence, TypeVar

from .progress import Bar
from .table import DataFrame
from .transport import Again

if TYPE_CHECKING:
    from .client import Client

Row = Dict[str, Any]
Names = Optional[Sequence[str]]
Number = Optional[float]
Text = Optional[str]
Whole = Optional[int]
Self = TypeVar("Self", bound="Work")

POLL_S = 1.0  # of a bar, and of a service on which too many clients wait
LONG_POLL_S = 30.0  # without a bar
WAIT_PATIENCE = 6  # times that of other requests: a service that starts anew reads its store first
ENDS = ("succeeded", "failed", "cancelled")


class Resource:
    """Something that the service has, known by its id."""

    route = ""  # "/v1/sweeps"

    def __init__(self, client: Client, id: str) -> None:
        self.client = client
        self.id = id

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.id}>"

    @property
    def path(self) -> str:
        """Path of the service: "/v1/sweeps/swp_…"."""
        return f"{self.route}/{self.id}"


class Work(Resource):
    """Something that the service computes."""

    def status(self) -> Row:
        """Everything that the service says about it: `state`, `counts`, `progress`, `request`, …"""
        status: Row = self.client.get(self.path)
        return status

    def wait(self: Self, timeout_s: Number = None, progress: Optional[bool] = None) -> Self:
        """Waits until all has ended, whether or not it has succeeded, and returns the object itself.

        A service that is away or busy is asked again for six times the client's `patience_s`.

        Args:
            timeout_s: longest time to wait, [s]; without end if left out.
            progress: False draws no bar, True always one; if left out, terminals and notebooks have one.
        Raises:
            TimeoutError: it has not ended; it goes on, and can be waited for again.
            Unreachable: the service did not answer for that long.
        """
        end = None if timeout_s is None else time.monotonic() + timeout_s
        with Bar(progress) as bar:
            while True:
                # The service sends nothing while it waits: half of the timeout leaves time for its answer.
                poll_s = min(POLL_S if bar.is_drawn else LONG_POLL_S, 0.5 * self.client.timeout_s)
                patience_s = WAIT_PATIENCE * self.client.patience_s
                if end is not None:
                    left_s = max(0.0, end - time.monotonic())
                    poll_s, patience_s = min(poll_s, left_s), min(patience_s, left_s)
                asked = time.monotonic()
                headers = {"Prefer": f"wait={int(poll_s)}"} if poll_s >= 1 else {}
                status = self.client.get(self.path, headers=headers, patience_s=patience_s)
                bar.draw(status)
                if status["state"] in ENDS:
                    return self
                if end is not None and time.monotonic() >= end:
                    raise TimeoutError(f"{self.id} is {status['state']} after {timeout_s:g} s")
                if time.monotonic() - asked < 0.5 * poll_s:  # others wait, and the answer came at once
                    time.sleep(min(poll_s, POLL_S))

    def cancel(self) -> Row:
        """Cancels the jobs that have not ended. Returns the status."""
        status: Row = self.client.post(f"{self.path}/cancel", again=Again.SAFELY)
        return status

    def delete(self) -> None:
        """Deletes it with its results, except those that others share. It must have ended."""
        self.client.delete(self.path)

    def _rows(self, name: str, query: Mapping[str, Any]) -> List[Row]:
        rows: List[Row] = self.client.get(f"{self.path}/{name}", query)
        return rows

    def _table(self, name: str, query: Mapping[str, Any]) -> DataFrame:
        return self.client.table(f"{self.path}/{name}", f"{self.route}/{{id}}/{name}", query)


class Job(Work):
    """One simulation."""

    route = "/v1/jobs"

    @property
    def metrics(self) -> Row:
        """Metrics by name, each in the unit that ends its name; {} before the job has ended."""
        return self.status()["metrics"] or {}

    def trajectory(self, channels: Names = None, from_s: Number = None, to_s: Number = None,
                   points: Whole = None, frame: bool = False) -> Any:
        """Channels over time.

        Args:
            channels: names; all if left out.
            from_s, to_s: part of the time, [s].
            points: most samples. Each stretch of time keeps the least and the largest one of each channel.
            frame: gives a DataFrame with the index `t_s` and `attrs["units"]`.
        Returns:
            dict of arrays of NumPy (float64, one dimension, one length), or of lists without NumPy. `t_s`,
            [s], comes first. Each channel is in the unit that ends its name.
        """
        query = {"channels": channels, "from": from_s, "to": to_s, "points": points}
        return self._columns("trajectory", query, frame)

    def spectrum(self, channel: Text = None, window: Text = None, from_s: Number = None,
                 to_s: Number = None, frame: bool = False) -> Any:
        """Amplitude and power spectral density of a channel over `frequency_hz`, as columns.

        `window` is "hann" (the default), "flat_top" or "rectangular".
        """
        query = {"channel": channel, "window": window, "from": from_s, "to": to_s}
        return self._columns("spectrum", query, frame)

    def poincare(self, channels: Names = None, phase_rad: Number = None, from_s: Number = None,
                 to_s: Number = None, frame: bool = False, angle: Text = None) -> Any:
        """Poincaré section: channels once a turn, when the crank passes `phase_rad`, as columns.

        `angle` names another channel, in rad, in the place of the crank's.
        """
        query = {"channels": channels, "angle": angle, "phase_rad": phase_rad, "from": from_s, "to": to_s}
        return self._columns("poincare", query, frame)

    def wear(self, wear_coefficient_m2_n: Number = None, sectors: Whole = None,
             worn_clearance_mm: Number = None, from_s: Number = None,
             to_s: Number = None, joint: Text = None) -> DataFrame:
        """Wear on the bore: a row for each ring of the journal and sector of the bore.

        `joint` is one with a bore, of a described linkage; the first one if left out.
        """
        query = {"joint": joint, "wear_coefficient_m2_n": wear_coefficient_m2_n, "sectors": sectors,
                 "worn_clearance_mm": worn_clearance_mm, "from": from_s, "to": to_s}
        return self._table("wear", query)

    def _columns(self, name: str, query: Mapping[str, Any], frame: bool) -> Any:
        return self.client.columns(f"{self.path}/{name}", query, frame)


class JobSet(Work):
    """A set of jobs with a table of results."""

    def retry(self) -> Row:
        """Queues the jobs that failed or were cancelled again. Returns the status."""
        status: Row = self.client.post(f"{self.path}/retry")
        return status

    def rows(self, **query: Any) -> List[Row]:
        """Results as a list of dicts, a row each; takes what `results` takes. Needs no pandas."""
        return self._rows("results", query)

    def results(self, **query: Any) -> DataFrame:
        """Results as a DataFrame. `attrs["units"]` has the units of its columns.

        Args:
            fields: names of columns, in this order.
            order_by: names of columns; "-NAME" puts the largest first.
            limit: most rows.
            metric: of the statistics of replicates.
            NAME, NAME_gt, NAME_ge, NAME_lt, NAME_le: value of a column that rows must have, or its bound.
        """
        return self._table("results", query)


class Study(JobSet):
    """A set of jobs that grows as its results ask for more."""


class Search(Study):
    """Search for the limit of a parameter."""

    route = "/v1/searches"

    def limits(self) -> List[Row]:
        """For each combination of the axes: `verdict`, `limit`, `limit_beyond`, bands, and points tried."""
        limits: List[Row] = self.status()["limits"]
        return limits


class WearStudy(Study):
    """Wear of the bore over hours. Its results have a row for each step."""

    route = "/v1/wear-studies"


class Optimisation(Study):
    """Search for the best values of parameters. Its results have a row for each candidate."""

    route = "/v1/optimisations"

    def best(self) -> Optional[Row]:
        """Best feasible candidate; None if there is none, or several objectives."""
        best: Optional[Row] = self.status()["best"]
        return best

    def front(self) -> List[Row]:
        """Feasible candidates that no other one dominates."""
        front: List[Row] = self.status()["front"]
        return front


class Fit(Study):
    """Fit of parameters to measured signals. Its results have a row for each point."""

    route = "/v1/fits"

    def parameters(self) -> List[Row]:
        """Fitted values with their intervals of 95 %, ranges, and whether they are identified."""
        parameters: List[Row] = self.status()["parameters"]
        return parameters

    def signals(self, **query: Any) -> DataFrame:
        """Measured and predicted signals: a row for each sample."""
        return self._table("signals", query)


class Measurement(Resource):
    """Measured signals that the service keeps."""

    route = "/v1/measurements"

    def status(self) -> Row:
        """Channels, runs and their statistics."""
        status: Row = self.client.get(self.path)
        return status

    def data(self, run: Whole = None, channels: Names = None, from_s: Number = None,
             to_s: Number = None, points: Whole = None, frame: bool = False) -> Any:
        """Samples of a run, as `Job.trajectory` gives those of a job."""
        query = {"run": run, "channels": channels, "from": from_s, "to": to_s, "points": points}
        return self.client.columns(f"{self.path}/data", query, frame)

    def delete(self) -> None:
        """Deletes the measurement. No fit may name it any more."""
        self.client.delete(self.path)
