# SPDX-License-Identifier: Apache-2.0
"""Client of a service."""

from __future__ import annotations

import io
import json
import os
import zipfile
from typing import Any, Dict, List, Mapping, Optional, Type, TypeVar, Union

from .errors import BadAnswer
from .program import Program
from .study import (Fit, Job, Measurement, Names, Number, Optimisation, Resource, Row, Search, Text,
                    WearStudy, Whole, Work)
from .sweep import Sweep
from .table import DataFrame, Tables, find_numpy, frame, load_pandas
from .transport import Again, Body, Query, Transport

DEFAULT_URL = "http://127.0.0.1:8080"
REQUEST_KEYS = ("name", "cases", "design", "replicates", "priority", "executor", "keep", "reuse")
MEDIA_TYPES = {".csv": "text/csv", ".npz": "application/x-npz", ".json": "application/json"}

Request = Union[Mapping[str, Any], str, None]
AResource = TypeVar("AResource", bound=Resource)


class Client:
    """Client of a running service.

    Args:
        url: address; else that of RPSUP_URL, else http://127.0.0.1:8080.
        token: token of the service, if it has one; else that of RPSUP_TOKEN.
        timeout_s: longest time without a sign of life in an answer, [s].
        patience_s: time for which a request is sent again if there is no connection or no room for it, [s].
    """

    def __init__(self, url: Optional[str] = None, token: Optional[str] = None, *, timeout_s: float = 90.0,
                 patience_s: float = 20.0) -> None:
        self._transport = Transport(url or os.environ.get("RPSUP_URL") or DEFAULT_URL,
                                    token or os.environ.get("RPSUP_TOKEN"), timeout_s, patience_s)
        self._tables: Optional[Tables] = None

    def __repr__(self) -> str:
        return f"<{type(self).__name__} of {self.url}>"

    @property
    def url(self) -> str:
        """Address of the service."""
        return self._transport.url

    @property
    def patience_s(self) -> float:
        """Time for which a request is sent again, [s]."""
        return self._transport.patience_s

    @property
    def timeout_s(self) -> float:
        """Longest time without a sign of life in an answer, [s]."""
        return self._transport.timeout_s

    # Studies and jobs.

    def submit(self, request: Request = None, **given: Any) -> Sweep:
        """Submits a sweep.

        Args:
            request: the request as the service takes it, a dict or JSON text.
            given: other keys of a request (name, parameters, sweep, cases, design, replicates, priority,
                executor, keep, reuse), or parameters by name: a list, an array or a range {"from", "to",
                "count"} is an axis, anything else is shared by all jobs. `submit(clearance_mm=[0, 0.25],
                duration_s=2)` has two jobs of 2 s.
        Raises:
            Error: the request has faults; `faults` has all of them. Nothing is stored then.
        """
        return self._create(Sweep, _sweep_request(request, given))

    def estimate(self, request: Request = None, **given: Any) -> Row:
        """Cost of a sweep before it is submitted: jobs, new_jobs, seconds, bytes, … Arguments of `submit`."""
        answer = self._transport.send("POST", "/v1/sweeps", {"dry_run": "true"},
                                      _sweep_request(request, given))
        cost: Row = answer.json()
        return cost

    def submit_job(self, parameters: Request = None, **given: Any) -> Job:
        """Submits one job. Parameters are a dict or JSON text, or given by name, or both."""
        return self._create(Job, {**_request_of(parameters), **given})

    def search(self, request: Request = None, **keys: Any) -> Search:
        """Submits a search for the limit of a parameter: over, metric, bound, …"""
        return self._create(Search, {**_request_of(request), **keys})

    def wear(self, request: Request = None, **keys: Any) -> WearStudy:
        """Submits a wear study: hours, worn_clearance_mm, wear_coefficient_m2_n, …"""
        return self._create(WearStudy, {**_request_of(request), **keys})

    def optimise(self, request: Request = None, **keys: Any) -> Optimisation:
        """Submits an optimisation: over, objectives, bounds, …"""
        return self._create(Optimisation, {**_request_of(request), **keys})

    def fit(self, request: Request = None, **keys: Any) -> Fit:
        """Submits a fit: over, measurements, … An object of `measure` may stand for {"id": …}."""
        whole = {**_request_of(request), **keys}
        whole["measurements"] = [{"id": one.id} if isinstance(one, Measurement) else one
                                 for one in whole.get("measurements", [])]
        return self._create(Fit, whole)

    def measure(self, source: Union[str, "os.PathLike[str]", Mapping[str, Any]], name: Text = None,
                time: Text = None, channels: Optional[Mapping[str, str]] = None,
                sensors: Optional[Mapping[str, Any]] = None,
                parameters: Optional[Mapping[str, Any]] = None) -> Measurement:
        """Stores measured signals.

        Args:
            source: file that ends with .csv, .npz or .json, or a request as a dict.
            name: name for people; that of the file if left out. Of CSV and NPZ, as are the following ones.
            time: column of the time, [s].
            channels: {column: channel}, of columns without a comma in their names; all other columns under
                their own names if left out.
            sensors: {channel: {"sign": -1, "gain": 9.81, "offset": 0, "delay_s": 2e-4, "low_pass_hz": 2000}}.
            parameters: those that are known of the run.
        """
        if isinstance(source, Mapping):
            answer = self._transport.send("POST", "/v1/measurements", body=source, again=Again.BY_KEY)
            return Measurement(self, answer.json()["id"])
        path = os.fspath(source)
        ending = os.path.splitext(path)[1].lower()
        if ending not in MEDIA_TYPES:
            raise ValueError(f"the name of a measurement's file must end with .csv, .npz or .json: {path}")
        query: Dict[str, Any] = {}
        if ending != ".json":
            for column in channels or {}:
                if "," in column:
                    raise ValueError(f"a column that is chosen must have no comma in its name: {column!r}")
            pairs = [f"{column}:{channel}" for column, channel in (channels or {}).items()]
            query = {"name": name or os.path.basename(path), "time": time, "channels": pairs or None,
                     "sensors": json.dumps(sensors) if sensors else None,
                     "parameters": json.dumps(parameters) if parameters else None}
        with open(path, "rb") as file:
            body = file.read()
        answer = self._transport.send("POST", "/v1/measurements", query, body, again=Again.BY_KEY,
                                      content_type=MEDIA_TYPES[ending])
        return Measurement(self, answer.json()["id"])

    def sweep(self, id: str) -> Sweep:
        """Sweep of an earlier session, by its id. `of` does the same for every kind."""
        return Sweep(self, id)

    def job(self, id: str) -> Job:
        """Job by its id, as rows of results name it."""
        return Job(self, id)

    def of(self, kind: Type[AResource], id: str) -> AResource:
        """Study, job or measurement of an earlier session: `of(rpsup.Search, id)`."""
        return kind(self, id)

    def newest(self, kind: Type[AResource], limit: int = 50, state: Text = None) -> List[AResource]:
        """Newest of a kind, the newest first: `newest(rpsup.Sweep, 1)`. Measurements have no state."""
        page = self.get(kind.route, {"limit": limit, "state": state})
        return [kind(self, item["id"]) for item in page["items"]]

    # The same by verbs, for ids and objects.

    def trajectory(self, job: Union[Job, str], channels: Names = None, from_s: Number = None,
                   to_s: Number = None, points: Whole = None, frame: bool = False) -> Any:
        """Channels of a job over time, as `Job.trajectory` gives them."""
        return self.job(_id_of(job)).trajectory(channels, from_s, to_s, points, frame)

    def trajectories(self, sweep: Union[Sweep, str], path: str, format: Text = None,
                     channels: Names = None, from_s: Number = None,
                     to_s: Number = None) -> str:
        """Writes the trajectories of all jobs into one file, as `Sweep.trajectories` does."""
        return self.sweep(_id_of(sweep)).trajectories(path, format, channels, from_s, to_s)

    def unit(self, name: str) -> Optional[str]:
        """Unit of a parameter, metric or channel: "m/s²"; "1" of a pure number, None if none is stated."""
        return self._table_types().unit(name)

    def parameters(self) -> Row:
        """All parameters of a job: a JSON Schema for each, with `default`, `x-unit` and `description`."""
        parameters: Row = self.get("/v1/parameters")["properties"]
        return parameters

    # Requests of any kind.

    def get(self, path: str, query: Query = None, headers: Optional[Mapping[str, str]] = None,
            patience_s: Optional[float] = None) -> Any:
        """Value of the JSON that a path gives. `patience_s` is that of the client if left out."""
        return self._transport.send("GET", path, query, headers=headers, patience_s=patience_s).json()

    def post(self, path: str, body: Body = None, again: Again = Again.NEVER) -> Any:
        """Value of the JSON that a path answers to a request."""
        return self._transport.send("POST", path, body=body, again=again).json()

    def patch(self, path: str, body: Body) -> Row:
        """Changes what a path names, and returns it."""
        changed: Row = self._transport.send("PATCH", path, body=body).json()
        return changed

    def delete(self, path: str) -> None:
        """Deletes what a path names."""
        self._transport.send("DELETE", path)

    def download(self, path: str, file: Union[str, "os.PathLike[str]"], query: Query = None,
                 timeout_s: Optional[float] = None) -> str:
        """Writes what a path gives into a file, block by block, and returns the file's name.

        Args:
            timeout_s: longest time without a sign of life, [s]; that of the client if left out.
        """
        self._transport.send("GET", path, query, file=os.fspath(file), timeout_s=timeout_s)
        return os.fspath(file)

    def table(self, path: str, route: str, query: Query = None) -> DataFrame:
        """DataFrame of the rows that a path gives. `route` is the path as the OpenAPI document names it."""
        load_pandas()
        rows = self.get(path, query)
        names = list(rows[0]) if rows else self._names_of_empty(path, query)
        types = self._table_types()
        return frame(rows, names, [types.column(route, name) for name in names])

    def columns(self, path: str, query: Query, as_frame: bool) -> Any:
        """Columns that a path gives: a dict of arrays or lists, or a DataFrame indexed by the first one."""
        pandas = load_pandas() if as_frame else None
        numpy = find_numpy()
        columns: Dict[str, Any]
        if numpy is None:
            answer = self.get(path, {**(query or {}), "format": "json"})
            columns = {name: answer["columns"][name] for name in answer["channels"]}
        else:
            body = self._transport.send("GET", path, {**(query or {}), "format": "npz"}).body
            try:
                with numpy.load(io.BytesIO(body), allow_pickle=False) as arrays:
                    columns = {name: arrays[name] for name in arrays.files}
            except (ValueError, OSError, EOFError, zipfile.BadZipFile) as error:
                raise BadAnswer(f"the answer is no NPZ: {error}") from error
        if pandas is None:
            return columns
        table = pandas.DataFrame(columns)
        table = table.set_index(table.columns[0])
        units = {name: self.unit(name) for name in columns}
        table.attrs["units"] = {name: unit for name, unit in units.items() if unit}
        return table

    def _create(self, kind: Type[AResource], request: Mapping[str, Any]) -> AResource:
        answer = self._transport.send("POST", kind.route, body=request, again=Again.BY_KEY).json()
        try:
            return kind(self, answer["id"])
        except (TypeError, KeyError):
            raise BadAnswer(f"the answer names no id: {str(answer)[:100]}") from None

    def _names_of_empty(self, path: str, query: Query) -> List[str]:
        answer = self._transport.send("GET", path, {**(query or {}), "format": "csv"})
        return answer.body.decode().strip().split(",")

    def _table_types(self) -> Tables:
        if self._tables is None:
            self._tables = Tables(self.get("/v1/openapi.json"))
        return self._tables


