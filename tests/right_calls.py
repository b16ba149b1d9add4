"""For each public function, class and method a call that works, for tests to change.

A value is checked where it is used: what a `Takeoff`, a `Body` or a `Vary` was given is called
together with what uses it.
"""

from __future__ import annotations

import subprocess
from collections.abc import Callable, Mapping
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import tomli_w
from matplotlib.figure import Figure

import somersault as so
from somersault import (
    attitude,
    designs,
    ensembles,
    flight,
    ground,
    laws,
    model,
    motion,
    planning,
    rigid,
    robot,
    spec,
    thesis,
    view,
)
from somersault import dynamics as dy
from somersault import stability as st

Call = Callable[..., Any]
Right = Mapping[str, Any]
THREE, FOUR, EYE = [1.0, 2.0, 2.5], [1.0, 0.0, 0.0, 0.0], np.eye(3)
POSE = {"shoulder": 1.3}
MOVES = {"left_shoulder": [(0.0, 1.4), (0.1, 0.2)]}
TIMES = np.linspace(0.0, 0.5, 51)
INERTIA = ((1.0, 0.0, 0.0), (0.0, 1.1, 0.0), (0.0, 0.0, 1.2))
TAKEOFF = so.Takeoff(spin=5.0)


# --------------------------------------------------------------------- what calls are made of


@cache
def furrer() -> so.Model:
    return so.load("furrer")


@cache
def fallen() -> so.Flight:
    """A gymnast seen from the side who comes down on the feet."""
    bent = {"shoulder_flexion": 1.4, "hip_flexion": 0.5, "knee": 0.6, "ankle": 1.87}
    joints = {name: so.JointTakeoff.locked(angle=x) for name, x in bent.items()}
    takeoff = so.Takeoff(somersault=0.2, position=(0.0, 0.0, 1.1), joints=joints)
    body = so.sagittal(so.athlete(1.67, 64, knees=True, ankles=True))
    return so.fly(body, takeoff, 0.3, gravity=(0.0, 0.0, -9.81))


def _landed_with(part: str, kind: Call) -> Call:
    def landed(**given: Any) -> ground.Stance:
        who = ground.Gymnast(fallen().model, **{part: kind(**given)})
        return ground.land(fallen(), gymnast=who, duration=0.02)

    return landed


def fed() -> st.DelayedFeedback:
    return st.feedback(spun().linear(), "antisymmetric shoulder", "rate", {"twist": -1.0})


@cache
def gymnast() -> so.Model:
    return so.load("gymnast")


def pem() -> str:
    """A file with a certificate and its key."""
    subprocess.run(
        ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=me", "-keyout",
         "key.pem", "-out", "cert.pem"],
        check=True, capture_output=True,
    )  # fmt: skip
    both = Path("key.pem").read_text() + Path("cert.pem").read_text()
    Path("both.pem").write_text(both)
    return "both.pem"


@cache
def spun() -> so.Spin:
    return so.spin("furrer", pose=POSE)


@cache
def tumble() -> rigid.RigidMotion:
    return rigid.RigidMotion(THREE, [0.1, 1.0, 0.2])


@cache
def equations() -> so.Equations:
    return so.Equations("furrer")


@cache
def maneuver() -> so.Maneuver:
    return so.Maneuver.moves("furrer", MOVES, TAKEOFF, 0.1)


@cache
def flown() -> so.Flight:
    return so.fly("furrer", TAKEOFF, 0.6, samples=3, gravity=(0.0, 0.0, -9.81))


@cache
def arms() -> so.Motion:
    return so.Motion.moves("furrer", MOVES)


@cache
def mount() -> so.Mount:
    bar = so.Body(
        "bar", -1, 0.0, (0.0,) * 3, ((0.0,) * 3,) * 3, joints=(so.Joint("bar", "hinge", (0, 1, 0)),)
    )
    return so.mounted(furrer(), bar, (0.0, 0.0, 1.0))


@cache
def swung() -> so.Swing:
    return so.swing(mount().held, {"bar": 1.0}, 0.1, samples=3)


@cache
def scattered() -> so.Ensemble:
    return so.ensemble("furrer", TAKEOFF, 0.1, {"lean": NORMAL}, size=64, against={"tilt": 0.0})


@cache
def drawn() -> so.Ensemble:
    vary = {"lean": NORMAL, "turn": so.Vary(adds_to="takeoff.twist", normal=(0.0, 0.1))}
    return so.ensemble(
        "furrer", TAKEOFF, 0.1, vary, size=256, sequence="saltelli", against={"tilt": 0.0}
    )


@cache
def planned() -> ensembles.Plan:
    return ensembles.plan(flight.flights("furrer", TAKEOFF, 0.1), {"lean": NORMAL}, 4)


@cache
def raised() -> planning.Plan:
    return so.plan(**PLAN)


@cache
def resonant() -> so.LinearSpin:
    return so.spin("furrer", pose={"shoulder": 1.3}).linear({"shoulder": 1.16})


@cache
def two_to_one() -> st.Resonance:
    return resonant().resonances(order=3)[0]


@cache
def bursting() -> st.Burst:
    return st.burst(resonant(), two_to_one())


@cache
def charted() -> Any:
    return st.chart(**CHART)


@cache
def locus() -> Any:
    return st.root_locus(**LOCUS)


PLANNED = {"model": "furrer", "plan": {"torque": 60.0, "twists": 0, "nodes": 4, "starts": 1}}
PLAN = {
    "model": "furrer",
    "somersaults": 1,
    "twists": 0,
    "torque": 60.0,
    "duration": (0.5, 1.5),
    "joints": {"shoulder": (0.2, 2.8)},
    "start": {"shoulder": 2.8},
    "end": {},
    "rest_at_end": False,
    "takeoff": {"spin": (2.0, 9.0)},
    "landing": {"tilt": 0.0},
    "aloft": {"tilt": (-1.0, 1.0)},
    "fastest": None,
    "effort": 0.01,
    "nodes": 6,
    "starts": 1,
    "seed": 0,
    "processes": 1,
}
NORMAL = so.Vary(adds_to="takeoff.tilt", normal=(0.0, 0.1))
CHART = {
    "model": "furrer",
    "x": ("pose.shoulder", [0.5, 1.0]),
    "y": ("stiffness.shoulder", [0.0, 1.0]),
    "damping": {"shoulder": 0.1},
    "fixed": {"bodies.body.mass": 60.0},
    "axis": 2,
    "lock": (),
    "subsystem": "tilt",
    "energy": True,
    "resonances": 3,
}
RANGES = {
    "model": "furrer",
    "along": ("stiffness.shoulder", -2, 4),
    "pose": POSE,
    "axis": 2,
    "lock": (),
    "subsystem": "tilt",
    "samples": 5,
}
LOCUS = {k: v for k, v in RANGES.items() if k != "samples"} | {
    "along": ("stiffness.shoulder", [0.0, 1.0]),
    "fixed": {},
}
LOOK = {"size": (64, 64)}
GOAL = designs.Mean("twist", counts_as=3.2)
DESIGN = {
    "choose": {"spin": {"sets": "takeoff.spin", "between": [4.0, 6.0]}},
    "vary": {"leant": {"adds_to": "takeoff.tilt", "normal": [0.0, 0.1]}},
    "sample": {"size": 2},
    "objective": {"kind": "mean", "quantity": "twist", "counts_as": 3.2},
    "search": {"evaluations": 4, "held_out": 2},
}
SPEC = {"model": "furrer", "duration": 0.1, "takeoff": {"spin": 5.0}}


