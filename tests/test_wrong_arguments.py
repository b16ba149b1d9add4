"""Each argument of each public call, given many wrong things: one sentence, or an answer.

`right_calls.py` has a call that works for each public name; here a test demands that it has all.
"""

from __future__ import annotations

import importlib
import inspect
import os
import shutil
import signal
import warnings
from collections.abc import Iterator, Mapping
from contextlib import chdir
from datetime import datetime
from fnmatch import fnmatchcase
from pathlib import Path
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pytest
from right_calls import CALLS, files, flown, furrer, spun

import somersault as so

LONGEST = 60  # s, on a machine that has much else to do
SHARE = 8
LIGHT = (  # soon done
    *(
        f"{room}.*"
        for room in ("attitude", "dynamics", "history", "model", "motion", "rigid", "spec")
    ),
    "view.Look",
)
MOST_CHARACTERS = 850
WRONG: dict[str, Any] = {
    "None": None,
    "true": True,
    "text": "x",
    "empty": "",
    "bytes": b"",
    "zero": 0,
    "negative": -1,
    "nan": float("nan"),
    "inf": float("inf"),
    "huge": 10**400,
    "long": 10**5000,
    "tiny": 1e-320,
    "complex": 1j,
    "list": [],
    "table": {},
    "object": object(),
    "type": float,
    "function": len,
    "date": datetime(2024, 1, 1),
    "words": ["x", "y"],
    "mixed": [1.0, "two"],
    "ragged": [[1.0], [2.0, 3.0]],
    "matrix": np.zeros((2, 5)),
    "row": np.arange(7.0),
    "none": np.zeros(0),
    "of no dimension": np.array(1.0),
    "texts": np.array(["a", "b"]),
    "objects": np.array([None, 1], object),
    "nans": [float("nan")] * 3,
    "complexes": np.array([1j, 2.0]),
    "table of text": {"shoulder": "straight"},
    "table of rows": {"shoulder": [0.1, 0.2, 0.3]},
    "table by number": {3: 1.0},
    "pair": ("pose.shoulder", []),
    "name": "stiffness.knee",
    "triple": ("pose.shoulder", 1.0, "high"),
    "set": {1, 2},
    "generator": (k for k in "ab"),
    "nothing there": Path("none.xml"),
    "folder": Path("folder"),
    "pipe": Path("pipe"),
    "zero byte": "a\0b",
    "not UTF-8": "\udce9.xml",
    "bytes of a name": b"main.toml",
    "long name": "x" * 100_000,
    "model": furrer(),
    "spin": spun(),
    "flight": flown(),
    "takeoff": so.Takeoff(),
}
ROOMS = (
    "attitude",
    "designs",
    "dynamics",
    "ensembles",
    "flight",
    "history",
    "laws",
    "model",
    "motion",
    "planning",
    "rigid",
    "robot",
    "simulation",
    "spec",
    "stability",
    "thesis",
    "view",
)
# What nobody calls with things of his own, and why: the end of a name with * is any.
SYMBOLS = "an algorithm over symbols, for whoever writes equations of his own"
MADE = "the package makes it, of what it has checked"
AUTHORS = "for whoever writes a behaviour, a simulation, a format or a figure in Python"
PATHS = "behaviours make paths by it, of rows that they have checked, and follow them with symbols"
NOT_FOR_USERS = {
    **dict.fromkeys(
        (
            "Composite*",
            "Expression",
            "Link",
            "Momentum",
            "Tree*",
            "composite_bodies",
            "constrained_dynamics",
            "forward_dynamics",
            "inverse_dynamics",
            "link_tree",
            "mass_matrix",
            "momentum",
            "outboard_inertia",
            "sequence_rates",
            "placements",
            "spring_torques",
            "wrapped",
        ),
        SYMBOLS,
    ),
    **dict.fromkeys(
        (
            "Ensemble",
            "EnsembleSpec",
            "Design",
            "DesignSpec*",
            "TradeOff",
            "Plan",
            "Plan.drawn",
            "PlanSpec*",
            "Flight",
            "Flights",
            "Flights.ending_in_words",
            "Flights.history",
            "Flights.run",
            "Flights.sound",
            "Flights.with_varied",
            "Landing",
            "Release",
            "Swing",
            "Swing.stroboscopic_picture",
            "Mount",
            "Pair",
            "RecordedBase*",
            "Controller",
            "Event",
            "Machine",
            "Run",
            "Runs.carried_out",
            "check_name",
            "Runs.run",
            "Runs.sound",
            "Runs.with_varied",
            "LinearSpin",
            "Mode",
            "PrincipalAxes",
            "Resonance",
            "Burst",
            "Spin",
            "Noise*",
            "Attempt",
        ),
        MADE,
    ),
    **dict.fromkeys(
        (
            "as_moves",
            "check_rows",
            "held",
            "increasing",
            "moves",
            "polynomial",
            "straight",
            "value",
        ),
        PATHS,
    ),
    "summary": "a history calls it of itself, as its repr; of an ensemble it has a right call",
    **dict.fromkeys(
        (
            "JointTakeoff",
            "JointTakeoff.*",
            "mirrored",
            "mirrored_name",
            "seeds",
            "Prop.torque",
            "Choose.*",
            "Limit.*",
            "Mean.*",
            "Objective*",
            "Quantile.*",
            "Share.*",
            "History",
            "Simulation*",
            "Endings*",
            "Target",
            "Variable",
            "Motion",
            "Path*",
            "Unfit",
            "read_as",
            "written_as",
            "structured_within",
            "structured",
            "Claim*",
            "Entry*",
            "Erratum",
            "Result",
            "Table",
            "number",
            "statement",
            "verdict",
            "Exit",
            "Now*",
            "State*",
            "Filmed*",
            "draw_pose",
        ),
        AUTHORS,
    ),
}


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The files that right calls read, once for all."""
    folder = tmp_path_factory.mktemp("written")
    with chdir(folder):
        files()
    return folder


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    shutil.copytree(written, tmp_path, dirs_exist_ok=True)
    Path("folder").mkdir()
    os.mkfifo("pipe")
    yield
    plt.close("all")


def _arguments(call: Any) -> dict[str, inspect.Parameter]:
    """What a call takes, without whose method it is."""
    try:
        parameters = inspect.signature(call).parameters
    except ValueError:
        return {}
    return {name: p for name, p in parameters.items() if name != "self"}


def _public() -> Iterator[tuple[str, Any]]:
    """Every public function, class and method that takes something, by its name."""
    for room in ROOMS:
        module = importlib.import_module(f"somersault.{room}")
        names = getattr(module, "__all__", None) or [
            name
            for name, thing in vars(module).items()
            if not name.startswith("_") and getattr(thing, "__module__", "") == module.__name__
        ]
        for name in names:
            thing = getattr(module, name)
            things = {name: thing}
            if inspect.isclass(thing):
                held = inspect.getmembers(
                    thing, lambda m: inspect.isfunction(m) or inspect.ismethod(m)
                )
                things |= {f"{name}.{method}": call for method, call in held if method[0] != "_"}
            for called, one in things.items():
                called_so = inspect.isclass(one) or inspect.isroutine(one)
                if called_so and _arguments(one):
                    yield f"{room}.{called}", one


PUBLIC = dict(_public())


def _tried(name: str) -> list[str]:
    """The arguments of a call: those of its signature, and the options that its right call has."""
    if name == "thesis.reproduce":  # of which nothing, in any form, means everything
        return ["out", "progress"]
    signature = _arguments(PUBLIC[name]) if name in PUBLIC else {}
    plain = [n for n, p in signature.items() if p.kind not in (p.VAR_POSITIONAL, p.VAR_KEYWORD)]
    return [*plain, *(n for n in CALLS[name]()[1] if n not in plain)]


def _others(name: str, right: Mapping[str, Any], argument: str) -> Iterator[Mapping[str, Any]]:
    """What else is given: all of the right call, and as little as can be.

    What is given can keep a mistake from where it would do harm: a landing to fly against keeps a
    wrong maneuver from being flown.
    """
    yield right
    signature = _arguments(PUBLIC[name]) if name in PUBLIC else {}
    needed = {n: p for n, p in signature.items() if p.default is p.empty and n in right}
    if argument in needed and name != "thesis.reproduce":
        least = {n: None if "None" in str(p.annotation) else right[n] for n, p in needed.items()}
        yield least


def one_sentence(mistake: so.SomersaultError) -> None:
    said = str(mistake)
    assert said.strip()
    assert "\n" not in said
    assert len(said) <= MOST_CHARACTERS
    said.encode()  # a shell can print it


def _too_long(*_: Any) -> None:
    raise TimeoutError(f"longer than {LONGEST} s")


def check(name: str, argument: str, wrong: str) -> None:
    """One sentence or an answer, in time, and no file left by what was refused."""
    call, right = CALLS[name]()
    for others in _others(name, right, argument):
        _check(call, {**others, argument: WRONG[wrong]})


def _check(call: Any, given: Mapping[str, Any]) -> None:
    before = sorted(os.listdir())
    signal.signal(signal.SIGALRM, _too_long)
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("error")
        warnings.simplefilter("ignore", so.SomersaultWarning)
        signal.alarm(LONGEST)
        try:
            call(**given)
        except so.SomersaultError as mistake:
            one_sentence(mistake)
            assert sorted(os.listdir()) == before
        finally:
            signal.alarm(0)
            plt.close("all")


def _is_light(name: str) -> bool:
    return any(fnmatchcase(name, light) for light in LIGHT)


def test_every_public_call_has_a_right_one() -> None:
    """So that what is new is tested here by itself: add a call of it to `right_calls.CALLS`."""
    missing = [
        name
        for name in PUBLIC
        if name not in CALLS
        and not any(fnmatchcase(name.partition(".")[2], left) for left in NOT_FOR_USERS)
    ]
    assert not missing


def test_nothing_is_left_out_that_is_not_there() -> None:
    ends = [name.partition(".")[2] for name in PUBLIC]
    assert all(any(fnmatchcase(end, left) for end in ends) for left in NOT_FOR_USERS)


@pytest.mark.parametrize("name", CALLS)
def test_the_right_call_works(name: str) -> None:
    call, right = CALLS[name]()
    call(**right)


@pytest.mark.parametrize("name", [name for name in CALLS if _is_light(name)])
def test_one_sentence_or_an_answer(name: str) -> None:
    """A share of the wrong things, another one for each argument."""
    _check_share(name, SHARE)


@pytest.mark.slow
@pytest.mark.parametrize("name", CALLS)
def test_one_sentence_or_an_answer_to_more(name: str) -> None:
    """All of them where a call is soon done."""
    _check_share(name, 1 if _is_light(name) else SHARE)


def _check_share(name: str, share: int) -> None:
    for place, argument in enumerate(_tried(name)):
        for wrong in list(WRONG)[place % share :: share]:
            check(name, argument, wrong)
