"""Spins and their stability, by what physics says of them whatever the numbers are."""

from __future__ import annotations

from collections import Counter
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from scipy.optimize import linear_sum_assignment
from trees import random_rotation, random_tree

from somersault import SomersaultError
from somersault.model import Body, Joint, Model, as_matrix, as_vector, load
from somersault.stability import (
    Spin,
    chart,
    growth_rates,
    root_locus,
    spin,
    stable_ranges,
)

RANKS = ("minor", "intermediate", "major")
TURNS = ("tilt", "somersault", "twist")
GROWS = 1e-6  # what counts as growth, in units of the spin rate


@cache
def tree(number: int) -> Spin:
    """A random body of two to four parts with hinges and slides, in some pose."""
    rng = np.random.default_rng([7, number])
    model = random_tree(rng, 2 + number % 3, True, ("hinge", "slide"))
    sizes = {joint.name: 0.2 if joint.kind == "slide" else 1.0 for joint in model.joints}
    pose = {j.name: j.reference + sizes[j.name] * rng.normal() for j in model.joints}
    return spin(model, RANKS[number % 3], pose)


def pose_of(spun: Spin) -> dict[str, float]:
    return dict(zip(spun.model.coordinates, spun.pose.tolist(), strict=True))


def numbers(spun: Spin, low: float, high: float, seed: int = 0) -> dict[str, float]:
    """A number for each joint, as springs and dampers take them."""
    rng = np.random.default_rng(seed)
    return {joint.name: rng.uniform(low, high) for joint in spun.model.joints}


def roots_of(m: np.ndarray, c: np.ndarray, k: np.ndarray) -> np.ndarray:
    n = len(m)
    below = -np.linalg.solve(m, np.hstack([k, c]))
    return np.linalg.eigvals(np.vstack([np.hstack([np.zeros((n, n)), np.eye(n)]), below]))


def assert_same_roots(one: np.ndarray, other: np.ndarray, tolerance: float = 1e-8) -> None:
    """The same set in any order; the double zero, which rounding splits, more roughly."""
    assert len(one) == len(other)
    gap = np.abs(one[:, None] - other[None, :])
    allowed = np.where(np.abs(one) < 1e-5, 1e-5, tolerance * (1 + np.abs(one).max()))
    assert np.all(gap[linear_sum_assignment(gap)] < allowed)


# -------------------------------------------------------------------- energy and damping


def springs(number: int) -> list[dict[str, float]]:
    """Soft, middling and stiff springs for the joints of a tree, some of them negative."""
    ranges = [(-1, 1), (0, 2), (1, 4), (3, 30), (20, 90)]
    return [numbers(tree(number), *r, seed=number + s) for s in range(4) for r in ranges]


@pytest.mark.parametrize("number", range(12))
def test_damping_destroys_what_is_gyroscopic_and_only_that(number: int) -> None:
    """Thomson, Tait and Chetaev, and the parity of negative directions of the energy."""
    spun = tree(number)
    damping = numbers(spun, 0.05, 0.2, number)
    for stiffness in springs(number):
        system = spun.linear(stiffness)
        damped = spun.linear(stiffness, damping)
        negative = int(np.sum(system.potential < 0))
        assert damped.energy_signature == system.energy_signature
        if system.energy_signature == "definite":
            assert negative == 0
            assert system.stable
            assert damped.stable
        elif system.energy_signature == "gyroscopic":
            assert negative > 0
            assert negative % 2 == 0
            assert system.stable
            assert damped.growth_rate > 1e-9
        else:
            assert not system.stable
            assert damped.growth_rate > 1e-9
        if negative % 2:
            assert system.energy_signature == "unstable"
            assert np.any((np.abs(system.roots.imag) < 1e-9) & (system.roots.real > GROWS))


def test_the_trees_are_of_all_three_sorts() -> None:
    found = Counter(
        (tree(n).linear(stiffness).energy_signature) for n in range(12) for stiffness in springs(n)
    )
    assert min(found[name] for name in ("definite", "gyroscopic", "unstable")) > 10


