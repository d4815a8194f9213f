# SPDX-License-Identifier: Apache-2.0
"""Tables with the types and units that the service's OpenAPI document gives their columns."""

from __future__ import annotations

import importlib
import re
from typing import Any, Dict, Iterable, Iterator, List, Mapping, NamedTuple, Optional, Sequence, Tuple

DataFrame = Any  # pandas.DataFrame: pandas need not be there
Schema = Mapping[str, Any]

SUPERSCRIPTS = str.maketrans({"²": "2", "³": "3", "^": "", "µ": "u", "/": "_", " ": "_", "(": "", ")": ""})


class Column(NamedTuple):
    """Type and unit of a column."""

    kind: str  # number, integer, boolean, category, string or object
    unit: Optional[str]  # "m/s²"; "1" of a pure number; None if the service states none
    values: Tuple[str, ...] = ()  # of a category, in the order of the service


class Tables:
    """Columns of the service's tables, by the OpenAPI document."""

    def __init__(self, document: Mapping[str, Any]) -> None:
        self._document = document
        self._patterns: List[Tuple[re.Pattern[str], Schema]] = []
        self._units: Dict[str, Optional[str]] = {}
        schemas = document["components"]["schemas"]
        # Metrics and channels come first: "n_m" at the end of their names is N m, of some parameters' N/m.
        first = [schemas[name] for name in ("Metrics", "Trajectory") if name in schemas]
        for schema in [*first, schemas]:
            self._collect(schema)
        self._patterns.sort(key=lambda one: -len(one[0].pattern))  # "_n_m$" before "_m$"
        self._ends: Dict[str, str] = {}
        for unit in self._units.values():
            if unit:
                self._ends.setdefault(unit.lower().translate(SUPERSCRIPTS), unit)

    def unit(self, name: str) -> Optional[str]:
        """Unit of a column, parameter, metric or channel, also of a described linkage, by its name."""
        if name not in self._units:
            name = name.rsplit(".", 1)[-1]  # linkage.bodies.rod.mass_kg
        if name in self._units:
            return self._units[name]
        for pattern, schema in self._patterns:
            if pattern.search(name):
                return str(schema["x-unit"])
        words = name.split("_")
        for begin in range(1, len(words)):
            if "_".join(words[begin:]) in self._ends:
                return self._ends["_".join(words[begin:])]
        return None

    def column(self, path: str, name: str) -> Column:
        """Column of the rows of a route, named as in the document, "/v1/sweeps/{id}/results"."""
        row = self._row(path)
        schema = row.get("properties", {}).get(name)
        if schema is None:
            schema = next((schema for pattern, schema in self._patterns if pattern.search(name)), None)
        if schema is None:
            more = row.get("additionalProperties")
            schema = more if isinstance(more, Mapping) else {}
        facets = list(self._facets(schema))
        types = {kind for facet in facets for kind in _as_list(facet.get("type", [])) if kind != "null"}
        values = tuple(v for facet in facets for v in facet.get("enum", []) if isinstance(v, str))
        unit = next((str(facet["x-unit"]) for facet in facets if "x-unit" in facet), None) or self.unit(name)
        if values:
            return Column("category", None, values)
        if types == {"string"}:
            return Column("string", None)
        if types in ({"integer"}, {"boolean"}):
            return Column(types.pop(), unit)
        return Column("number" if types and types <= {"number", "integer"} else "object", unit)

    def _row(self, path: str) -> Schema:
        try:
            answer = self._document["paths"][path]["get"]["responses"]["200"]
            rows = self._resolved(answer["content"]["application/json"]["schema"])
            return self._resolved(rows.get("items", {}))
        except KeyError:  # a service older than the package has no such table
            return {}

    def _resolved(self, schema: Schema) -> Schema:
        while "$ref" in schema:
            found: Any = self._document
            for key in schema["$ref"].lstrip("#/").split("/"):
                found = found[key.replace("~1", "/").replace("~0", "~")]
            schema = found
        return schema

    def _facets(self, schema: Schema) -> Iterator[Schema]:
        """The schema itself and its alternatives."""
        schema = self._resolved(schema)
        yield schema
        for alternative in [*schema.get("anyOf", []), *schema.get("oneOf", [])]:
            yield from self._facets(alternative)

    def _collect(self, value: Any) -> None:
        """Collects the units of all properties in a part of the document."""
        if isinstance(value, Mapping):
            for name, schema in _mapping(value.get("properties")).items():
                if isinstance(schema, Mapping) and "x-unit" in schema:
                    known = self._units.setdefault(name, schema["x-unit"])
                    if known != schema["x-unit"] and name not in self._main_names():
                        self._units[name] = None
            for text, schema in _mapping(value.get("patternProperties")).items():
                if isinstance(schema, Mapping) and "x-unit" in schema:
                    self._patterns.append((re.compile(text), schema))
            for part in value.values():
                self._collect(part)
        elif isinstance(value, list):
            for part in value:
                self._collect(part)

    def _main_names(self) -> Iterable[str]:
        """Names of parameters, whose units are those at the top."""
        names: Mapping[str, Any] = self._document["components"]["schemas"]["Parameters"].get("properties", {})
        return names


def _mapping(value: Any) -> Mapping[str, Any]:
    return value if isinstance(value, Mapping) else {}


def _as_list(value: Any) -> List[str]:
    return value if isinstance(value, list) else [value]


def frame(rows: Sequence[Mapping[str, Any]], names: Sequence[str], columns: Sequence[Column]) -> DataFrame:
    """DataFrame of rows, a row each, with `attrs["units"]`: a dict of the units that columns have.

    Numbers are float64 (NaN where there is none); integers int64 or, with gaps, Int64; truth values bool or
    boolean; texts of a fixed choice are categories; other texts are str, or None.
    """
    pandas = load_pandas()
    data = {}
    for name, column in zip(names, columns):
        values = [row.get(name) for row in rows]
        has_gaps = any(value is None for value in values)
        if column.kind == "number":
            data[name] = pandas.Series(values, dtype="float64")
        elif column.kind == "integer":
            data[name] = pandas.Series(values, dtype="Int64" if has_gaps else "int64")
        elif column.kind == "boolean":
            data[name] = pandas.Series(values, dtype="boolean" if has_gaps else "bool")
        elif column.kind == "category":
            # Those that occur: others would be empty groups of each groupby.
            present = [value for value in dict.fromkeys(column.values) if value in set(values)]
            data[name] = pandas.Series(pandas.Categorical(values, categories=present))
        else:
            data[name] = pandas.Series(values, dtype="object")
    table = pandas.DataFrame(data, columns=list(names))
    table.attrs["units"] = {name: column.unit for name, column in zip(names, columns) if column.unit}
    return table


def load_pandas() -> Any:
    """The module pandas.

    Raises:
        ImportError: it is not installed; the text says what works without.
    """
    try:
        return importlib.import_module("pandas")
    except ImportError as error:
        raise ImportError("a DataFrame needs pandas (Debian: apt install python3-pandas); "
                          "rows() and trajectory() work without") from error


def find_numpy() -> Any:
    """The module numpy, or None if it is not installed."""
    try:
        return importlib.import_module("numpy")
    except ImportError:
        return None