def files() -> None:
    """Write the files that right calls read to the folder in which they are called."""
    from fuzz import good

    names = {"arms.csv": good.csv, "hip.csv": good.column, "body.txt": good.measurements}
    for name, folders in names.items():
        Path(name).write_bytes(next(iter(folders()[0].values())) or b"")
    Path("main.toml").write_text(
        'model = "furrer"\nduration = 0.1\n[takeoff]\nspin = 5.0\n', encoding="utf-8"
    )
    Path("planned.toml").write_text(tomli_w.dumps(PLANNED), encoding="utf-8")
    Path("design.toml").write_text(tomli_w.dumps({**SPEC, **DESIGN}), encoding="utf-8")
    Path("run.toml").write_text('robot = "biped"\n', encoding="utf-8")
    flown().save("recorded.nc")
    scattered().dataset.to_netcdf("store.nc", engine="h5netcdf")


# ------------------------------------------------------------------------- values, as they are used


def _takeoff(**given: Any) -> Any:
    return so.fly("furrer", so.Takeoff(**given), 0.02, samples=2)


def _replayed(**given: Any) -> Any:
    left = so.JointTakeoff.prescribed(times=[0.0, 0.1], angles=[1.0, 0.5])
    takeoff = so.Takeoff(spin=5.0, joints={"left_shoulder": left}, replay=so.Replay(**given))
    return so.fly("furrer", takeoff, 0.02, samples=2)


def _joint_takeoff(make: Callable[..., Any]) -> Call:
    def call(**given: Any) -> Any:
        return so.fly("furrer", so.Takeoff(spin=5.0, joints={"left_shoulder": make(**given)}), 0.02)

    return call


def _body(**given: Any) -> Any:
    arm = so.Body("arm", 0, 1.0, (0.0, 0.0, 0.1), INERTIA, joints=(so.Joint("hinge", "hinge"),))
    return repr(so.Model("thing", True, (so.Body(**given), arm)))


def _joint(**given: Any) -> Any:
    base = so.Body("base", -1, 2.0, (0.0, 0.0, 0.0), INERTIA)
    joints = (so.Joint("lead", "hinge", (0.0, 1.0, 0.0)), so.Joint(**given))
    return repr(
        so.Model(
            "thing", True, (base, so.Body("arm", 0, 1.0, (0.0, 0.0, 0.1), INERTIA, joints=joints))
        )
    )


def _follow(**given: Any) -> Any:
    return _joint(name="after", kind="hinge", follows=model.Follow(**given))


def _short() -> so.Maneuver:
    arms = {"shoulder": so.JointTakeoff.sprung(angle=1.3, K=0.5, hold=True)}
    return so.Maneuver("furrer", so.Takeoff(spin=8.64, joints=arms), 0.02)


_TWO = {
    "K": so.Choose(sets="joints.shoulder.K", between=(0.5, 1.5)),
    "arms": so.Choose(sets="joints.shoulder.angle", between=(1.2, 1.4)),
}


def _designed(**given: Any) -> Any:
    right = {
        "choose": {"K": so.Choose(sets="joints.shoulder.K", between=(0.5, 1.5))},
        "vary": {"leant": NORMAL}, "objective": GOAL,
    }  # fmt: skip
    more = {"size": 2, "evaluations": 4, "population": 4, "held_out": 2}
    return so.design(_short(), **{**right, **more, **given})


def _traded(**given: Any) -> Any:
    both = [GOAL, designs.Mean("K")]
    more = {"size": 2, "evaluations": 4, "population": 4, "held_out": 2}
    return designs.trade_off(_short(), _TWO, {"leant": NORMAL}, both, **{**more, **given})


def _vary(**given: Any) -> Any:
    vary = {"x": so.Vary(**{"sets": "takeoff.tilt", **given})}
    size = None if {"values", "samples"} & set(given) else 2
    return ensembles.plan(flight.flights("furrer", TAKEOFF, 0.02), vary, size=size).varied(0, 2)


def _report(**given: Any) -> Any:
    return flight.flights("furrer", TAKEOFF, 0.02, report=so.Report(**given)).variables


@cache
def ran() -> robot.Run:
    return robot.run("biped", 0.6)


def _table(name: str) -> Callable[[], tuple[Call, Right]]:
    """A table of a run's numbers, together with what uses it."""
    kind = getattr(robot, name)
    return lambda: (
        lambda **given: robot.Control(**{name.lower(): kind(**given)}), vars(kind()),
    )  # fmt: skip


def _runs(**given: Any) -> Any:
    return robot.Runs(robot.Robot(**given), duration=0.05).controller


def _leg(**given: Any) -> Any:
    return _runs(left=robot.Leg(**given))


def _prop(**given: Any) -> Any:
    return so.swing(
        mount().held, {"bar": 1.0}, 0.02, stops={"left_shoulder": so.Prop(**given)}, samples=2
    )


# ------------------------------------------------------------------------------------- the table

ROTATED = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
_FILM = {"fps": 30, "speed": 1.0, **LOOK}
_PICTURED = {
    "film": {"path": "film.gif", **_FILM, "beside": ()},
    "frame": {"time": 0.05, **LOOK},
    "page": {"path": "page.html", "title": "a flight"},
    "picture": {"path": "picture.png", "times": [0.0, 0.05], "columns": 2, **LOOK},
    "stroboscopic_picture": {"path": "picture.png", "times": 3, **LOOK},
}

