"""What once ended in a traceback: numbers, names and rows that Python and NumPy trip over."""

from __future__ import annotations

import os
import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest
from fuzz.readers import READERS

import somersault as so
from somersault import stability
from somersault._core.checks import shown
from somersault._core.numbers import as_floats, floats

LONG = "9" * 5000


@pytest.fixture(autouse=True)
def _in_a_folder_of_its_own(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def test_a_sentence_is_one_line_that_any_stream_takes() -> None:
    for kind in (so.SomersaultError, so.SomersaultWarning):
        said = str(kind(f"a\nb\0\x1b[2J \udce9 {'x' * 10**6}; mend it"))
        assert said.startswith(r"a b\x00\x1b[2J \udce9 xx")
        assert said.endswith("xx; mend it")
        assert len(said) < 1000
        said.encode()
    plain = "joint 'Knie (links)' – 0,3 µm ☂: mend it"
    assert str(so.SomersaultError(plain)) == plain
    assert str(pickle.loads(pickle.dumps(so.SomersaultError("a\nb")))) == "a b"


def test_a_mistaken_value_is_shown_whatever_it_is() -> None:
    class Broken:
        def __repr__(self) -> str:
            raise RuntimeError

    assert shown(-(10**5000)) == "a whole number of about 5,000 digits"
    assert shown(Broken()) == "a Broken that cannot be shown"
    assert len(shown("x" * 10**6)) < 300


@pytest.mark.parametrize(
    "value",
    [
        None,
        [1.0, None],
        1j,
        np.array([1j]),
        ["a"],
        np.array(["1"]),
        [np.datetime64("2024")],
        [[1], [2, 3]],
        10**400,
    ],
)
def test_what_is_no_number_is_not_made_one(value: object) -> None:
    assert as_floats(value) is None
    with pytest.raises(so.SomersaultError, match="x must be numbers"):
        floats("x", value)


@pytest.mark.parametrize("name", ["spec", "ensemble"])
def test_integers_of_thousands_of_digits_in_a_spec(name: str) -> None:
    reader = READERS[name]
    text = next(iter(reader.good()[0].values()))
    assert text is not None
    Path("main.toml").write_bytes(
        text.replace(b"0.2", LONG.encode()).replace(b"0.3", LONG.encode())
    )
    with pytest.raises(so.SomersaultError, match="number that is too long"):
        reader.read(Path("main.toml"))


@pytest.mark.parametrize("key", ["duration", "samples", "takeoff.spin"])
def test_hexadecimal_integers_of_any_length_in_a_spec(key: str) -> None:
    """TOML's other integers have no limit of digits."""
    table, _, name = key.rpartition(".")
    head = f"[{table}]\n" if table else ""
    Path("main.toml").write_text(f'model = "book"\n{head}{name} = 0x{"f" * 5000}')
    with pytest.raises(so.SomersaultError) as refused:
        so.Maneuver.read("main.toml")
    assert f"{key} must be a finite number below 1e9, and is a whole number of about 6,021" in str(
        refused.value
    )


def test_integers_of_thousands_of_digits_in_tables_and_arguments() -> None:
    Path("arms.mot").write_text(
        f"x\nnRows={LONG}\nnColumns=2\nendheader\ntime left_shoulder\n0 0\n1 1\n"
    )
    with pytest.raises(so.SomersaultError, match="header says inf rows and there are 2"):
        so.read_motion("arms.mot", "furrer", degrees=True)
    Path("arms.csv").write_text(f"time,left_shoulder\n0,0\n{LONG},1\n")
    with pytest.raises(so.SomersaultError, match=r"line 3.*no number"):
        so.read_motion("arms.csv", "furrer")
    with pytest.raises(so.SomersaultError, match="duration"):
        so.fly("furrer", duration=10**5000)


@pytest.mark.parametrize("cutoff", [1e-10, 1e-320, 5e-324, 0.0, -6.0, 1e308])
def test_filters_that_would_leave_nothing(cutoff: float) -> None:
    times = np.arange(51) / 100
    with pytest.raises(so.SomersaultError, match=r"cannot be filtered at|below 1e9"):
        so.sampled_motion("furrer", times, {"left_shoulder": times}, cutoff=cutoff)


def test_the_slowest_filter_keeps_its_digits() -> None:
    """What is constant passes a low-pass filter of any cutoff, even of the slowest."""
    assert np.abs(so.motion.low_pass(np.full(2001, 0.3), 100.0, 0.0101) - 0.3).max() < 1e-8


def test_arrays_that_do_not_go_together() -> None:
    with pytest.raises(so.SomersaultError, match="do not go together"):
        stability.growth_rates(
            "furrer", {"pose.shoulder": [1.0, 1.2], "stiffness.shoulder": [1.0] * 3}
        )


@pytest.mark.skipif(os.name == "nt", reason="names are Unicode there")
@pytest.mark.parametrize("name", [name for name in READERS if READERS[name].endings])
def test_names_that_are_not_utf_8(name: str) -> None:
    """The file is read, or refused in a sentence that a stream takes."""
    reader = READERS[name]
    good = reader.good()[0]
    first, *others = good
    path = Path("\udce9").with_suffix(Path(first).suffix)
    path.write_bytes(good[first] or b"")
    for other in others:
        Path(other).write_bytes(good[other] or b"")
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", so.SomersaultWarning)
            reader.check(reader.read(path))
    except so.SomersaultError as mistake:
        str(mistake).encode()
    with pytest.raises(so.SomersaultError) as refused:
        reader.read(path.with_stem("none\udce9"))
    str(refused.value).encode()
