"""How flights of an ensemble landed, as one picture of their bodies."""

from __future__ import annotations

import json
import math
import os
from typing import TYPE_CHECKING, Any, Protocol, cast, runtime_checkable

import numpy as np

from somersault._core.array import Array
from somersault._core.checks import whole_number
from somersault._core.errors import SomersaultError
from somersault._core.places import check_file
from somersault.ensembles._endings import ending_words, failed, run_already
from somersault.ensembles._moved import moved
from somersault.ensembles._plan import SAMPLE, Plan
from somersault.ensembles._summary import within
from somersault.history import History, Recording
from somersault.simulation import ENDED, LANDING_ERROR, Numbers
from somersault.view.style import BLUE, GREY, LINES, VERMILION

if TYPE_CHECKING:
    import xarray as xr

_MOST = 240
_RUN = "run"
_SAME = 1e-9  # of their time: runs that end so close together end at once

Key = list[tuple[str, str]]


@runtime_checkable
class Shown(Protocol):
    """A simulation whose runs can be looked at."""

    def history(self, values: Numbers) -> History:
        """Of one run, to its end."""

    def ending_in_words(self, ending: str) -> str:
        """What runs did that ended so: "flew for 2 s"."""


def landings(
    data: xr.Dataset, plan: Plan | None, path: str | os.PathLike[str], good: Any,
    tolerance: float | None, most: int, **options: Any,
) -> None:  # fmt: skip
    """As `Ensemble.landings` has it."""
    from somersault.view import landings_picture

    check_file(path, (".png",))
    simulation = _require_plan(data, plan).simulation
    plan = cast(Plan, plan)
    if not isinstance(simulation, Shown):
        raise SomersaultError(f"runs of {simulation.name} have no history that could be drawn")
    if good is not None and tolerance is not None:
        raise SomersaultError("good and tolerance are both given; give one, to say what landed")
    if good is not None and getattr(getattr(good, "dtype", None), "kind", "") != "b":
        raise SomersaultError("good must be true or false for each flight, like data.tilt < 0.1")
    if good is not None and dict(getattr(good, "sizes", {})) != plan.dims:
        raise SomersaultError("good must say it of each flight, over all dimensions of the dataset")
    most = whole_number("most", most, 1, _MOST)
    numbers, columns = _chosen(plan.dims, most)
    runs = _picked(data, plan.dims, numbers)
    lost, there = failed(runs[ENDED]).values, run_already(runs[ENDED]).values
    if not np.any(there & ~lost):
        raise SomersaultError("none of these flights has a landing to be drawn")
    order = np.flatnonzero(there & ~lost)
    errors = runs[LANDING_ERROR].values if LANDING_ERROR in runs else None
    if columns is None and errors is not None:
        order = order[np.argsort(errors[order], kind="stable")]
    if good is not None:
        chosen = _picked(good.rename("good").to_dataset(), plan.dims, numbers)["good"].values
        colors, key = _of_two(chosen[order], "landed")
    elif tolerance is not None:
        landed = within(runs, tolerance).values[order]
        colors, key = _of_two(landed, f"landed: landing error at most {tolerance:g} rad")
    else:
        colors, key = _by_ending(runs[ENDED], order, simulation)
    ends = _ends(plan, simulation, numbers[order])
    words = _captions(ends, numbers[order], None if errors is None else errors[order])
    if lost.any():
        key.append((GREY, f"{int(lost.sum())} failed and are not drawn"))
    if columns is not None and len(order) == len(numbers) and not options.get("superimposed"):
        options = {"columns": columns, **options}
        key.append(("", _axes(data, plan)))
    landings_picture(_poses(ends), path, colors, words, key, **options)


def _of_two(landed: Array, what: str) -> tuple[list[str], Key]:
    """Colours of bodies that landed or did not, and what the colours mean."""
    colors = [BLUE if one else VERMILION for one in landed]
    key = [(BLUE, f"{int(landed.sum())} of the {len(landed)} shown {what}")]
    if not landed.all():
        key.append((VERMILION, f"{int((~landed).sum())} did not land"))
    return colors, key