def test_modes_of_negative_energy_are_those_that_damping_feeds() -> None:
    """Each oscillation's signature says which way a small damper moves its root."""
    fed = 0
    for number in range(12):
        spun = tree(number)
        for stiffness in springs(number):
            system = spun.linear(stiffness)
            if system.energy_signature != "gyroscopic":
                continue
            after = spun.linear(stiffness, dict.fromkeys(stiffness, 1e-5)).roots
            for mode in system.modes:
                gaps = np.sort(np.abs(system.roots - mode.root))
                moved = after[np.argmin(np.abs(after - mode.root))] - mode.root
                if mode.energy and gaps[1] > 1e-2 and abs(moved.real) > 1e-11:
                    assert np.sign(moved.real) == -mode.energy
                    fed += mode.energy < 0
    assert fed > 20


# ------------------------------------------------------------------- limits and invariance


@pytest.mark.parametrize("number", [0, 1, 4, 8])
def test_a_locked_joint_is_a_very_stiff_spring(number: int) -> None:
    spun = tree(number)
    joints = [joint.name for joint in spun.model.joints]
    for names in ([joints[-1]], joints):
        free = numbers(spun, 0, 2)
        locked = spun.linear({n: free[n] for n in joints if n not in names}, lock=names)
        count = len(locked.roots)
        gaps = []
        for stiffness in (1e5, 1e7):
            roots = spun.linear({**free, **dict.fromkeys(names, stiffness)}).roots
            slow = roots[np.argsort(np.abs(roots))][:count]
            gap = np.abs(slow[:, None] - locked.roots[None, :])
            far = gap[linear_sum_assignment(gap)]
            gaps.append(far[np.abs(slow) > 1e-4].max())
        assert gaps[1] < 1e-4
        assert gaps[1] < 0.1 * gaps[0] + 1e-8
    root = np.emath.sqrt(-np.prod(list(spun.inertia_ratios.values())))
    assert_same_roots(spun.linear(lock="all").roots, np.array([1j, -1j, root, -root, 0, 0]))


def scaled(model: Model, mass: float, length: float) -> Model:
    """Every mass times one number, every length times another."""

    def of_body(body: Body) -> Body:
        turning = mass * length**2
        joints = tuple(
            replace(
                joint,
                anchor=as_vector(np.array(joint.anchor) * length),
                reference=joint.reference * (length if joint.kind == "slide" else 1),
                armature=joint.armature * (mass if joint.kind == "slide" else turning),
            )
            for joint in body.joints
        )
        return replace(
            body,
            mass=body.mass * mass,
            com=as_vector(np.array(body.com) * length),
            inertia=as_matrix(np.array(body.inertia) * turning),
            position=as_vector(np.array(body.position) * length),
            joints=joints,
        )

    return replace(model, bodies=tuple(map(of_body, model.bodies)))


@pytest.mark.parametrize(("mass", "length"), [(7.0, 1.0), (1.0, 0.3), (0.02, 5.0)])
def test_roots_do_not_depend_on_the_units(mass: float, length: float) -> None:
    for number in (0, 3, 7):
        spun = tree(number)
        pose = pose_of(spun)
        for joint in spun.model.joints:
            pose[joint.name] *= length if joint.kind == "slide" else 1
        other = spin(scaled(spun.model, mass, length), spun.axis, pose)
        stiffness, damping = numbers(spun, -1, 3), numbers(spun, 0, 1)
        one, two = (s.linear(stiffness, damping) for s in (spun, other))
        assert_same_roots(one.roots, two.roots)
        assert one.growth_rate == pytest.approx(two.growth_rate, abs=1e-8)


def turned(model: Model, turn: np.ndarray) -> Model:
    """The same body with another choice of axes for its base."""

    def out(vector: tuple[float, float, float]) -> tuple[float, float, float]:
        return as_vector(turn @ np.array(vector))

    def of_body(body: Body) -> Body:
        if body.parent < 0:
            inertia = as_matrix(turn @ np.array(body.inertia) @ turn.T)
            return replace(body, com=out(body.com), inertia=inertia)
        if body.parent > 0:
            return body
        rotation = as_matrix(turn @ np.array(body.rotation))
        return replace(body, position=out(body.position), rotation=rotation)

    return replace(model, bodies=tuple(map(of_body, model.bodies)))


