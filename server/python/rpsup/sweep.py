# SPDX-License-Identifier: Apache-2.0
"""A sweep, and the analyses of its results."""

from __future__ import annotations

from typing import Any, Dict, List, Mapping, Optional, Sequence

from .study import Job, JobSet, Names, Number, Row, Text
from .table import DataFrame

SUFFIXES = {"h5": "h5", "hdf5": "h5", "npz": "npz", "mat": "mat"}
MAKING_S = 600.0  # until the first byte of a file of trajectories: the service makes it first


class Sweep(JobSet):
    """A set of jobs over lists of values."""

    route = "/v1/sweeps"

    def jobs(self, **query: Any) -> List[Job]:
        """Jobs of the rows that `rows(**query)` gives, in their order."""
        return [Job(self.client, row["job_id"]) for row in self.rows(**{**query, "fields": ["job_id"]})]

    def extend(self, sweep: Optional[Mapping[str, Any]] = None,
               cases: Optional[Sequence[Mapping[str, Any]]] = None, **axes: Any) -> Row:
        """Adds values to axes, `extend(clearance_mm=[0.1])`, and cases to cases. Returns the status."""
        request: Dict[str, Any] = {}
        if sweep or axes:
            request["sweep"] = {**(sweep or {}), **axes}
        if cases:
            request["cases"] = list(cases)
        status: Row = self.client.post(f"{self.path}/extend", request)
        return status

    def describe(self, name: Text = None, notes: Text = None,
                 tags: Optional[Sequence[str]] = None) -> Row:
        """Changes name, notes or tags; what is left out stays. Returns the status."""
        given = {"name": name, "notes": notes, "tags": None if tags is None else list(tags)}
        return self.client.patch(self.path, {key: value for key, value in given.items() if value is not None})

    def move(self, executor: str) -> Row:
        """Gives the queued jobs to the executor "local" or "slurm". Returns the status."""
        status: Row = self.client.post(f"{self.path}/move", {"executor": executor})
        return status

    def trajectories(self, path: str, format: Text = None, channels: Names = None,
                     from_s: Number = None, to_s: Number = None) -> str:
        """Writes the trajectories of all jobs into one file, block by block, and returns its path.

        Args:
            path: file; an older one is replaced once the new one is complete.
            format: "h5", "npz" or "mat"; what the name of the file ends with if left out.
            channels: names; all if left out.
            from_s, to_s: part of the time, [s].
        """
        ending = str(path).rsplit(".", 1)[-1].lower()
        if format is None and ending not in SUFFIXES:
            raise ValueError(f"{path} must end with .h5, .npz or .mat, or format= must say which")
        query = {"format": format or SUFFIXES[ending], "channels": channels, "from": from_s, "to": to_s}
        return self.client.download(f"{self.path}/trajectories", path, query, MAKING_S)

    def report(self, path: str) -> str:
        """Writes the sweep as one HTML page, and returns its path."""
        return self.client.download(f"{self.path}/report", path)

    def sensitivity(self, metric: Text = None) -> DataFrame:
        """Effects (`morris`) or Sobol's indices (`saltelli`) with intervals: a row for each parameter."""
        return self._table("sensitivity", {"metric": metric})

    def surrogate(self, metric: Text = None, x: Text = None, y: Text = None) -> Row:
        """Polynomial chaos fitted to a metric: its errors, values on a grid over x and y, and the points."""
        surrogate: Row = self.client.get(f"{self.path}/surrogate", {"metric": metric, "x": x, "y": y})
        return surrogate

    def flexibility(self, metric: Text = None) -> DataFrame:
        """Ratios of a metric with a flexible coupler to that with a rigid one, and verdicts."""
        return self._table("flexibility", {"metric": metric})

    def bifurcation(self, channel: Text = None, phase_rad: Number = None,
                    from_s: Number = None, angle: Text = None) -> DataFrame:
        """Poincaré sections of one channel for all jobs: a row for each turn of each job."""
        query = {"channel": channel, "angle": angle, "phase_rad": phase_rad, "from": from_s}
        return self._table("bifurcation", query)

    def lyapunov(self) -> DataFrame:
        """Largest Lyapunov exponent of each set of replicates, [1/s], with its interval of 95 %."""
        return self._table("lyapunov", {})

    def paper(self) -> DataFrame:
        """Statements of the paper compared with the sweep: a row for each comparison."""
        return self._table("paper", {})