def _by_ending(ended: xr.DataArray, order: Array, simulation: Shown) -> tuple[list[str], Key]:
    """Colours of bodies by how their runs ended, and what the colours mean."""
    codes = ended.values[order]
    known = np.unique(codes).tolist()
    color = dict(zip(known, LINES, strict=False))
    key: Key = []
    for code in known:
        count = f"{int((codes == code).sum())}" + (f" of {len(codes)}" if not key else "")
        said = simulation.ending_in_words(ending_words(ended)[code])
        key.append((color[code], f"{count} {said}"))
    return [color[code] for code in codes.tolist()], key


def _captions(ends: list[History], numbers: Array, errors: Array | None) -> list[str]:
    """What stands below each body: its landing error, or when its run ended, or which it is."""
    if errors is not None:
        return [f"{error:.2g} rad" for error in errors]
    times = np.array([history.times[-1] for history in ends])
    if np.ptp(times) > _SAME * times.max():
        return [f"{time:.3g} s" for time in times]
    return [f"no. {number:,}" for number in numbers]


def _require_plan(data: xr.Dataset, plan: Plan | None) -> Plan:
    """The plan; SomersaultError unless it is there and is the dataset's."""
    if plan is None:
        raise SomersaultError(
            "a file holds no model to be drawn; give plan=ensembles.read_ensemble(SPEC).plan, or "
            "call ensemble again with what was flown and out=, which flies no flight twice"
        )
    if not isinstance(plan, Plan):
        raise SomersaultError("plan must be a Plan, as ensembles.plan makes it")
    if data.attrs.get("specification") != json.dumps(plan.specification):
        raise SomersaultError("this plan is not that of the ensemble; give the one that was flown")
    return plan


def _chosen(dims: dict[str, int], most: int) -> tuple[Array, int | None]:
    """Numbers of the runs that are drawn, and of a map over two grids how many are in a row."""
    total = math.prod(dims.values())
    if len(dims) == 2 and SAMPLE not in dims:
        side = max(1, math.isqrt(most))
        rows, columns = (_spread(length, side) for length in dims.values())
        width = list(dims.values())[1]
        return (rows[:, None] * width + columns).ravel(), len(columns)
    return _spread(total, most), None


def _axes(data: xr.Dataset, plan: Plan) -> str:
    """Along which grids a map goes."""
    said = []
    for way, name in zip(("down", "across"), plan.dims, strict=True):
        values, unit = data[name].values, data[name].attrs.get("units", "")
        said.append(f"{way}: {name}, {values[0]:g} to {values[-1]:g} {unit}".rstrip())
    return ";  ".join(said)


def _spread(count: int, most: int) -> Array:
    """At most so many of the first whole numbers, evenly from first to last."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))


def _picked(data: xr.Dataset, dims: dict[str, int], numbers: Array) -> xr.Dataset:
    """What is known of some runs, over the dimension "run"."""
    import xarray as xr

    places = np.unravel_index(numbers, tuple(dims.values()))
    at = {name: xr.DataArray(x, dims=_RUN) for name, x in zip(dims, places, strict=True)}
    known = [n for n in (ENDED, LANDING_ERROR, "good") if n in data]
    picked = data[known].isel(at).load()
    if ENDED in picked:
        ending_words(picked[ENDED])
    return picked


def _ends(plan: Plan, simulation: Shown, numbers: Array) -> list[History]:
    """Histories of some runs, to their ends."""
    ends = []
    for number in numbers.tolist():
        given = plan.varied(number, number + 1)
        values = moved(plan.simulation.values, plan.vary, plan.targets, given)
        ends.append(simulation.history(values))
    return ends


def _poses(ends: list[History]) -> Recording:
    """Where bodies are at the ends of their runs, one after the other, about their own places."""
    rows = {
        name: np.array([getattr(history, name)[-1] for history in ends])
        for name in ("base_position", "base_quaternion", "joint_coordinates", "angles")
    }
    return Recording(ends[0].model, np.arange(len(ends), dtype=float), **rows)