@pytest.mark.parametrize("number", [0, 1, 2, 5])
def test_roots_do_not_depend_on_the_base_axes(number: int) -> None:
    spun, axis = tree(number), RANKS[number % 3]
    turn = random_rotation(np.random.default_rng(number))
    other = spin(turned(spun.model, turn), axis, pose_of(spun))
    stiffness, damping = numbers(spun, -1, 3), numbers(spun, 0, 1)
    one, two = (s.linear(stiffness, damping) for s in (spun, other))
    assert_same_roots(one.roots, two.roots)
    np.testing.assert_allclose(one.potential, two.potential, atol=1e-8 * one.potential.max())
    assert dict(spun.holding_torques) == pytest.approx(dict(other.holding_torques), abs=1e-8)
    assert np.sort(spun.principal_inertias) == pytest.approx(np.sort(other.principal_inertias))


def test_mirrored_coordinates_change_no_root() -> None:
    """Against the left and right joints themselves, and against a body that is no mirror image."""
    spun = spin("furrer", 2, {"shoulder": 1.3})
    springs_ = np.diag([0, 0, 0, *np.array(list(spun.outboard_inertias.values()))])
    for stiffness, damping in ((1.2, 0.0), (0.3, 0.4), (-1.0, 0.0)):
        system = spun.linear({"shoulder": stiffness}, {"shoulder": damping})
        rate = spun.gyric_matrix + damping * springs_
        own = spun.stiffness_matrix + stiffness * springs_
        assert_same_roots(system.roots, roots_of(spun.mass_matrix, rate, own), 1e-7)
    body, left, right = load("furrer").bodies
    lame = Model("lame", True, (body, left, replace(right, mass=right.mass * (1 + 1e-5))))
    pose = {"left_shoulder": 1.3, "right_shoulder": -1.3}
    both = dict.fromkeys(pose, 0.4)
    other = spin(lame, 2, pose).linear(both)
    assert set(other.coordinates) == {*TURNS, *pose}
    assert_same_roots(spun.linear(both).roots, other.roots, 1e-4)


@pytest.mark.parametrize("number", range(6))
def test_undamped_roots_are_symmetric(number: int) -> None:
    roots = tree(number).linear(numbers(tree(number), -1, 3)).roots
    for mirrored in (-roots, roots.conj(), -roots.conj()):
        assert_same_roots(roots, mirrored)


def test_the_system_is_a_conservative_gyric_one() -> None:
    """Section 2.3.1: M = Mᵀ > 0, G = −Gᵀ, K = Kᵀ, D ≥ 0 and of the joints alone."""
    for number in range(6):
        spun = tree(number)
        system = spun.linear(numbers(spun, -1, 3), numbers(spun, 0, 1))
        size = np.abs(system.M).max() * 1e-9
        np.testing.assert_allclose(system.M, system.M.T, atol=size)
        np.testing.assert_allclose(system.G, -system.G.T, atol=size)
        np.testing.assert_allclose(system.K, system.K.T, atol=size)
        assert np.linalg.eigvalsh(system.M).min() > 0
        turns = [system.coordinates.index(turn) for turn in TURNS]
        assert not system.D[turns].any()
        assert not system.K_springs[:, turns].any()


# ------------------------------------------------------------ many at once, parts, and modes


def test_a_chart_is_what_single_spins_say() -> None:
    stiffness, angles = np.linspace(-1, 3, 9), np.linspace(0, 3, 7)
    x, y = ("stiffness.shoulder", stiffness), ("pose.shoulder", angles)
    for damping, rank in ((0.0, 2), (0.3, 2), (0.0, "major")):
        fixed = {"damping.shoulder": damping}
        found = chart("furrer", x, y, fixed=fixed, axis=rank, energy=True)
        assert found.growth_rate.dims == ("pose.shoulder", "stiffness.shoulder")
        for angle, row in zip(angles, found.growth_rate.values, strict=True):
            spun = spin("furrer", rank, {"shoulder": angle})
            for k, rate in zip(stiffness, row, strict=True):
                system = spun.linear({"shoulder": k}, {"shoulder": damping})
                at = found.sel({"pose.shoulder": angle, "stiffness.shoulder": k})
                assert rate == pytest.approx(system.growth_rate, abs=1e-7)
                assert bool(at.stable) == system.stable
                assert bool(at.definite) == (system.energy_signature == "definite")


