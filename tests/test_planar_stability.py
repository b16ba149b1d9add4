"""Spins of planar models: against a closed form, spins in space, and flights."""

from __future__ import annotations

import json
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from planes import AXES, random_chain
from scipy.linalg import expm
from test_deviation import SMALL

import somersault as so
from somersault import cli
from somersault.model import Body, Joint, Model, as_matrix
from somersault.stability import (
    chart,
    growth_rates,
    holding_torques,
    principal_inertias,
    root_locus,
    stable_ranges,
)

RATE = 5.0
A, B, M1, M2, I1, I2 = 0.3, 0.4, 7.0, 3.0, 0.5, 0.2  # lengths, masses, inertias of two links


def two_links(plane: int = 2, straight: float = 1.0) -> Model:
    """Two links in line, the second beyond the first or (−1) folded back over it, their inertias
    known about the normal alone."""
    normal = np.eye(3)[plane - 1]
    along = np.eye(3)[plane % 3]
    rows = np.outer(normal, normal)
    one = Body("one", -1, M1, (0.0, 0.0, 0.0), as_matrix(I1 * rows))
    two = Body(
        "two", 0, M2, tuple((straight * B * along).tolist()), as_matrix(I2 * rows),
        position=tuple((A * along).tolist()),
        joints=(Joint("hip", "hinge", tuple(normal.tolist())),),
    )  # fmt: skip
    return Model("links", True, (one, two), axes=AXES[plane], plane=plane)


def frequency_squared(straight: float = 1.0, spring: float = 0.0) -> float:
    """(ω/Ω)² of the joint's swing: C (A + B + 2C)/(AB − C²) with the inertias A, B, C of the
    reduced mass; a spring k/Ω² stands beside C."""
    reduced = M1 * M2 / (M1 + M2)
    a, b, c = I1 + reduced * A**2, I2 + reduced * B**2, straight * reduced * A * B
    return (c + spring) * (a + b + 2 * c) / (a * b - c * c)


@pytest.mark.parametrize("plane", [1, 2, 3])
def test_two_links_swing_as_the_closed_form_says(plane: int) -> None:
    spin = so.spin(two_links(plane))
    assert spin.axis == plane
    system = spin.linear()
    assert system.coordinates == ("somersault", "hip")
    assert (system.stable, system.energy_signature) == (True, "definite")
    wanted = np.sqrt(frequency_squared())
    np.testing.assert_allclose(sorted(system.roots.imag), [-wanted, 0, 0, wanted], atol=1e-12)
    assert [mode.name for mode in system.modes] == ["somersault drift", "two–body oscillation"]
    whole = I1 + I2 + M1 * M2 / (M1 + M2) * (A + B) ** 2
    assert spin.principal_inertias[plane - 1] == pytest.approx(whole, rel=1e-14)
    assert np.isnan(list(spin.inertia_ratios.values())).all()


def test_folded_links_open() -> None:
    system = so.spin(two_links(straight=-1.0)).linear()
    assert (system.stable, system.energy_signature) == (False, "unstable")
    assert system.growth_rate == pytest.approx(np.sqrt(-frequency_squared(-1.0)), rel=1e-12)


def test_a_spring_that_holds_them_is_as_strong_as_the_centrifugal_one() -> None:
    model = two_links(straight=-1.0)
    edge = M1 * M2 / (M1 + M2) * A * B / (I2 + M2 * B**2)  # C over the I of K = k/(Ω² I)
    ((low, high),) = stable_ranges(model, ("stiffness.hip", 0.0, 3.0))
    assert (low, high) == (pytest.approx(edge, abs=1e-8), 3.0)
    springs = np.array([0.0, 0.2, 2.0])
    rates = growth_rates(model, stiffness={"hip": springs})
    k = springs * (I2 + M2 * B**2)
    wanted = [np.sqrt(max(-frequency_squared(-1.0, x), 0.0)) for x in k]
    np.testing.assert_allclose(rates, wanted, rtol=0, atol=1e-12)
    found = chart(model, ("pose.hip", [0.0]), ("stiffness.hip", springs), energy=True)
    assert found.stable.values.ravel().tolist() == [False, False, True]
    assert found.definite.values.ravel().tolist() == [False, False, True]
    assert root_locus(model, ("stiffness.hip", springs)).sizes["root"] == 4
    masses = growth_rates(model, {"bodies.two.mass": [M2, 2 * M2]})
    assert masses[0] == pytest.approx(rates[0], rel=1e-12)


def test_a_rigid_planar_body_is_stable() -> None:
    system = so.spin(two_links()).linear(lock="all")
    assert (system.coordinates, system.stable) == (("somersault",), True)
    assert (system.energy_signature, system.growth_rate) == ("definite", 0.0)
    assert system.potential.size == 0
    assert np.all(system.roots == 0)


