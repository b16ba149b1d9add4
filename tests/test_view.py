"""Pictures are drawn without a window, and repeat."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

import somersault as so
from somersault.view import charts, contact_sheet, time_histories
from somersault.view import style as look


def test_importing_the_pictures_does_not_load_matplotlib():
    code = "import sys, somersault.thesis; sys.exit('matplotlib' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_figures_need_no_pyplot():
    code = (
        "import sys, io; from somersault.view import charts, style as s\n"
        "with s.style(): f = s.figure(); charts.square(f.add_subplot()); s.saved(f, 'png')\n"
        "sys.exit('matplotlib.pyplot' in sys.modules)"
    )
    assert subprocess.run([sys.executable, "-c", code]).returncode == 0


def test_style_leaves_settings_as_they_were():
    import matplotlib

    before = matplotlib.rcParams["font.size"], matplotlib.rcParams["svg.hashsalt"]
    with look.style():
        assert matplotlib.rcParams["svg.hashsalt"] == "somersault"
    assert (matplotlib.rcParams["font.size"], matplotlib.rcParams["svg.hashsalt"]) == before


def test_svg_repeats_byte_for_byte():
    def drawn() -> bytes:
        with look.style():
            figure = look.figure()
            charts.square(figure.add_subplot(), "a square")
            return look.saved(figure, "svg")

    assert drawn() == drawn()


def test_names_behind_lines_stand_apart_and_as_their_ends_do():
    model = so.athlete(1.7, 60.0)
    q = np.zeros((2, len(model.coordinates)))
    q[1, :6] = [0.5, 0.5, 0.5, 0.51, -0.4, 0.0]  # three end in one place, and one does not move
    base = {"base_position": np.zeros((2, 3)), "base_quaternion": np.tile([1.0, 0, 0, 0], (2, 1))}
    held = so.Recording(
        model, np.array([0.0, 1.0]), **base, joint_coordinates=q, angles=np.zeros((2, 3))
    )
    joints = time_histories(held).axes[2]
    named = {text.get_text(): text.get_position()[1] for text in joints.texts}
    assert list(named) == [name.replace("_", " ") for name in model.coordinates[:5]]
    places = np.array(list(named.values()))
    assert np.diff(np.sort(places)).min() > 0.089
    assert np.argmax(places) == 3
    assert np.argmin(places) == 4
    low, high = joints.get_ylim()
    assert places[:4].mean() == pytest.approx((0.5025 - low) / (high - low))  # about their ends
    assert places[4] == pytest.approx((-0.4 - low) / (high - low))


def test_locus_draws_every_root():
    values = np.linspace(0, 1, 5)
    roots = np.array([[v + 1j, -v - 1j] for v in values])
    with look.style():
        ax = look.figure().add_subplot()
        dots = charts.locus(ax, values, roots, arrows=(0.5,))
        assert len(dots.get_offsets()) == roots.size
        assert list(dots.get_array()) == list(np.repeat(values, 2))
        heads = [t for t in ax.texts if t.get_text() == ""]
        assert len(heads) == 0  # steps of 0.25 are too long to call a direction
        charts.locus(ax, np.linspace(0, 1, 21), np.linspace(0, 1, 21)[:, None] * 1j, arrows=(0.5,))
        head = next(t for t in ax.texts if t.get_text() == "")
        assert head.xyann == (0.0, 0.5)
        assert head.xy[1] > 0.5


def test_a_filled_region_has_the_points_that_are_true():
    with look.style():
        ax = look.figure().add_subplot()
        x, y = np.linspace(0, 1, 11), np.linspace(0, 2, 21)
        charts.filled(ax, x, y, (y[:, None] > 0.95) & (x[None, :] > 0.45))
        box = ax.collections[0].get_paths()[0].get_extents()
    assert np.allclose([box.x0, box.y0, box.x1, box.y1], [0.45, 0.95, 1, 2], atol=0.01)


def test_figures_of_a_flight_stay_clear_of_their_labels():
    """A body that is piked at takeoff reaches further once it is straight."""
    import somersault as so

    flight = so.hula(spin=11.0, hold=0.16, duration=1.0).fly(samples=51)
    made = contact_sheet(flight, np.linspace(0, 1, 12), columns=6)
    for ax in made.axes:
        lowest = min(patch.get_path().vertices[:, 1].min() for patch in ax.patches)
        assert len(ax.patches) > 50
        assert lowest > max(words.get_position()[1] for words in ax.texts)
