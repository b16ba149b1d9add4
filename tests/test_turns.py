"""Pairs by one name, turns by the singularity, and what is refused."""

import json
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from shares import every
from test_axes_flight import redrawn, retold, sign

import somersault as so
from somersault.attitude import Axes, angle_rates
from somersault.cli import main

ARM = so.JointTakeoff(motion="sprung", angle=1.4, rate=0.1, stiffness=34.48, hold=True)


def test_a_pair_by_its_common_name_is_mirrored() -> None:
    path = {"motion": "prescribed", "times": (0.0, 0.5)}
    both = so.Takeoff(spin=8.0, joints={"shoulder": so.JointTakeoff(angles=(0.3, 1.2), **path)})
    sides = so.Takeoff(
        spin=8.0,
        joints={
            "left_shoulder": so.JointTakeoff(angles=(0.3, 1.2), **path),
            "right_shoulder": so.JointTakeoff(angles=(-0.3, -1.2), **path),
        },
    )
    one, two = (so.fly("furrer", takeoff, 1.0) for takeoff in (both, sides))
    np.testing.assert_array_equal(one.states, two.states)
    with pytest.raises(so.SomersaultError, match="twice"):
        so.fly("furrer", so.Takeoff(joints={"shoulder": ARM, "left_shoulder": ARM}))


@pytest.mark.parametrize(
    ("angles", "omega"),
    [
        ((-1.41732266, 0.76053933, 0.11442994), (-3.22171941, 3.48670863, 2.18743438)),
        ((0.91810712, 0.39095327, -0.41190943), (17.22940403, 5.28155172, -6.83576802)),
    ],
)
@pytest.mark.parametrize("samples", every([2, 601], 2))
@pytest.mark.parametrize("axes", [(2, 1, 3), (3, 2, 1)])
def test_turns_by_the_singularity(angles: tuple, omega: tuple, samples: int, axes: Axes) -> None:
    """Angles integrated as angles (eq. 2.3), past cos \u0398 of 1e-4, tell the turns."""
    inertia = np.diag(np.array(so.load("book").bodies[0].inertia))

    def slope(_: float, y: np.ndarray) -> np.ndarray:
        turning = np.cross(inertia * y[3:], y[3:]) / inertia
        return np.concatenate([angle_rates(y[:3], y[3:]), turning])

    wanted = solve_ivp(slope, (0, 6), [*angles, *omega], "DOP853", rtol=1e-11, atol=1e-12).y[:3, -1]
    takeoff = retold(so.Takeoff(*angles, angular_velocity=omega), axes)
    end = so.fly(redrawn(so.load("book"), axes), takeoff, 6.0, samples=samples).landing
    found = [sign(axes) * end.somersault, end.tilt, end.twist]
    np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-5)


def test_the_turns_of_a_takeoff_are_kept() -> None:
    flight = so.fly("book", so.Takeoff(somersault=20.0, twist=-9.0, spin=3.0), 1.0)
    assert float(flight.dataset.somersault[0]) == pytest.approx(20.0)
    assert float(flight.dataset.twist[0]) == pytest.approx(-9.0)


def test_deviations_need_a_spin_and_numbers() -> None:
    spin = so.spin("furrer")
    for bad, naming in (({"rate": 0}, "rate"), ({"rate": "8"}, "rate"), ({"rate": np.nan}, "rate")):
        with pytest.raises(so.SomersaultError, match=naming):
            so.deviated_flight(spin, duration=1.0, **bad)
    with pytest.raises(so.SomersaultError, match="tilt"):
        so.deviated_flight(spin, 8.0, 1.0, tilt=np.nan)


HUGE = {
    "spin": "[takeoff]\nspin = 1e300",
    "tilt": "[takeoff]\ntilt = 1e300",
    "angular_velocity": "[takeoff]\nangular_velocity = [1.0, 0.0, 1e300]",
    "duration": "duration = 1" + "0" * 400,
    "gravity": "gravity = [0.0, 0.0, 1e308]",
    "rate": '[joints.left_shoulder]\nmotion = "free"\nrate = 1e300',
    "microsecond": '[joints.left_shoulder]\nmotion = "prescribed"\n'
    "times = [0.0, 1e-320]\nangles = [0.0, 1.0]",
    "broke off": '[takeoff]\nspin = 5.0\n[joints.left_shoulder]\nmotion = "sprung"\n'
    "angle = 0.5\nrest = 0.0\nstiffness = 9e8\ndamping = 9e8",
}


@pytest.mark.parametrize("naming", HUGE)
def test_what_is_out_of_reach_is_told(
    naming: str, tmp_path: Path, capsys: pytest.CaptureFixture
) -> None:
    spec = tmp_path / "s.toml"
    spec.write_text(f'model = "furrer"\n{HUGE[naming]}\n')
    assert main(["fly", str(spec), "--out", str(tmp_path / "f.csv")]) == 2
    out, err = capsys.readouterr()
    assert (out, err.count("\n")) == ("", 1)
    assert naming in err
    assert not (tmp_path / "f.csv").exists()


def test_a_byte_order_mark_is_no_mistake(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    spec = tmp_path / "s.toml"
    spec.write_bytes(b"\xef\xbb\xbfmodel = 'book'\n[takeoff]\nspin = 3.0\n")
    assert main(["fly", str(spec), "--json"]) == 0
    assert json.loads(capsys.readouterr().out)["ended"] == "duration"
