"""Tables of numbers in text: CSV, and OpenSim's `.mot` and `.sto`.

OpenSim's are tables below a header that ends with `endheader`: a name, `nRows=`, `nColumns=` (or
SIMM's `datarows`, `datacolumns`) and `inDegrees=yes` or the sentence "Angles are in degrees."; a
row of labels, `time` first; tabs or spaces between. Lengths are metres whatever the angles are.
(OpenSim documentation, "Storage (.sto) Files" and "Motion (.mot) Files".)
"""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from math import pi
from pathlib import Path as File

import numpy as np

from somersault._core.array import Array
from somersault._core.errors import SomersaultError
from somersault._core.files import read_bytes
from somersault.motion._samples import MOST_SAMPLES

MOST_BYTES = 200_000_000
_UNITS = {"s": 1.0, "ms": 1e-3, "rad": 1.0, "deg": pi / 180, "°": pi / 180, "m": 1.0}
_UNITS |= {"cm": 1e-2, "mm": 1e-3}
_FITTING = {"time": ("s", "ms"), "hinge": ("rad", "deg", "°"), "slide": ("m", "cm", "mm")}
_LABEL = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]")
_STATE = re.compile(r"/.*?([^/]+)/value")  # OpenSim 4: /jointset/hip_r/hip_flexion_r/value


@dataclass(frozen=True)
class Table:
    """A file's columns by label, and whether it says that angles are degrees."""

    labels: list[str]
    values: Array
    degrees: bool | None = None


def table_of(file: File) -> Table:
    """What a file holds, by its ending."""
    ending = file.suffix.lower()
    if ending not in (".csv", ".tsv", ".txt", ".mot", ".sto"):
        raise SomersaultError("motions are read from .csv, .tsv, .txt, .mot and .sto files")
    lines = _lines(file)
    if ending in (".mot", ".sto"):
        return _opensim(lines)
    return Table(*_numbers(lines))


def _lines(file: File) -> list[tuple[int, str]]:
    """Lines that are not blank, with their numbers."""
    try:
        data = read_bytes(file, MOST_BYTES + 1)
    except (OSError, ValueError) as trouble:  # ValueError: a zero byte in its name
        raise SomersaultError(
            f"it cannot be read ({getattr(trouble, 'strerror', trouble)}); give a file of a motion"
        ) from None
    if len(data) > MOST_BYTES:
        raise SomersaultError(
            f"it is larger than {MOST_BYTES // 1_000_000} MB; keep the flight's rows and "
            "the joints' columns"
        )
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        text = "\0"
    if "\0" in text:
        raise SomersaultError("it is not text; export the motion as CSV or OpenSim .mot in UTF-8")
    numbered = ((k, line) for k, line in enumerate(text.split("\n"), 1))
    lines = [(k, line.strip()) for k, line in numbered if re.search(r"[^\s,;]", line)]
    if not lines:
        raise SomersaultError("it is empty; export the motion again")
    return lines


def _opensim(lines: list[tuple[int, str]]) -> Table:
    """The table below an OpenSim or SIMM header."""
    words = [line.split()[0].lower() for _, line in lines]
    if "endheader" not in words:
        raise SomersaultError("it has no line endheader, so it is no OpenSim file; see its ending")
    end = words.index("endheader")
    header = "\n".join(line for _, line in lines[:end]).lower()
    kind = re.search(r"^datatype\s*=\s*(\w+)", header, re.MULTILINE)
    if kind and kind.group(1) != "double":
        raise SomersaultError(f"it holds {kind.group(1)}, not numbers; export joint angles")
    labels, values = _numbers(lines[end + 1 :])
    for what, found in (("rows", len(values)), ("columns", len(labels))):
        told = re.search(rf"^(?:n{what}\s*=|data{what}\s)\s*(\d+)\s*$", header, re.MULTILINE)
        said = float(told.group(1)) if told else found  # which, unlike int, takes any digits
        if said != found:
            raise SomersaultError(
                f"its header says {said:.10g} {what} and there are {found}; "
                + (
                    "it was cut off, so export it again"
                    if said > found
                    else "correct its header, or export it again"
                )
            )
    told = re.search(r"^indegrees\s*=\s*(yes|no|true|false)\b", header, re.MULTILINE)
    if told:
        return Table(labels, values, told.group(1) in ("yes", "true"))
    sentence = re.search(r"angles are in (degrees|radians)", header)
    return Table(labels, values, sentence.group(1) == "degrees" if sentence else None)