def test_one_spelling_for_one_spring_wherever_a_joint_is_named() -> None:
    """Pairs and sides, in full names and by joint: the same rates, charts, loci and ranges."""
    sides = {"left_shoulder": 1.3, "right_shoulder": -1.3}
    springs, dampers = dict.fromkeys(sides, 1.2), dict.fromkeys(sides, 0.1)
    spellings = [
        {"pose": {"shoulder": 1.3}, "stiffness": {"shoulder": 1.2}, "damping": {"shoulder": 0.1}},
        {"pose": sides, "stiffness": springs, "damping": dampers},
    ]
    one, other = (growth_rates("furrer", **how) for how in spellings)
    named = {"pose.shoulder": 1.3, "stiffness.shoulder": 1.2, "damping.shoulder": 0.1}
    single = spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": 1.2}, {"shoulder": 0.1})
    for rate in (other, growth_rates("furrer", named), single.growth_rate):
        assert float(rate) == pytest.approx(float(one), abs=1e-12)
    masses, along = ("bodies.body.mass", [58.3, 60.0]), ("bodies.body.com.3", [0.0, 0.1])
    charts = [chart("furrer", masses, along, **how) for how in spellings]
    charts.append(chart("furrer", masses, along, fixed=named))
    loci = [root_locus("furrer", masses, **how) for how in spellings]
    loci.append(root_locus("furrer", masses, fixed=named))
    for k in (1, 2):
        np.testing.assert_allclose(charts[0].growth_rate, charts[k].growth_rate, atol=1e-9)
        np.testing.assert_allclose(loci[0].growth, loci[k].growth, atol=1e-7)
    locked = [growth_rates("furrer", lock=how) for how in ("all", "shoulder", ["shoulder"], sides)]
    assert np.ptp(locked) < 1e-12


@pytest.mark.parametrize("axis", RANKS)
def test_a_chart_knows_that_a_rigid_maximum_is_definite(axis: str) -> None:
    quantities = ("bodies.body.mass", [58.3]), ("pose.shoulder", [1.0])
    found = chart("furrer", *quantities, axis=axis, lock="all", energy=True)
    signature = spin("furrer", axis, {"shoulder": 1.0}).linear(lock="all").energy_signature
    assert bool(found.definite) == (signature == "definite")


def test_a_chart_over_the_body_is_what_other_bodies_do() -> None:
    body, *arms = load("furrer").bodies
    lengths, masses = [0.3, 0.5], [40.0, 58.3]
    quantities = ("bodies.body.com.3", lengths), ("bodies.body.mass", masses)
    fixed = {"pose.shoulder": 1.3, "stiffness.shoulder": 1.2}
    found = chart("furrer", *quantities, fixed=fixed)
    for length in lengths:
        for mass in masses:
            denser = np.array(body.inertia) * mass / body.mass  # of the same shape
            inertia = tuple(map(tuple, denser.tolist()))
            other = replace(body, mass=mass, com=(0.0, 0.0, length), inertia=inertia)
            spun = spin(Model("other", True, (other, *arms)), 2, {"shoulder": 1.3})
            at = {"bodies.body.com.3": length, "bodies.body.mass": mass}
            rate = float(found.growth_rate.sel(at))
            assert rate == pytest.approx(spun.linear({"shoulder": 1.2}).growth_rate, abs=1e-7)


def test_stable_ranges_end_where_stability_does() -> None:
    spun = spin("furrer", 2, {"shoulder": 1.3})
    along = ("stiffness.shoulder", -2.0, 4.0)
    ((low, high),) = stable_ranges("furrer", along, fixed={"pose.shoulder": 1.3})
    for edge, inward in ((low, 1e-6), (high, -1e-6)):
        assert spun.linear({"shoulder": edge + inward}).stable
        assert not spun.linear({"shoulder": edge - inward}).stable