@pytest.mark.parametrize("pose", [{}, {"hip_flexion": 1.2, "shoulder_flexion": 0.5}])
def test_in_its_plane_of_symmetry_a_body_has_the_somersault_of_space(pose: Any) -> None:
    """What moves symmetrically in space is all that moves in the plane."""
    springs = {"hip_flexion": 1.5, "shoulder_flexion": 0.7, "elbow": 0.4}
    dampers = {"hip_flexion": 0.2}
    kept = [*springs]
    planar, space = (so.spin(so.load("gymnast", base=base), 2, pose) for base in ("planar", "free"))
    others = [j.name for j in planar.model.joints if not any(name in j.name for name in kept)]
    one = planar.linear(springs, dampers, others)
    other = space.linear(springs, dampers, others).subsystem("somersault")
    assert one.subsystem("somersault").coordinates == other.coordinates
    for name in ("M", "G", "D", "K", "K_springs"):
        found = getattr(one.subsystem("somersault"), name)
        np.testing.assert_allclose(found, getattr(other, name), rtol=0, atol=1e-12, err_msg=name)
    if not pose:
        assert planar.holding_torques == pytest.approx(dict(space.holding_torques), abs=1e-12)
    torques = holding_torques(planar.model, planar.pose[None], compiled=False)[1]
    np.testing.assert_allclose(torques[0], list(planar.holding_torques.values()), atol=1e-14)


@pytest.mark.parametrize("plane", [1, 2, 3])
@pytest.mark.parametrize("seed", range(3))
def test_small_deviations_fly_as_the_linear_equations_say(seed: int, plane: int) -> None:
    model = random_chain(np.random.default_rng([seed, plane, 9]), plane, bodies=3)
    spin = so.spin(model)
    stiffness = {joint.name: 2.0 for joint in model.joints}
    damping = {joint.name: 0.2 for joint in model.joints}
    system = spin.linear(stiffness, damping)
    moved = {joint.name: SMALL * (k + 1) for k, joint in enumerate(model.joints)}
    turn = 1.2  # rad of the spin
    flight = so.deviated_flight(
        spin, RATE, turn / RATE, somersault=2 * SMALL, joints=moved,
        stiffness=stiffness, damping=damping, accuracy=1e-12,
    )  # fmt: skip
    n = len(system.M)
    inverse = np.linalg.inv(system.M)
    flow = np.block(
        [
            [np.zeros((n, n)), np.eye(n)],
            [-inverse @ (system.K + system.K_springs), -inverse @ (system.G + system.D)],
        ]
    )
    x = np.array([moved.get(name, 2 * SMALL) for name in system.coordinates])
    about = system.attitude.about
    assert system.attitude.places() == [about]
    rates = np.zeros(n)  # which keep the angular momentum: M_a ẋ + G_a x = 0
    rates[about] = -(system.G[about] @ x) / system.M[about, about]
    end = dict(
        zip(system.coordinates, (expm(flow * turn) @ np.concatenate([x, rates]))[:n], strict=True)
    )
    largest = max(abs(value) for value in end.values())
    found = flight.landing.somersault - turn
    assert found == pytest.approx(end["somersault"], abs=1e-4 * largest)
    for joint in model.joints:
        at = float(spin.pose[model.coordinate_slice(joint.name)][0])
        own = flight.landing.joints[joint.name] - at
        assert own == pytest.approx(end[joint.name], abs=1e-4 * largest)


def test_deviations_out_of_the_plane_are_refused() -> None:
    spin = so.spin(two_links())
    with pytest.raises(so.SomersaultError, match=r"tilt is 0\.01, but links moves only in the"):
        so.deviated_flight(spin, RATE, 1.0, tilt=0.01)


@pytest.mark.parametrize("axis", ["major", 1, "3"])
def test_a_planar_model_spins_about_its_normal_alone(axis: Any) -> None:
    with pytest.raises(so.SomersaultError, match="spins about no other; leave axis"):
        so.spin(two_links(), axis)
    with pytest.raises(so.SomersaultError, match="spins about no other; leave axis"):
        growth_rates(two_links(), axis=axis)


def test_inertias_are_about_the_base_axes() -> None:
    model = two_links(1)
    assert principal_inertias(model)[0] == pytest.approx(so.spin(model).principal_inertias[0])


def test_the_shell_judges_planar_spins(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    text = (
        "version 4\nsegment One\ntranslations yz\nrotations x\nmass 7\ncom 0 0 0\n"
        "inertia 0.5 0 0 0 0 0 0 0 0\nendsegment\nsegment Two\nparent One\nrtinmatrix 0\n"
        "rt 0 0 0 xyz 0 0 0.3\nrotations x\nmass 3\ncom 0 0 0.4\n"
        "inertia 0.2 0 0 0 0 0 0 0 0\nendsegment\n"
    )
    path = tmp_path / "links.bioMod"
    path.write_text(text)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        assert cli.main(["stability", str(path), "--json"]) == 0
        record = json.loads(capsys.readouterr().out)
        assert cli.main(["stability", str(path)]) == 0
        page = capsys.readouterr().out
        assert cli.main(["stability", str(path), "--axis", "2"]) == 2
        assert cli.main(["map", str(path)]) == 2
    assert (record["axis"], record["stable"]) == ("1", True)
    assert record["coordinates"] == ["somersault", "Two_RotX"]
    assert record["inertia_ratios"] == {"k1": None, "k3": None}
    frequency = max(imaginary for _, imaginary in record["roots"])
    assert frequency == pytest.approx(np.sqrt(frequency_squared()), rel=1e-12)
    assert "spinning about its axis 1, across its plane: stable" in page
    assert "k1" not in page