# Of each public name a function that gives the call and its right arguments.
CALLS: dict[str, Callable[[], tuple[Call, Right]]] = {
    # --- stability
    "stability.spin": lambda: (so.spin, {"model": "furrer", "axis": 2, "pose": POSE}),
    "stability.Spin.linear": lambda: (
        spun().linear,
        {"stiffness": {"shoulder": 1.0}, "damping": {"shoulder": 0.1}, "lock": (), "rate": 1.0},
    ),
    "stability.LinearSpin.subsystem": lambda: (spun().linear().subsystem, {"coordinate": "tilt"}),
    "stability.LinearSpin.resonances": lambda: (
        spun().linear({"shoulder": 1.0}).resonances,
        {"order": 4, "within": 0.05},
    ),
    "stability.burst": lambda: (st.burst, {"spin": resonant(), "resonance": two_to_one()}),
    "stability.Burst.turns": lambda: (bursting().turns, {"amplitude": 0.01}),
    "stability.Burst.width": lambda: (bursting().width, {"amplitude": 0.01}),
    "stability.Burst.amplitude": lambda: (bursting().amplitude, {"tilt": 0.01, "twist": 0.0}),
    "stability.spins": lambda: (
        st.spins,
        {
            "model": "furrer",
            "pose": POSE,
            "stiffness": {"shoulder": 1.0},
            "damping": {"shoulder": 0.1},
            "axis": 2,
            "lock": (),
        },
    ),
    "stability.chart": lambda: (st.chart, CHART),
    "stability.growth_rates": lambda: (
        st.growth_rates,
        {
            "model": "furrer",
            "quantities": {"pose.shoulder": [1.0, 1.2]},
            "stiffness": {},
            "damping": {"shoulder": 0.1},
            "axis": 2,
            "lock": (),
            "subsystem": None,
        },
    ),
    "stability.root_locus": lambda: (st.root_locus, LOCUS),
    "stability.stable_ranges": lambda: (st.stable_ranges, RANGES),
    "stability.stable_ranges_by_case": lambda: (
        st.stable_ranges_by_case,
        RANGES | {"pose": {"shoulder": [1.0, 1.3]}},
    ),
    "stability.feedback": lambda: (
        st.feedback,
        {
            "spin": spun().linear(),
            "coordinate": "antisymmetric shoulder",
            "commands": "rate",
            "gains": {"twist": -1.0},
        },
    ),
    "stability.DelayedFeedback": lambda: (
        st.DelayedFeedback,
        {"matrix": np.eye(2), "drive": np.ones(2), "sensed": np.ones(2), "direct": 0.0},
    ),
    "stability.DelayedFeedback.roots": lambda: (fed().roots, {"delay": 0.1, "count": 3}),
    "stability.DelayedFeedback.growth_rate": lambda: (fed().growth_rate, {"delay": 0.1}),
    "stability.DelayedFeedback.stable_delays": lambda: (fed().stable_delays, {"most": 3.0}),
    # --- laws
    "laws.Formula": lambda: (laws.Formula, {"text": "k * twist"}),
    "laws.Formula.value": lambda: (
        laws.Formula("k * twist").value,
        {"known": {"k": 1.0, "twist": 0.1}},
    ),
    "laws.Formula.renamed": lambda: (
        laws.Formula("k * twist").renamed,
        {"names": {"twist": "tilt"}, "sign": -1.0},
    ),
    "stability.joint_roots": lambda: (
        st.joint_roots,
        {"model": "furrer", "pose": {}, "stiffness": {"shoulder": 1.0}, "damping": {}, "lock": ()},
    ),
    "stability.principal_inertias": lambda: (
        st.principal_inertias,
        {"model": "furrer", "pose": {}},
    ),
    "stability.principal_axes": lambda: (st.principal_axes, {"inertia": np.diag(THREE)}),
    "stability.locked_speeds": lambda: (st.locked_speeds, {"model": furrer(), "lock": "shoulder"}),
    "stability.holding_torques": lambda: (
        st.holding_torques,
        {"model": furrer(), "q": furrer().home[None], "compiled": False},
    ),
    # --- rigid
    "rigid.RigidMotion": lambda: (
        rigid.RigidMotion,
        {"inertias": THREE, "omega0": [0.1, 1.0, 0.2], "attitude0": FOUR},
    ),
    "rigid.RigidMotion.from_momentum": lambda: (
        rigid.RigidMotion.from_momentum,
        {"inertias": THREE, "momentum": 1.0, "attitude0": FOUR},
    ),
    "rigid.RigidMotion.omega": lambda: (tumble().omega, {"t": 1.0}),
    "rigid.RigidMotion.quaternion": lambda: (tumble().quaternion, {"t": 1.0}),
    "rigid.RigidMotion.angles": lambda: (tumble().angles, {"t": 1.0}),
    "rigid.RigidMotion.momentum_angles": lambda: (tumble().momentum_angles, {"t": 1.0}),
    "rigid.energy_bounds": lambda: (rigid.energy_bounds, {"inertias": THREE, "momentum": 1.0}),
    "rigid.energy_curve": lambda: (
        rigid.energy_curve,
        {"inertias": THREE, "energy": 0.3, "points": 5, "momentum": 1.0},
    ),
    "rigid.euler_rates": lambda: (rigid.euler_rates, {"inertias": THREE, "omega": THREE}),
    "rigid.growth_angle": lambda: (rigid.growth_angle, {"k1": 0.5, "k3": -0.5, "N": 10.0}),
    "rigid.gyric_matrices": lambda: (rigid.gyric_matrices, {"I1": 1.0, "I2": 2.0, "I3": 2.5}),
    "rigid.gyric_roots": lambda: (rigid.gyric_roots, {"k1": 0.5, "k3": -0.5}),
    "rigid.inertia_ratios": lambda: (rigid.inertia_ratios, {"I1": 1.0, "I2": 2.0, "I3": 2.5}),
    "rigid.inertias_from_ratios": lambda: (rigid.inertias_from_ratios, {"k1": 0.5, "k3": -0.5}),
    "rigid.kind_of_motion": lambda: (
        rigid.kind_of_motion,
        {"inertias": THREE, "omega": THREE, "tolerance": 0.0},
    ),
    "rigid.momentum_direction": lambda: (rigid.momentum_direction, {"tilt": 0.1, "twist": 0.2}),
    "rigid.quadrant": lambda: (rigid.quadrant, {"k1": 0.5, "k3": -0.5}),
    "rigid.separatrix": lambda: (rigid.separatrix, {"inertias": THREE, "points": 5}),
    "rigid.tilt_and_twist": lambda: (rigid.tilt_and_twist, {"cosines": THREE}),
    # --- attitude
    "attitude.cayley_klein": lambda: (attitude.cayley_klein, {"quaternion": [1.0, 0.0, 0.0, 0.0]}),
    "attitude.as_axes": lambda: (attitude.as_axes, {"axes": (2, 1, 3)}),
    "attitude.angle_rates": lambda: (
        attitude.angle_rates,
        {"axes": (2, 1, 3), "angles": [0.1, 0.2, 0.3], "omega": THREE},
    ),
    "attitude.body_rates": lambda: (
        attitude.body_rates,
        {"axes": (2, 1, 3), "angles": [0.1, 0.2, 0.3], "rates": THREE},
    ),
    "attitude.angles_from_matrix": lambda: (attitude.angles_from_matrix, {"cosines": EYE}),
    "attitude.angles_from_quaternion": lambda: (
        attitude.angles_from_quaternion,
        {"quaternion": FOUR, "axes": (2, 1, 3)},
    ),
    "attitude.direction_cosines": lambda: (
        attitude.direction_cosines,
        {"somersault": 0.1, "tilt": 0.2, "twist": 0.3},
    ),
    "attitude.from_sequence": lambda: (
        attitude.from_sequence,
        {"vector": THREE, "axes": (2, 1, 3)},
    ),
    "attitude.in_sequence": lambda: (attitude.in_sequence, {"vector": THREE, "axes": (2, 1, 3)}),
    "attitude.matrix_from_quaternion": lambda: (
        attitude.matrix_from_quaternion,
        {"quaternion": FOUR},
    ),
    "attitude.quaternion_conjugate": lambda: (attitude.quaternion_conjugate, {"quaternion": FOUR}),
    "attitude.quaternion_from_angles": lambda: (
        attitude.quaternion_from_angles,
        {"somersault": 0.1, "tilt": 0.2, "twist": 0.3, "axes": (2, 1, 3)},
    ),
    "attitude.quaternion_from_matrix": lambda: (attitude.quaternion_from_matrix, {"matrix": EYE}),
    "attitude.quaternion_product": lambda: (
        attitude.quaternion_product,
        {"first": FOUR, "second": FOUR},
    ),
    "attitude.unwrapped_angles": lambda: (
        attitude.unwrapped_angles,
        {"quaternions": [FOUR, FOUR], "axes": (2, 1, 3)},
    ),
    "attitude.side": lambda: (attitude.side, {"axes": (2, 1, 3)}),
    # --- model
    "model.Body": lambda: (
        _body,
        {
            "name": "base",
            "parent": -1,
            "mass": 2.0,
            "com": (0.0, 0.0, 0.0),
            "inertia": INERTIA,
            "position": (0.0, 0.0, 0.0),
            "rotation": ROTATED,
            "joints": (),
            "shapes": (),
            "inertia_from": "file",
        },
    ),
    "model.Joint": lambda: (
        _joint,
        {
            "name": "hinge",
            "kind": "hinge",
            "axis": (1.0, 0.0, 0.0),
            "anchor": (0.0, 0.0, 0.0),
            "reference": 0.0,
            "limits": (-1.0, 1.0),
            "stiffness": 0.0,
            "rest": 0.0,
            "damping": 0.0,
            "armature": 0.0,
            "follows": None,
        },
    ),
    "model.Follow": lambda: (_follow, {"leader": "lead", "factor": 1.0, "offset": 0.0}),
    "model.Model": lambda: (
        lambda **given: (repr(so.Model(**given)), so.Model(**given).home),
        {
            "name": "thing",
            "free": True,
            "bodies": furrer().bodies,
            "ignored": (),
            "axes": (2, 1, 3),
            "plane": None,
        },
    ),
    "model.Model.coordinate_slice": lambda: (furrer().coordinate_slice, {"name": "left_shoulder"}),
    "model.Model.joint": lambda: (furrer().joint, {"name": "left_shoulder"}),
    "model.Model.renamed": lambda: (furrer().renamed, {"name": "Carl"}),
    "model.Model.speed_slice": lambda: (furrer().speed_slice, {"name": "left_shoulder"}),
    "model.as_matrix": lambda: (model.as_matrix, {"array": EYE}),
    "model.as_vector": lambda: (model.as_vector, {"array": np.array(THREE)}),
    "model.athlete": lambda: (
        so.athlete,
        {
            "height": 1.7,
            "mass": 65.0,
            "sex": "male",
            "shoulders": "hinges",
            "knees": False,
            "ankles": False,
            "name": "athlete",
        },
    ),
    "model.athlete_from_measurements": lambda: (
        so.athlete_from_measurements,
        {
            "source": "body.txt",
            "mass": 70.0,
            "densities": "Dempster",
            "shoulders": "hinges",
            "knees": False,
            "ankles": False,
            "name": "athlete",
        },
    ),
    "model.AthleteKeys": lambda: (model.AthleteKeys, {"height": 1.7, "mass": 65.0}),
    "model.base_on_its_joints": lambda: (model.base_on_its_joints, {"model": furrer()}),
    "model.body_frames": lambda: (model.body_frames, {"model": furrer(), "q": [0.1, 0.2]}),
    "model.body_velocities": lambda: (
        model.body_velocities,
        {"model": furrer(), "q": [0.1, 0.2], "u": [0.1, 0.2]},
    ),
    "model.centre_of_mass": lambda: (model.centre_of_mass, {"model": furrer(), "q": [0.1, 0.2]}),
    "model.common_name": lambda: (
        model.common_name,
        {"left": "left_shoulder", "right": "right_shoulder"},
    ),
    "model.load": lambda: (so.load, {"source": "furrer", "axes": (2, 1, 3), "base": "free"}),
    "model.merge_welded": lambda: (
        model.merge_welded,
        {"bodies": list(furrer().bodies), "free": True},
    ),
    **{
        f"model.{call.__name__}": (lambda call=call: (call, {"model": furrer()}))  # type: ignore[misc]
        for call in (
            model.mirror_images,
            model.mirror_pairs,
            model.mjcf,
            model.model_digest,
            model.model_shapes,
            model.named_pairs,
            model.plain_form,
            model.pose_names,
        )
    },
    "model.mounted": lambda: (
        so.mounted,
        {
            "model": furrer(),
            "carrier": mount().held.bodies[0],
            "position": (0.0, 0.0, 1.0),
            "rotation": ROTATED,
            "body": "left_arm",
        },
    ),
    "model.named_pose": lambda: (so.named_pose, {"model": "gymnast", "name": "tuck"}),
    "model.pose": lambda: (model.pose, {"model": furrer(), "angles": POSE}),
    "model.reflection": lambda: (
        model.reflection,
        {"model": furrer(), "pair": model.mirror_pairs(furrer())[0]},
    ),
    "model.register_format": lambda: (model.register_format, {"ending": ".rods", "read": so.load}),
    "model.segment_momenta": lambda: (
        model.segment_momenta,
        {"model": furrer(), "q": [0.1, 0.2], "omega": THREE, "u": [0.1, 0.2]},
    ),
    "model.sagittal": lambda: (
        so.sagittal,
        {"model": gymnast(), "angles": {"hip_flexion": 0.1}},
    ),
    "model.sides": lambda: (model.sides, {"model": furrer(), "name": "shoulder"}),
    "model.spread": lambda: (model.spread, {"model": furrer(), "values": POSE, "mirrored": True}),
    "model.write_mjcf": lambda: (so.write_mjcf, {"model": furrer(), "path": "written.xml"}),
    # --- motion
    "motion.Motion.check": lambda: (arms().check, {"model": "furrer"}),
    "motion.Motion.delayed": lambda: (arms().delayed, {"seconds": 0.1}),
    "motion.Motion.joint_paths": lambda: (arms().joint_paths, {"model": "furrer", "duration": 0.1}),
    "motion.Motion.mirrored": lambda: (arms().mirrored, {"model": "furrer"}),
    "motion.Motion.moves": lambda: (so.Motion.moves, {"model": "furrer", "keyframes": MOVES}),
    "motion.Motion.scaled": lambda: (arms().scaled, {"factor": 2.0}),
    "motion.Motion.values": lambda: (arms().values, {"times": [0.0, 0.05]}),
    "motion.low_pass": lambda: (
        motion.low_pass,
        {"samples": np.sin(TIMES), "rate": 100.0, "cutoff": 6.0},
    ),
    "motion.read_column": lambda: (motion.read_column, {"path": "hip.csv", "column": "hip"}),
    "motion.read_motion": lambda: (
        so.read_motion,
        {
            "path": "arms.csv",
            "model": "furrer",
            "names": {},
            "ignore_others": True,
            "degrees": False,
            "cutoff": 6.0,
            "rate": 50.0,
            "start": 0.1,
            "stop": 0.4,
            "gap": 0.1,
            "slack": 0.1,
        },
    ),
    "motion.sampled_motion": lambda: (
        so.sampled_motion,
        {
            "model": "furrer",
            "times": TIMES,
            "values": {"left_shoulder": 1.0 - TIMES},
            "cutoff": 6.0,
            "rate": 50.0,
            "start": 0.1,
            "stop": 0.4,
            "gap": 0.1,
            "slack": 0.1,
            "source": "samples",
        },
    ),
    # --- flight
    "flight.BallisticPath": lambda: (
        lambda **given: flight.BallisticPath(**given).at([0.0, 0.1]),
        {"position": THREE, "velocity": THREE, "gravity": (0.0, 0.0, -9.81)},
    ),
    "flight.BallisticPath.at": lambda: (
        flight.BallisticPath(THREE, THREE).at,
        {"times": [0.0, 0.1]},
    ),
    "flight.BallisticPath.time_to": lambda: (
        flight.BallisticPath(THREE, THREE).time_to,
        {"height": 0.0},
    ),
    **{
        f"flight.Flight.{name}": (lambda name=name, right=right: (getattr(flown(), name), right))  # type: ignore[misc]
        for name, right in _PICTURED.items()
    },
    **{
        f"flight.Swing.{name}": (lambda name=name, right=right: (getattr(swung(), name), right))  # type: ignore[misc]
        for name, right in _PICTURED.items()
        if name != "stroboscopic_picture"  # what swings stays in place
    },
    "flight.Flight.save": lambda: (flown().save, {"path": "flight.nc"}),
    "flight.Flights.targets": lambda: (
        flight.flights("furrer", TAKEOFF, 0.1).targets,
        {"path": "takeoff.tilt"},
    ),
    "flight.JointTakeoff.locked": lambda: (_joint_takeoff(so.JointTakeoff.locked), {"angle": 0.1}),
    "flight.JointTakeoff.free": lambda: (
        _joint_takeoff(so.JointTakeoff.free),
        {"angle": 0.1, "rate": 0.1},
    ),
    "flight.JointTakeoff.sprung": lambda: (
        _joint_takeoff(so.JointTakeoff.sprung),
        {"angle": 1.4, "rate": 0.1, "stiffness": 30.0, "damping": 0.1, "rest": 1.4, "hold": False},
    ),
    "flight.JointTakeoff.prescribed": lambda: (
        _joint_takeoff(so.JointTakeoff.prescribed),
        {"times": [0.0, 0.1], "angles": [1.4, 0.2]},
    ),
    "flight.JointTakeoff.compliant": lambda: (
        _joint_takeoff(so.JointTakeoff.compliant),
        {"stiffness": 30.0, "damping": 0.1, "times": [0.0, 0.1], "angles": [1.4, 0.2]},
    ),
    "flight.JointTakeoff.torque": lambda: (
        _joint_takeoff(so.JointTakeoff.torque),
        {"times": [0.0, 0.1], "torques": [0.0, 1.0], "angle": 0.1},
    ),
    "flight.JointTakeoff.coupled": lambda: (
        _joint_takeoff(so.JointTakeoff.coupled),
        {"leader": "right_shoulder", "factor": -1.0},
    ),
    "flight.Maneuver": lambda: (
        lambda **given: so.Maneuver(**given).fly(),
        {
            "model": furrer(),
            "takeoff": TAKEOFF,
            "duration": 0.02,
            "gravity": (0.0, 0.0, -9.81),
            "accuracy": 1e-9,
            "samples": 3,
            "until": None,
            "steps": 1000,
        },
    ),
    "flight.Maneuver.changed": lambda: (maneuver().changed, {"duration": 0.2, "accuracy": 1e-8}),
    "flight.Maneuver.replayed": lambda: (
        maneuver().replayed,
        {"replay": so.Replay(law="1 + k * twist_error", gains={"k": 0.5})},
    ),
    "flight.Maneuver.compliant": lambda: (
        maneuver().compliant,
        {
            "natural_frequency": 60.0,
            "damping_ratio": 0.7,
            "pose": 0.0,
            "tape": True,
            "stop_stiffness": 0.0,
            "stop_damping": 0.0,
        },
    ),
    "flight.Maneuver.fly": lambda: (maneuver().fly, {"samples": 3, "steps": 1000}),
    "flight.Maneuver.from_takeoff": lambda: (maneuver().from_takeoff, {"takeoff": TAKEOFF}),
    "flight.Maneuver.moves": lambda: (
        so.Maneuver.moves,
        {
            "model": "furrer",
            "keyframes": MOVES,
            "takeoff": TAKEOFF,
            "duration": 0.2,
            "accuracy": 1e-8,
        },
    ),
    "flight.Maneuver.off_nominal": lambda: (
        maneuver().off_nominal,
        {"somersault": 0.1, "tilt": 0.1, "twist": 0.1},
    ),
    "flight.Maneuver.parse": lambda: (so.Maneuver.parse, {"tables": SPEC, "beside": "."}),
    "flight.Maneuver.read": lambda: (so.Maneuver.read, {"path": "main.toml"}),
    "flight.Maneuver.save": lambda: (maneuver().save, {"path": "saved.toml"}),
    "flight.Maneuver.scaled": lambda: (maneuver().scaled, {"factor": 2.0}),
    "flight.Prop": lambda: (_prop, {"angle": 0.1, "side": 1, "stiffness": 1e4, "damping": 0.0}),
    "flight.Report": lambda: (
        _report,
        {"quantities": ("tilt",), "extremes": ("tilt",), "history": ("tilt",), "samples": 3},
    ),
    "flight.Replay": lambda: (
        _replayed,
        {
            "law": "1 + k * twist_error",
            "gains": {"k": 0.5},
            "noise": {"twist_error": 0.01},
            "every": 0.01,
            "delay": 0.01,
            "rate": 1.1,
            "least": 0.5,
            "most": 1.5,
            "most_acceleration": 20.0,
            "nominal_angles": THREE,
            "nominal_momentum": THREE,
        },
    ),
    "flight.Report.times": lambda: (
        so.Report(samples=3, history=("tilt",)).times,
        {"duration": 0.1},
    ),
    "flight.Takeoff": lambda: (
        _takeoff,
        {
            "somersault": 0.1,
            "tilt": 0.1,
            "twist": 0.1,
            "spin": 5.0,
            "tilt_rate": 0.0,
            "twist_rate": 0.0,
            "position": THREE,
            "velocity": THREE,
            "joints": {},
        },
    ),
    "flight.Takeoff.by_velocity": lambda: (
        _takeoff,
        {"quaternion": FOUR, "angular_velocity": THREE},
    ),
    "flight.Takeoff.by_momentum": lambda: (
        _takeoff,
        {"quaternion": FOUR, "angular_momentum": THREE},
    ),
    "flight.arm_tilt": lambda: (
        so.arm_tilt,
        {
            "model": "gymnast",
            "spin": 7.0,
            "begin": 0.1,
            "move": 0.2,
            "raised": 3.1,
            "lowered": 0.12,
            "twists": None,
            "duration": 0.5,
        },
    ),
    "flight.cat_turn": lambda: (
        so.cat_turn,
        {"model": "gymnast", "cycles": 1, "torso": 0.7, "legs": None, "arms": 1.5, "move": 0.15},
    ),
    "flight.compliant": lambda: (
        so.compliant,
        {
            "model": "furrer",
            "takeoff": maneuver().takeoff,
            "natural_frequency": 60.0,
            "damping_ratio": 0.7,
            "pose": 0.0,
            "tape": True,
            "stop_stiffness": 0.0,
            "stop_damping": 0.0,
        },
    ),
    "flight.deviated_flight": lambda: (
        so.deviated_flight,
        {
            "spin": spun(),
            "rate": 5.0,
            "duration": 0.02,
            "tilt": 0.01,
            "somersault": 0.0,
            "twist": 0.0,
            "joints": {},
            "stiffness": {"shoulder": 1.0},
            "damping": {},
            "lock": (),
            "samples": 3,
        },
    ),
    "flight.sensitivity": lambda: (
        flight.sensitivity,
        {"maneuver": maneuver(), "with_respect_to": ["takeoff.tilt"], "of": ["tilt"]},
    ),
    "flight.transition": lambda: (flight.transition, {"maneuver": maneuver()}),
    "flight.flights": lambda: (
        flight.flights,
        {
            "model": "furrer",
            "takeoff": TAKEOFF,
            "duration": 0.1,
            "report": ("tilt",),
            "against": {"tilt": 0.0},
            "until": None,
            "accuracy": 1e-7,
            "steps": 1000,
        },
    ),
    "flight.flights_of": lambda: (
        flight.flights,
        {"model": maneuver(), "report": ("tilt",)},
    ),
    "flight.fly": lambda: (
        so.fly,
        {
            "model": "furrer",
            "takeoff": TAKEOFF,
            "duration": 0.02,
            "gravity": (0.0, 0.0, -9.81),
            "accuracy": 1e-9,
            "samples": 3,
            "until": None,
            "steps": 1000,
        },
    ),
    "flight.height_energy": lambda: (
        flight.height_energy,
        {
            "equations": so.Equations(mount().held),
            "q": mount().held.home,
            "gravity": (0.0, 0.0, -9.81),
        },
    ),
    "flight.rudi": lambda: (
        so.rudi,
        {
            "model": "gymnast",
            "spin": 12.0,
            "duration": 1.0,
            **dict.fromkeys(("pike", "side", "swing", "torso", "wrap", "back_side"), 0.1),
            **dict.fromkeys(("swing_time", "extend_time", "wrap_time", "open_time", "stay"), 0.2),
            **dict.fromkeys(("out_time", "back_time"), 0.2),
            **dict.fromkeys(("extend", "centre", "early", "late", "back", "back_pike"), 0.01),
        },
    ),
    "flight.hula": lambda: (
        so.hula,
        {
            "model": "gymnast",
            "spin": 9.0,
            "pike": 1.4,
            "side": 0.5,
            "arms": "T",
            "finish": "layout",
            "begin": 0.05,
            "quarter": 0.2,
            "hold": 0.0,
            "extend": 0.2,
            "duration": 0.5,
        },
    ),
    "flight.inertia_change": lambda: (
        so.inertia_change,
        {
            "model": "gymnast",
            "axis": 2,
            "poses": ("layout", "tuck"),
            "spin": 6.0,
            "begin": 0.1,
            "move": 0.25,
            "duration": 0.6,
        },
    ),
    **{
        f"flight.{call.__name__}": (lambda call=call: (call, {"flight": flown()}))  # type: ignore[misc]
        for call in (
            flight.joint_power,
            flight.joint_work,
            flight.landing_target,
            flight.principal_attitude,
            flight.principal_axes_along,
            flight.rigid_continuation,
            flight.why_broken,
        )
    },
    "flight.landing_error": lambda: (
        flight.landing_error,
        {"target": {"tilt": 0.0}, "landed": {"tilt": 0.1}},
    ),
    "flight.off_nominal": lambda: (
        so.off_nominal,
        {"model": "furrer", "takeoff": TAKEOFF, "somersault": 0.1, "tilt": 0.1, "twist": 0.1},
    ),
    "flight.prescribed": lambda: (
        so.prescribed,
        {"model": "furrer", "motion": arms(), "duration": 0.1},
    ),
    "flight.released": lambda: (so.released, {"swung": swung(), "mount": mount(), "joints": {}}),
    "flight.swing": lambda: (
        so.swing,
        {
            "model": mount().held,
            "angles": {"bar": 1.0},
            "duration": 0.02,
            "rates": {"bar": 0.1},
            "gravity": (0.0, 0.0, -9.81),
            "until": ("bar", 0.5),
            "stops": {},
            "samples": 3,
            "accuracy": 1e-8,
        },
    ),
    "flight.torque_twist": lambda: (
        so.torque_twist,
        {"model": "gymnast", "spin": 7.0, "twist_rate": 5.0, "pose": "layout", "duration": 0.5},
    ),
    "flight.twist_time": lambda: (
        flight.twist_time,
        {"maneuver": so.torque_twist(), "twists": 0.5},
    ),
    "flight.with_momentum": lambda: (so.with_momentum, {"model": "furrer", "takeoff": TAKEOFF}),
    # --- designs
    "designs.design": lambda: (
        so.design,
        {
            "what": _short(),
            "choose": {"K": so.Choose(sets="joints.shoulder.K", between=(0.5, 1.5))},
            "vary": {"leant": NORMAL},
            "objective": GOAL,
            "limits": [designs.Limit("twist", most=3.0)],
            "size": 2,
            "seed": 1,
            "sequence": "random",
            "evaluations": 4,
            "population": 4,
            "width": 0.2,
            "polish": False,
            "held_out": 2,
            "progress": False,
        },
    ),
    "designs.design_out": lambda: (_designed, {"out": "design", "threads": 1}),
    "designs.Choose": lambda: (
        lambda **given: _designed(choose={"K": so.Choose(**given)}),
        {
            "between": (0.5, 1.5),
            "sets": "joints.shoulder.K",
            "start": 1.0,
            "scale": "log",
            "unit": "",
        },
    ),
    "designs.Choose.multiplies": lambda: (
        lambda **given: _designed(choose={"K": so.Choose(between=(0.5, 1.5), **given)}),
        {"multiplies": {"joints.shoulder.K": 2.0}, "adds_to": "joints.shoulder.angle"},
    ),
    "designs.Limit": lambda: (
        lambda **given: _designed(limits=[designs.Limit(**given)]),
        {"quantity": "twist", "most": 3.0, "least": -3.0, "share": 0.5, "unperturbed": False},
    ),
    "designs.Mean": lambda: (
        lambda **given: _designed(objective=designs.Mean(**given)),
        {"quantity": "twist", "largest": False, "counts_as": 1.0},
    ),
    "designs.Quantile": lambda: (
        lambda **given: _designed(objective=designs.Quantile(**given)),
        {"quantity": "twist", "largest": False, "counts_as": 1.0, "q": 0.5},
    ),
    "designs.Share": lambda: (
        lambda **given: _designed(objective=designs.Share(**given)),
        {"quantity": "twist", "most": 0.1, "least": -0.1},
    ),
    "designs.Design.around": lambda: (_designed().around, {"steps": 2, "reach": 0.1}),
    "designs.Design.plot": lambda: (_designed().plot, {"steps": 2, "reach": 0.1}),
    "designs.trade_off": lambda: (
        designs.trade_off,
        {
            "what": _short(),
            "choose": _TWO,
            "vary": {"leant": NORMAL},
            "objectives": [GOAL, designs.Mean("K")],
            "limits": [designs.Limit("twist", most=3.0)],
            "size": 2,
            "seed": 1,
            "sequence": "sobol",
            "evaluations": 4,
            "population": 4,
            "points": 2,
            "held_out": 2,
            "progress": False,
        },
    ),
    "designs.trade_off_out": lambda: (_traded, {"out": "front", "threads": 1}),
    "designs.TradeOff.design": lambda: (_traded().design, {"point": 0, "objective": 1}),
    "designs.TradeOff.plot": lambda: (_traded().plot, {}),
    "designs.Design.map": lambda: (
        _designed(choose=_TWO).map,
        {"x": "K", "y": "arms", "steps": 2, "reach": 0.1, "progress": False},
    ),
    "designs.Design.plot_map": lambda: (
        _designed(choose=_TWO).plot_map,
        {"x": "K", "y": "arms", "steps": 2, "reach": 0.1, "progress": False},
    ),
    "designs.Design.sensitivity": lambda: (
        _designed().sensitivity,
        {"size": 64, "reach": 0.5, "confidence": 0.9, "seed": 1, "progress": False},
    ),
    "designs.Design.on": lambda: (_designed().on, {"size": 2, "seed": 3}),
    "designs.parse_design": lambda: (
        designs.parse_design,
        {"given": {**SPEC, **DESIGN}, "beside": Path()},
    ),
    "designs.read_design": lambda: (designs.read_design, {"path": "design.toml"}),
    # --- ensembles
    "ensembles.Vary": lambda: (
        _vary,
        {"sets": "takeoff.tilt", "uniform": (0.0, 1.0), "scale": 1.0, "unit": ""},
    ),
    **{
        f"ensembles.Vary.by_{word}": (lambda word=word, value=value: (_vary, {word: value}))  # type: ignore[misc]
        for word, value in {
            "values": {"from": 0.0, "to": 1.0, "count": 2},
            "samples": [0.0, 1.0],
            "normal": (0.0, 1.0),
            "truncated_normal": (0.0, 1.0, -1.0, 1.0),
            "triangular": (0.0, 0.5, 1.0),
            "lognormal": (1.0, 0.1),
        }.items()
    },
    "ensembles.Vary.quantile": lambda: (NORMAL.quantile, {"u": np.array([0.1, 0.5])}),
    "ensembles.tls_files": lambda: (ensembles.tls_files, dict.fromkeys(("ca", "cert"), pem())),
    "ensembles.Ensemble.fraction": lambda: (
        scattered().fraction,
        {"tolerance": 0.1, "over": "sample", "confidence": 0.95},
    ),
    "ensembles.Ensemble.fraction_ended": lambda: (scattered().fraction, {"ended": "duration"}),
    "ensembles.Ensemble.fraction_good": lambda: (
        scattered().fraction,
        {"good": scattered().dataset["tilt"] > 0},
    ),
    "ensembles.Ensemble.open": lambda: (so.Ensemble.open, {"path": "store.nc"}),
    "ensembles.Ensemble.save": lambda: (scattered().save, {"path": "scattered.nc"}),
    "ensembles.check_out": lambda: (ensembles.check_out, {"given": "out.nc"}),
    "ensembles.Ensemble.plot": lambda: (scattered().plot, {"name": "tilt"}),
    "ensembles.Ensemble.landings": lambda: (
        scattered().landings,
        {"path": "landings.png", "tolerance": 0.1, "most": 3, "columns": 2, "size": (64, 64)},
    ),
    "ensembles.Ensemble.landings_good": lambda: (
        scattered().landings,
        {"path": "landings.png", "good": scattered().dataset["tilt"] > 0, "most": 2},
    ),
    "ensembles.Ensemble.quantiles": lambda: (
        scattered().quantiles,
        {"name": "tilt", "q": (0.5,), "over": "sample"},
    ),
    "ensembles.Ensemble.sensitivity": lambda: (
        drawn().sensitivity,
        {"name": "tilt", "confidence": 0.95, "seed": 0},
    ),
    "ensembles.Plan.run": lambda: (planned().run, {"first": 0, "last": 2}),
    "ensembles.Plan.varied": lambda: (planned().varied, {"first": 0, "last": 2}),
    "ensembles.carried_out": lambda: (
        ensembles.carried_out,
        {
            "plan": planned(),
            "out": None,
            "chunk": 2,
            "threads": 1,
            "workers": None,
            "scheduler": None,
            "progress": False,
        },
    ),
    "ensembles.ended_by": lambda: (
        ensembles.ended_by,
        {"ended": scattered().dataset["ended"], "ending": "duration"},
    ),
    "ensembles.ensemble": lambda: (
        so.ensemble,
        {
            "model": "furrer",
            "takeoff": TAKEOFF,
            "duration": 0.02,
            "vary": {"lean": NORMAL},
            "against": {"tilt": 0.0},
            "size": 4,
            "seed": 0,
            "sequence": "random",
            "report": ("tilt",),
            "accuracy": 1e-7,
            "until": None,
            "steps": 1000,
            "out": None,
            "chunk": None,
            "threads": 1,
            "workers": None,
            "scheduler": None,
            "progress": False,
        },
    ),
    "ensembles.failed": lambda: (ensembles.failed, {"ended": scattered().dataset["ended"]}),
    "ensembles.fraction": lambda: (
        ensembles.fraction,
        {
            "good": scattered().dataset["tilt"] > 0,
            "ended": scattered().dataset["ended"],
            "over": "sample",
            "confidence": 0.95,
        },
    ),
    "ensembles.landing_derivatives": lambda: (
        ensembles.landing_derivatives,
        {"maneuver": maneuver(), "of": ("tilt",), "to": ("takeoff.tilt",), "step": 1e-4},
    ),
    "ensembles.landing_map": lambda: (
        ensembles.landing_map,
        {"maneuver": maneuver(), "against": flown(), "span": 0.1, "points": 3},
    ),
    "ensembles.parse_ensemble": lambda: (
        ensembles.parse_ensemble,
        {"given": SPEC, "beside": Path(), "others": ["search"], "of": "a design's SPEC"},
    ),
    "ensembles.plan": lambda: (
        ensembles.plan,
        {
            "simulation": flight.flights("furrer", TAKEOFF, 0.1),
            "vary": {"lean": NORMAL},
            "size": 4,
            "seed": 0,
            "sequence": "random",
        },
    ),
    "ensembles.quantiles": lambda: (
        ensembles.quantiles,
        {"data": scattered().dataset, "name": "tilt", "q": (0.5,), "over": "sample"},
    ),
    "ensembles.quick_sensitivity": lambda: (
        ensembles.quick_sensitivity,
        {"data": drawn().dataset, "names": ["tilt"]},
    ),
    "ensembles.read_ensemble": lambda: (ensembles.read_ensemble, {"path": Path("main.toml")}),
    "ensembles.sensitivity": lambda: (
        ensembles.sensitivity,
        {"data": drawn().dataset, "name": "tilt", "confidence": 0.95, "seed": 0},
    ),
    "ensembles.summary": lambda: (
        ensembles.summary,
        {"data": scattered().dataset, "tolerance": 0.1},
    ),
    "ensembles.within": lambda: (ensembles.within, {"data": scattered().dataset, "tolerance": 0.1}),
    # --- histories
    "history.Recording": lambda: (
        so.Recording,
        {
            "model": furrer(),
            "times": [0.0, 0.1],
            "base_position": np.zeros((2, 3)),
            "base_quaternion": [FOUR, FOUR],
            "joint_coordinates": np.zeros((2, 2)),
            "angles": np.zeros((2, 3)),
        },
    ),
    "flight.ridden": lambda: (flight.ridden, {"swung": swung(), "mount": mount()}),
    "history.joined": lambda: (
        so.history.joined,
        {"histories": [flown(), flown()], "clocks": [0.0, 9.0]},
    ),
    "history.read_recording": lambda: (
        so.read_recording,
        {"path": "recorded.nc", "model": furrer()},
    ),
    # --- planning
    "planning.plan": lambda: (so.plan, PLAN),
    "planning.parse_plan": lambda: (planning.parse_plan, {"given": PLANNED, "beside": Path()}),
    "planning.read_plan": lambda: (planning.read_plan, {"path": "planned.toml"}),
    "planning.Plan.fly": lambda: (raised().fly, {"samples": 3}),
    # --- dynamics
    "dynamics.Equations": lambda: (
        so.Equations,
        {"model": "furrer", "parameters": ("bodies.body.mass",)},
    ),
    "dynamics.Equations.derivative": lambda: (
        equations().derivative,
        {"name": "mass_matrix", "argument": "q"},
    ),
    "dynamics.Equations.evaluate": lambda: (
        equations().evaluate,
        {"expression": equations().expression("mass_matrix"), "q": [0.1, 0.2]},
    ),
    "dynamics.Equations.casadi": lambda: (equations().casadi, {"name": "mass_matrix"}),
    "dynamics.Equations.expression": lambda: (equations().expression, {"name": "mass_matrix"}),
    "dynamics.Equations.kernel": lambda: (
        equations().kernel,
        {"expression": equations().expression("mass_matrix")},
    ),
    "dynamics.Equations.forward_dynamics": lambda: (
        equations().forward_dynamics,
        {
            "q": [0.1, 0.2],
            "v": np.zeros(8),
            "torques": [0.0, 0.0],
            "gravity": THREE,
            "parameters": None,
        },
    ),
    "dynamics.Equations.inverse_dynamics": lambda: (
        equations().inverse_dynamics,
        {"q": [0.1, 0.2], "v": np.zeros(8), "a": np.zeros(8), "gravity": THREE, "parameters": None},
    ),
    "dynamics.Equations.momentum": lambda: (
        equations().momentum,
        {"q": [0.1, 0.2], "v": np.zeros(8), "parameters": None},
    ),
    "dynamics.Equations.kinetic_energy": lambda: (
        equations().kinetic_energy,
        {"q": [0.1, 0.2], "v": np.zeros(8), "parameters": None},
    ),
    **{
        f"dynamics.Equations.{name}": (
            lambda name=name: (getattr(equations(), name), {"q": [0.1, 0.2]})
        )  # type: ignore[misc]
        for name in ("inertia", "mass_matrix", "outboard_inertia", "spring_energy")
    },
    "dynamics.body_kind": lambda: (dy.body_kind, {"name": "bodies.body.mass"}),
    "dynamics.c_code": lambda: (dy.c_code, {"model": so.load("book")}),
    "dynamics.latex": lambda: (dy.latex, {"model": so.load("book")}),
    "dynamics.parameter_values": lambda: (dy.parameter_values, {"model": furrer()}),
    # --- files of tables
    "spec.model_beside": lambda: (spec.model_beside, {"name": "furrer", "folder": Path()}),
    "spec.require_table": lambda: (spec.require_table, {"given": {}}),
    "spec.read_toml": lambda: (spec.read_toml, {"path": Path("main.toml")}),
    "spec.plain": lambda: (spec.plain, {"value": TAKEOFF}),
    "spec.plain_fields": lambda: (spec.plain_fields, {"value": TAKEOFF}),
    "spec.write_toml": lambda: (spec.write_toml, {"path": Path("x.toml"), "tables": {"a": 1.0}}),
    # --- pictures
    "view.Look": lambda: (
        view.Look,
        {
            "size": (64, 64),
            "camera": (35.0, 12.0),
            "follow": True,
            "vectors": (),
            "charts": False,
            "ghosts": (),
            "labels": None,
            "ground": True,
        },
    ),
    "view.camera": lambda: (view.camera, {"azimuth": 35.0, "elevation": 12.0, "axes": (2, 1, 3)}),
    "view.check_film": lambda: (view.check_film, {"path": "film.gif"}),
    "view.check_page": lambda: (view.check_page, {"path": "page.html"}),
    "view.landings_picture": lambda: (
        view.landings_picture,
        {
            "poses": flown(),
            "path": "landings.png",
            "colors": ["#0072B2"] * len(flown().times),
            "words": [""] * len(flown().times),
            "key": [("#0072B2", "blue")],
            "columns": 2,
            "superimposed": False,
            "size": (64, 64),
        },
    ),
    "view.contact_sheet": lambda: (
        view.contact_sheet,
        {"history": flown(), "times": [0.0, 0.05], "columns": 2, "view": (35.0, 12.0), "title": ""},
    ),
    "view.film": lambda: (view.film, {"histories": flown(), "path": "film.gif", **_FILM}),
    "view.frame": lambda: (view.frame, {"histories": flown(), "time": 0.05, **LOOK}),
    "view.page": lambda: (
        view.page,
        {"histories": flown(), "path": "page.html", "labels": None, "title": "a flight"},
    ),
    "view.picture": lambda: (
        view.picture,
        {"histories": flown(), "path": "picture.png", "times": [0.0, 0.05], "columns": 2, **LOOK},
    ),
    "view.stroboscopic_picture": lambda: (
        view.stroboscopic_picture,
        {"histories": flown(), "path": "picture.png", "times": 3, **LOOK},
    ),
    "view.root_loci": lambda: (view.root_loci, {"loci": locus()}),
    "view.stability_chart": lambda: (view.stability_chart, {"chart": charted()}),
    "view.strip": lambda: (
        view.strip,
        {
            "ax": Figure().subplots(),
            "history": flown(),
            "times": [0.0, 0.05],
            "columns": 2,
            "view": (35.0, 12.0),
            "words": True,
            "size": 1.0,
        },
    ),
    "view.time_histories": lambda: (view.time_histories, {"history": flown(), "title": ""}),
    # --- landings
    "ground.Feet": lambda: (_landed_with("feet", ground.Feet), vars(ground.Feet())),
    "ground.Floor": lambda: (
        lambda **given: ground.land(fallen(), floor=ground.Floor(**given), duration=0.02),
        vars(ground.Floor()),
    ),
    "ground.Gymnast": lambda: (
        lambda **given: ground.land(fallen(), gymnast=ground.Gymnast(**given), duration=0.02),
        vars(ground.Gymnast(fallen().model)),
    ),
    "ground.LandingLaw": lambda: (
        lambda **given: ground.land(fallen(), law=ground.LandingLaw(**given), duration=0.02),
        vars(ground.LandingLaw()),
    ),
    "ground.Stance.save": lambda: (
        ground.land(fallen(), duration=0.02).save,
        {"path": "stance.nc"},
    ),
    "ground.Strength": lambda: (
        _landed_with("strength", ground.Strength),
        vars(ground.Strength()),
    ),
    "ground.land": lambda: (
        ground.land,
        {
            "flight": fallen(),
            "gymnast": ground.Gymnast(fallen().model),
            "floor": ground.Floor(),
            "law": ground.LandingLaw(),
            "duration": 0.02,
        },
    ),
    # --- robots
    **{
        f"robot.{name}": _table(name)
        for name in (
            "Change",
            "End",
            "Errors",
            "Flip",
            "Hips",
            "Plant",
            "Push",
            "Running",
            "Start",
            "Twist",
        )
    },
    "robot.Control": lambda: (robot.Control, vars(robot.Control())),
    "robot.Leg": lambda: (_leg, vars(robot.Leg.called("left"))),
    "robot.Leg.called": lambda: (robot.Leg.called, {"side": "left"}),
    "robot.Robot": lambda: (
        _runs,
        {
            "model": "biped",
            "left": robot.Leg.called("left"),
            "right": robot.Leg.called("right"),
            "shortest": 0.647,
            "longest": 0.862,
        },
    ),
    **{
        f"robot.Run.{name}": (lambda name=name, right=right: (getattr(ran(), name), right))
        for name, right in _PICTURED.items()
    },
    "robot.Run.began": lambda: (ran().began, {"state": "flight"}),
    "robot.Run.save": lambda: (ran().save, {"path": "run.nc"}),
    "robot.Runs": lambda: (
        robot.Runs,
        {"robot": robot.Robot(), "control": robot.Control(), "duration": 1.0},
    ),
    "robot.Runs.targets": lambda: (robot.Runs().targets, {"path": "flip.torque"}),
    "robot.maneuver": lambda: (robot.maneuver, {"name": "half_twist"}),
    "robot.parse_runs": lambda: (
        robot.parse_runs,
        {"given": {"robot": "biped", "flip": {"at": 1.0}}, "beside": Path()},
    ),
    "robot.read_runs": lambda: (robot.read_runs, {"path": Path("run.toml")}),
    "robot.run": lambda: (
        robot.run,
        {"robot": "biped", "duration": 0.1, "control": None, "flip": 0.05, "samples": 100},
    ),
    "robot.run_of": lambda: (
        robot.run_of,
        {"runs": robot.Runs(duration=0.1), "samples": 100},
    ),
    "robot.similar": lambda: (
        robot.similar,
        {"control": robot.Control(), "mass": 2.0, "length": 1.2},
    ),
    "robot.unit": lambda: (robot.unit, {"table": "flip", "name": "torque"}),
    "robot.usual": lambda: (robot.usual, {"model": "biped_weighted"}),
    # --- the thesis
    "thesis.reproduce": lambda: (
        thesis.reproduce,
        {"ids": ["table4-1"], "out": Path("report"), "progress": False},
    ),
}