class Service(Client):
    """Client of a program that was started for it, and ends with it. A context manager."""

    def __init__(self, program: Program) -> None:
        super().__init__(program.url, program.token)
        self._program = program

    def __enter__(self) -> Service:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """Ends the program. A named store stays, a temporary one is deleted."""
        self._program.stop()


def start(db: Optional[str] = None, threads: Optional[int] = None, program: Optional[str] = None) -> Service:
    """Starts the installed program for this process alone, on a free port of this machine.

        with rpsup.start() as client:
            table = client.submit(clearance_mm=[0, 0.25]).wait().results()

    The program ends with the `with` block, however it is left, with `close()`, or with the interpreter.

    Args:
        db: file of the store, which may exist; a temporary one if left out.
        threads: jobs that run at a time; one for each core if left out.
        program: path of the program; that on the PATH if left out.
    Raises:
        ProgramError: the program is not installed, or did not start; the text says why.
    """
    return Service(Program(db, threads, program))


def _sweep_request(request: Request, given: Mapping[str, Any]) -> Dict[str, Any]:
    """Request of a sweep with keys and parameters that are given by name."""
    whole = _request_of(request)
    shared, axes = dict(whole.get("parameters", {})), dict(whole.get("sweep", {}))
    for name, value in given.items():
        if name == "parameters":
            shared.update(value)
        elif name == "sweep":
            axes.update(value)
        elif name in REQUEST_KEYS:
            whole[name] = value
        elif _is_axis(value):
            axes[name] = value
        else:
            shared[name] = value
    whole.update({key: value for key, value in (("parameters", shared), ("sweep", axes)) if value})
    return whole


def _request_of(request: Request) -> Dict[str, Any]:
    if isinstance(request, str):
        request = json.loads(request)
    if request is not None and not isinstance(request, Mapping):
        raise TypeError(f"a request is a dict or the JSON text of one, not {type(request).__name__}")
    return dict(request or {})


def _is_axis(value: Any) -> bool:
    if isinstance(value, Mapping):
        return {"from", "to", "count"} <= set(value)
    return isinstance(value, (list, tuple, range)) or getattr(value, "ndim", 0) == 1


def _id_of(work: Union[Work, str]) -> str:
    return work if isinstance(work, str) else work.id