def test_a_root_locus_is_the_roots_one_after_the_other() -> None:
    spun, stiffness = tree(4), np.linspace(-2, 4, 7)
    first, *_, last = spun.model.joints
    fixed = {f"pose.{name}": value for name, value in pose_of(spun).items()}
    fixed |= {f"damping.{first.name}": 0.3}
    along = (f"stiffness.{last.name}", stiffness)
    locus = root_locus(spun.model, along, fixed=fixed, axis=spun.axis)
    for row, k in enumerate(stiffness):
        roots = locus.growth.values[row] + 1j * locus.frequency.values[row]
        assert_same_roots(spun.linear({last.name: k}, {first.name: 0.3}).roots, roots, 1e-7)


def test_the_parts_are_the_whole() -> None:
    system = spin("furrer", 2, {"shoulder": 1.3}).linear({"shoulder": 1.2})
    parts = [system.subsystem(group[0]) for group in system.subsystems]
    assert sorted(sum((p.coordinates for p in parts), ())) == sorted(system.coordinates)
    assert_same_roots(system.roots, np.concatenate([part.roots for part in parts]))
    assert system.growth_rate == pytest.approx(max(p.growth_rate for p in parts), abs=1e-8)
    potentials = np.sort(np.concatenate([part.potential for part in parts]))
    np.testing.assert_allclose(system.potential, potentials, atol=1e-9)


def test_the_turn_about_the_axis_alone_is_a_part_too() -> None:
    part = spin("furrer", 2).linear(lock="all").subsystem("somersault")
    assert part.stable
    assert part.energy_signature == "definite"
    assert "stable" in repr(part)


@pytest.mark.parametrize("number", range(6))
def test_modes(number: int) -> None:
    """One for each root with Im ≥ 0, each a motion of the equations, the known two among them."""
    system = tree(number).linear(numbers(tree(number), -1, 3), numbers(tree(number), 0, 0.2))
    modes = {mode.name: mode for mode in system.modes}
    still = [i for i, name in enumerate(system.coordinates) if name not in TURNS]
    about = TURNS[system.spin.axis - 1]
    roots = system.roots[np.argsort(np.abs(system.roots))][2:]
    assert len(system.modes) == 1 + int(np.sum(roots.imag > -1e-9))
    assert modes[f"{about} drift"].root == 0
    assert modes["stroboscopic"].root == pytest.approx(1j, abs=1e-8)
    assert np.abs(modes["stroboscopic"].shape[still]).max() < 1e-8
    for mode in system.modes:
        s, left = mode.root, (system.M, system.G + system.D, system.K + system.K_springs)
        force = (left[0] * s**2 + left[1] * s + left[2]) @ mode.shape
        assert np.abs(force).max() < 1e-7 * sum(np.abs(a).max() for a in left) * (1 + abs(s)) ** 2


def test_an_axis_by_name_or_by_number() -> None:
    for name, number in (("minor", 3), ("intermediate", 2), ("major", 1)):
        by_name, by_number, by_text = (spin("furrer", a) for a in (name, number, str(number)))
        assert by_name.axis == by_number.axis == by_text.axis == number
        assert np.array_equal(by_name.linear().roots, by_number.linear().roots)


# -------------------------------------------------------------------------------- mistakes

