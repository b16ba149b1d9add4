"""Motions from files: CSV, and OpenSim's `.mot` and `.sto`.

OpenSim's are tables below a header that ends with `endheader`: a name, `nRows=`, `nColumns=` (or
SIMM's `datarows`, `datacolumns`) and `inDegrees=yes` or the sentence "Angles are in degrees."; a
row of labels, `time` first; tabs or spaces between. Lengths are metres whatever the angles are.
(OpenSim documentation, "Storage (.sto) Files" and "Motion (.mot) Files".)
"""

from __future__ import annotations

import csv
import os
import re
from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from pathlib import Path as File
from typing import Any

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import truth
from somersault._core.errors import SomersaultError
from somersault.model import Model, load
from somersault.motion._motion import Motion, nameable, spread
from somersault.motion._samples import MOST_SAMPLES, sampled_motion

MOST_BYTES = 200_000_000
_UNITS = {"s": 1.0, "ms": 1e-3, "rad": 1.0, "deg": pi / 180, "°": pi / 180, "m": 1.0}
_UNITS |= {"cm": 1e-2, "mm": 1e-3}
_FITTING = {"time": ("s", "ms"), "hinge": ("rad", "deg", "°"), "slide": ("m", "cm", "mm")}
_LABEL = re.compile(r"(?P<name>.*?)\s*[\[(](?P<unit>[^\[\]()]*)[\])]")
_STATE = re.compile(r"/.*?([^/]+)/value")  # OpenSim 4: /jointset/hip_r/hip_flexion_r/value
_SHOWN = 6  # columns in a sentence


@dataclass(frozen=True)
class Table:
    """A file's columns by label, and whether it says that angles are degrees."""

    labels: list[str]
    values: Array
    degrees: bool | None = None


def read_motion(
    path: str | os.PathLike[str],
    model: str | Model,
    *,
    names: Mapping[str, str] | None = None,
    ignore_others: bool = False,
    degrees: bool | None = None,
    **options: Any,
) -> Motion:
    """A motion of a model from a .csv (.txt, .tsv), .mot or .sto file.

    A CSV has one row of names, `time` among them, then numbers; commas, tabs, semicolons (then
    with decimal commas too) or spaces between. A unit may follow in brackets: time [s] or [ms],
    joint [rad] or [deg], slide [m], [cm] or [mm]. Columns without are seconds, radians and metres;
    `degrees` says whether angles are degrees in a file that does not say so itself, and must be
    said for a .mot or .sto of that kind.

    Columns are joints' names, or what a left–right pair shares, then with the left side's angles.
    `names` maps other columns to them: {"arm_flex_r": "right_shoulder_flexion"}; columns that are
    neither are refused, or left out with `ignore_others`. `options` are those of
    `sampled_motion`: cutoff, rate, start, stop, gap, slack. Raises SomersaultError, naming line,
    column or time, for anything that cannot be read or does not fit the model.
    """
    model = load(model)
    try:
        file = File(path)
    except TypeError:
        raise SomersaultError(f"{path!r} is no file of a motion; give its path") from None
    truth("ignore_others", ignore_others)
    if degrees is not None:
        truth("degrees", degrees)
    try:
        table = table_of(file)
        said = table.degrees if degrees is None else degrees
        if None not in (degrees, table.degrees) and degrees != table.degrees:
            raise SomersaultError(
                f"degrees={degrees} contradicts its header, inDegrees="
                f"{'yes' if table.degrees else 'no'}; correct one of them"
            )
        if said is None and file.suffix.lower() in (".mot", ".sto"):
            raise SomersaultError(
                "its header does not say inDegrees=yes or no; say degrees=True or False"
            )
        times, rows = _columns(table, model, {} if names is None else names, ignore_others, said)
        return sampled_motion(model, times, rows, source=file.name, **options)
    except SomersaultError as mistake:
        raise SomersaultError(f"{file.name}: {mistake}") from None


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
        with file.open("rb") as opened:
            data = opened.read(MOST_BYTES + 1)
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
        if told and int(told.group(1)) != found:
            raise SomersaultError(
                f"its header says {told.group(1)} {what} and there are {found}; "
                + (
                    "it was cut off, so export it again"
                    if int(told.group(1)) > found
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


def _columns(
    table: Table, model: Model, names: Mapping[str, str], ignore_others: bool, degrees: bool | None
) -> tuple[Array, dict[str, Array]]:
    """Times (T,) in s, and samples (T,) by the joint's or pair's name in rad or m."""
    if not isinstance(names, Mapping):
        raise SomersaultError(f"names map columns to joints, and are {names!r}")
    known, used, others = nameable(model), set[str](), list[str]()
    times: Array | None = None
    rows: dict[str, Array] = {}
    for k, label in enumerate(table.labels):
        column, unit = _split(label)
        if times is None and column.lower() == "time":
            times = table.values[:, k] * _factor(label, unit, "time", None)
            continue
        key = next((c for c in (label, column) if c in names), None)
        name = column if key is None else names[key]
        used |= {key} if key is not None else set()
        if key is None and name not in known:
            others.append(column)
            continue
        if name in rows:
            raise SomersaultError(f"two columns are joint {name}; keep one of them")
        joint = model.joint(next(iter(spread(model, [name]))))
        rows[name] = table.values[:, k] * _factor(label, unit, joint.kind, degrees)
    if times is None:
        raise SomersaultError("it has no column named time; name the one with the seconds so")
    missing = [name for name in names if name not in used]
    if missing:
        raise SomersaultError(
            f"it has no column {missing[0]!r}, which names speaks of; correct names"
        )
    if others and not ignore_others:
        raise SomersaultError(
            f"it has columns that are no joints of {model.name}: {_list(others)}; map them with "
            "names, or leave them out with ignore_others=True"
        )
    if not rows:
        raise SomersaultError(
            f"none of its columns is a joint of {model.name}; map columns to joints with names"
        )
    return times, rows


def _split(label: str) -> tuple[str, str | None]:
    """A column's name and its unit, if one follows in brackets."""
    found = _LABEL.fullmatch(label)
    if found and (label.endswith("]") or found["unit"].strip() in _UNITS):
        return found["name"], found["unit"].strip()
    state = _STATE.fullmatch(label)
    return (state[1] if state else label), None


def column_name(label: str) -> str:
    """A column's name without its unit."""
    return _split(label)[0]


def seconds(label: str) -> float:
    """What a column of times is multiplied by to be in s."""
    return _factor(label, _split(label)[1], "time", None)


def _factor(label: str, unit: str | None, kind: str, degrees: bool | None) -> float:
    """What a column's numbers are multiplied by to be in s, rad or m."""
    if unit is None:
        return _UNITS["deg"] if kind == "hinge" and degrees else 1.0
    if unit not in _FITTING.get(kind, (unit,)) or unit not in _UNITS:
        fitting = " or ".join(_FITTING.get(kind, ("rad", "deg")))
        raise SomersaultError(f"column {label!r} has the unit {unit!r}; give {fitting}")
    return _UNITS[unit]


def _list(names: list[str]) -> str:
    shown = ", ".join(name[:40] for name in names[:_SHOWN])
    return shown + (f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else "")
