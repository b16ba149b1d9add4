"""Designs on processes: the same bits, one cluster for a search, and none left after it."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import distributed
import psutil
import pytest
from test_designs import ARMS, STIFFNESS, TWIST, TWISTED

import somersault as so
from somersault.designs import Mean, trade_off
from somersault.designs._journal import Journal

LAYOUT = so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=ARMS), 0.3)
MUCH = {"size": 8, "evaluations": 12, "held_out": 8}


@pytest.fixture
def begun(monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """The clusters that are begun."""
    every: list[Any] = []

    class Counted(distributed.LocalCluster):
        def __init__(self, *given: Any, **options: Any) -> None:
            every.append(self)
            super().__init__(*given, **options)

    monkeypatch.setattr("distributed.LocalCluster", Counted)
    return every


def workers() -> list[psutil.Process]:
    """Processes of ours that are no housekeeping of Python's."""
    children = psutil.Process().children(recursive=True)
    return [p for p in children if "resource_tracker" not in " ".join(p.cmdline())]


def test_processes_find_the_same_in_one_cluster(begun: list[Any]) -> None:
    here = so.design(LAYOUT, STIFFNESS, TWISTED, TWIST, **MUCH)
    there = so.design(LAYOUT, STIFFNESS, TWISTED, TWIST, workers=1, **MUCH)
    assert here.table.tobytes() == there.table.tobytes()
    assert here.rows["twist"].tobytes() == there.rows["twist"].tobytes()
    assert len(here.generations) > 1
    assert len(begun) == 1
    assert not workers()


def test_a_trade_off_has_one_cluster_too(begun: list[Any]) -> None:
    pytest.importorskip("pymoo")
    aims = [TWIST, Mean("stiffness")]
    much = {**MUCH, "population": 4}
    here, there = (trade_off(LAYOUT, STIFFNESS, TWISTED, aims, **much, **where)
                   for where in ({}, {"workers": 1}))  # fmt: skip
    assert here.table.tobytes() == there.table.tobytes()
    assert len(begun) == 1
    assert not workers()


def test_an_interrupt_leaves_no_processes(
    begun: list[Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*given: Any) -> None:
        assert workers()
        raise KeyboardInterrupt

    monkeypatch.setattr(Journal, "add", interrupted)
    with pytest.raises(KeyboardInterrupt):
        so.design(LAYOUT, STIFFNESS, TWISTED, TWIST, workers=1, **MUCH)
    assert len(begun) == 1
    assert not workers()


SCRIPT = """
import somersault as so
runs = so.flight.flights("furrer", so.Takeoff(spin=8.64), 0.1)
print(so.ensemble(runs, workers=1).dataset.sizes["sample"])
"""


@pytest.mark.slow
@pytest.mark.parametrize("guarded", [False, True])
def test_a_script_that_is_read_by_its_own_workers_gets_a_sentence(
    guarded: bool, tmp_path: Path
) -> None:
    script = tmp_path / "script.py"
    inner = SCRIPT.replace("\n", "\n    ")
    script.write_text(f'if __name__ == "__main__":{inner}\n' if guarded else SCRIPT)
    told = subprocess.run([sys.executable, script], capture_output=True, encoding="utf-8")
    if guarded:
        assert (told.returncode, told.stdout) == (0, "1\n")
        return
    assert told.returncode == 1
    assert told.stderr.count("Traceback") == 1
    last = told.stderr.strip().splitlines()[-1]
    assert last.startswith("somersault._core.errors.SomersaultError: ")
    assert "below if __name__ == '__main__':" in last