SHOULDERS = "left_shoulder, right_shoulder"
MISTAKES = {
    "'sideways'": lambda: spin("furrer", "sideways"),
    f"'elbow'; its joints are {SHOULDERS}": lambda: spin("furrer", 2, {"elbow": 1.0}),
    "left_shoulder=4 ": lambda: spin("furrer", 2, {"shoulder": 4.0}),
    "pose shoulder is nan": lambda: spin("furrer", 2, {"shoulder": np.nan}),
    "one pose": lambda: spin("furrer", 2, {"shoulder": [1.0, 2.0]}),
    "'knee'": lambda: spin("furrer").linear({"knee": 1.0}),
    "'neck'": lambda: spin("furrer").linear(damping={"neck": 1.0}),
    "'toe'": lambda: spin("furrer").linear(lock=["toe"]),
    "stiffness of left_shoulder": lambda: spin("furrer").linear({"shoulder": np.inf}),
    "rate of 0": lambda: spin("furrer").linear(rate=0.0),
    "spin rate is nan": lambda: spin("furrer").linear(rate=np.nan),
    "'roll'; there are tilt": lambda: spin("furrer").linear().subsystem("roll"),
    "pose.shoulder against itself": lambda: chart("furrer", *[("pose.shoulder", [1.0])] * 2),
    "'poise.x'": lambda: chart("furrer", ("poise.x", [1.0]), ("pose.shoulder", [1.0])),
    "bodies.elbow.mass": lambda: chart(
        "furrer", ("bodies.elbow.mass", [1.0]), ("pose.shoulder", [1.0])
    ),
    "pose.shoulder (3,), stiffness.shoulder (4,)": lambda: growth_rates(
        "furrer", {"pose.shoulder": np.zeros(3), "stiffness.shoulder": np.zeros(4)}
    ),
    "stiffness of shoulder is given twice": lambda: growth_rates(
        "furrer", {"stiffness.shoulder": 1.0}, stiffness={"shoulder": 1.0}
    ),
    "left_shoulder is given twice": lambda: growth_rates(
        "furrer", pose={"shoulder": 1.0, "left_shoulder": 1.0}
    ),
    "give one number": lambda: spin("furrer").linear({"shoulder": [1.0, 2.0]}),
    "no coordinate 'yaw'": lambda: root_locus("furrer", ("pose.shoulder", [1]), subsystem="yaw"),
    "stable ranges of pose.shoulder": lambda: stable_ranges(
        "furrer", ("pose.shoulder", 0.0, np.nan)
    ),
    "fixed base": lambda: spin(
        Model("post", False, (replace(load("simplest").bodies[1], parent=-1),))
    ),
}


@pytest.mark.parametrize("told", MISTAKES)
def test_mistakes_are_told_in_one_sentence(told: str) -> None:
    with pytest.raises(SomersaultError) as caught:
        MISTAKES[told]()
    assert told in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("angle", np.linspace(0.6, 2.3, 18))
def test_modes_keep_to_their_subsystem_and_count_negative_energies(angle: float) -> None:
    """Each mode of negative energy accounts for two negative directions of the energy."""
    steady = spin("furrer", 2, {"shoulder": angle})
    for stiffness in (0.3, 0.9, 1.2, 3.0):
        system = steady.linear({"shoulder": stiffness})
        assert len(system.subsystems) == 2
        for mode in system.modes:
            taking = {c for c, x in zip(system.coordinates, mode.shape, strict=True) if x != 0}
            assert any(taking <= set(group) for group in system.subsystems)
        if system.stable:
            negative = sum(mode.energy < 0 for mode in system.modes)
            assert int((system.potential < 0).sum()) == 2 * negative


def test_neutral_spins_are_called_neutral() -> None:
    """A sphere: nothing restores a displaced axis, and nothing drives it away."""
    round_ = tuple(tuple(0.4 * (i == j) for j in range(3)) for i in range(3))
    sphere = Model("sphere", True, (Body("ball", -1, 1.0, (0.0, 0.0, 0.0), round_),))
    system = spin(sphere).linear()
    assert system.stable
    assert system.energy_signature == "neutral"


def test_rounding_leaves_no_dust() -> None:
    system = spin("furrer", 2, {"shoulder": 1.3}).linear({"shoulder": 1.2})
    for matrix in (system.M, system.G, system.K, system.K_springs):
        entries = np.abs(matrix[matrix != 0])
        assert entries.min() > 1e-6


def test_large_models_need_no_compiling() -> None:
    """One spin of a chain of twenty oblique hinges is a matter of a second, not of minutes."""
    rng = np.random.default_rng(1)
    eye = tuple(tuple(0.01 * (i == j) for j in range(3)) for i in range(3))
    bodies = [Body("base", -1, 5.0, (0.0, 0.0, 0.0), ((0.2, 0, 0), (0, 0.3, 0), (0, 0, 0.4)))]
    for k in range(20):
        axis = rng.normal(size=3)
        joint = Joint(f"j{k}", "hinge", tuple((axis / np.linalg.norm(axis)).tolist()))
        bodies.append(Body(f"b{k}", k, 0.5, (0.0, 0.0, 0.1), eye, (0.0, 0.0, 0.2), joints=(joint,)))
    system = spin(Model("chain", True, tuple(bodies)), "major").linear(lock=["j0", "j7"])
    assert len(system.roots) == 2 * (3 + 18)