def _numbers(lines: list[tuple[int, str]]) -> tuple[list[str], Array]:
    """Labels, and numbers (rows, labels), of a table whose first line holds the labels."""
    if len(lines) < 2:
        raise SomersaultError("it has no rows of numbers; export the motion again")
    if len(lines) > MOST_SAMPLES + 1:
        raise SomersaultError(f"it has over {MOST_SAMPLES} rows; keep those of the flight")
    head = lines[0][1]
    mark = next((mark for mark in "\t;," if mark in head), None)
    try:
        cells = head.split() if mark is None else next(csv.reader([head], delimiter=mark))
    except csv.Error:
        raise SomersaultError(f"line {lines[0][0]} is no row of names; put names there") from None
    labels = [cell.strip() for cell in cells]
    rows = [line for _, line in lines[1:]]
    if mark == ";":
        rows = [row.replace(",", ".") for row in rows]
    try:
        values = np.loadtxt(rows, delimiter=mark, comments=None, quotechar='"', ndmin=2)
    except (ValueError, OverflowError):
        values = np.empty((0, 0))
    if values.shape != (len(rows), len(labels)) or not np.all(np.isfinite(values)):
        raise SomersaultError(_mistake([k for k, _ in lines[1:]], rows, labels, mark))
    return labels, values


def _mistake(places: list[int], rows: list[str], labels: list[str], mark: str | None) -> str:
    """A sentence about the first cell that is no number, or row that is too long or short."""
    for place, row in zip(places, rows, strict=True):
        cells = [cell.strip().strip('"') for cell in row.split(mark)]
        if len(cells) != len(labels):
            return (
                f"line {place} has {len(cells)} cells and the row of names {len(labels)}; give "
                "each name one number a row"
            )
        for label, cell in zip(labels, cells, strict=True):
            try:
                good = bool(np.isfinite(float(cell)))
            except ValueError:
                good = False
            if not good:
                shown = repr(cell[:20]) if cell else "blank"
                return (
                    f"line {place}, column {label[:40]!r} is {shown}, which is no number; fill the "
                    "gap or leave the row out"
                )
    return "its rows are no table of numbers; export the motion again"


def split_label(label: str) -> tuple[str, str | None]:
    """A column's name and its unit, if one follows in brackets."""
    found = _LABEL.fullmatch(label)
    if found and (label.endswith("]") or found["unit"].strip() in _UNITS):
        return found["name"], found["unit"].strip()
    state = _STATE.fullmatch(label)
    return (state[1] if state else label), None


def column_name(label: str) -> str:
    """A column's name without its unit."""
    return split_label(label)[0]


def seconds(label: str) -> float:
    """What a column of times is multiplied by to be in s."""
    return unit_factor(label, split_label(label)[1], "time", None)


def unit_factor(label: str, unit: str | None, kind: str, degrees: bool | None) -> float:
    """What a column's numbers are multiplied by to be in s, rad or m."""
    if unit is None:
        return _UNITS["deg"] if kind == "hinge" and degrees else 1.0
    if unit not in _FITTING.get(kind, (unit,)) or unit not in _UNITS:
        fitting = " or ".join(_FITTING.get(kind, ("rad", "deg")))
        raise SomersaultError(f"column {label!r} has the unit {unit!r}; give {fitting}")
    return _UNITS[unit]
