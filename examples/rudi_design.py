"""A rudi and the compliance about it, designed together within an athlete's torques.

Run with `python examples/rudi_design.py [MODEL [damped]]`: a front somersault with one and a half
twists (so.rudi) of an athlete is to land from starts that are off by up to 0.1 rad of tilt and
twist, with no torque at any joint beyond what he has, also while his joints give way. Chosen are
twenty numbers of the motion and the natural frequencies of seven groups of joints, and with
"damped", about the motion that was found, once more these with damping ratios, which are 0.7
otherwise. Every candidate has the motor tape of its own motion. The search begins at so.rudi as it
is, which earlier searches found, and refines that. Takes some three minutes on two cores; what is
found is kept in the folder rudi_design (rudi_design_damped), and the same call goes on where it was
stopped. Writes there design.png, rudi.json with what was chosen, and rudi.toml, which `somersault
fly` takes.
"""

import inspect
import json
import sys
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

import somersault as so
from somersault.designs import Limit, Mean

ATHLETE = {"hip": 250.0, "shoulder": 150.0, "torso": 150.0, "elbow": 70.0}  # N m, a strong man's
GROUPS = {  # rad/s, where the search begins: what serves a similar motion
    "shoulder_abduction": 19.0, "shoulder_rotation": 26.0, "shoulder_flexion": 52.0,
    "elbow": 23.0, "hip_flexion": 43.0, "hip_abduction": 17.5, "torso": 13.5,
}  # fmt: skip
# How far each number of the motion may go from where it begins, s and rad. "centre" has no
# influence so near: the legs take no less than 0.12 s to come back under the body.
REACH = {
    "duration": 0.07, "pike": 0.24, "side": 0.085, "swing": 0.04, "swing_time": 0.055,
    "extend": 0.06, "extend_time": 0.07, "centre": 0.12, "wrap": 0.1, "wrap_time": 0.055,
    "early": 0.04, "stay": 0.08, "open_time": 0.055, "late": 0.04, "back": 0.1,
    "back_side": 0.2, "out_time": 0.075, "back_time": 0.065, "back_pike": 0.26, "torso": 0.24,
}  # fmt: skip
FREQUENCIES, RATIOS = (8.0, 80.0), (0.3, 2.0)  # rad/s and 1: within what they are chosen
ANGLES = {"pike", "side", "back_side", "back_pike", "torso"}  # the others are times
LEAST = {"swing": 0.005, "wrap": 0.005, "stay": 0.005}
MOST = {"back_side": 0.5, "torso": 0.6}  # either way: joints have limits
SCATTER = {
    f"takeoff_{name}": so.Vary(adds_to=f"takeoff.{name}", uniform=[-0.1, 0.1])
    for name in ("tilt", "twist")
}


def maneuver(body: so.Model, **numbers: float) -> so.Maneuver:
    """A compliant rudi: numbers of so.rudi, with frequency_GROUP and damping_GROUP."""
    gains = {
        what: {f"*{g}*": numbers.pop(f"{what}_{g}", 0.7) for g in GROUPS}
        for what in ("frequency", "damping")
    }
    return so.rudi(body, **numbers).compliant(gains["frequency"], gains["damping"], pose="wrap")


def flights(body: so.Model, **numbers: float) -> so.flight.Flights:
    """Its flights, and how far from upright, turned and twisted, with the arms out, they land."""
    soft, out = maneuver(body, **numbers), so.named_pose(body, "T")
    landed = {name: out.get(name.split("_", 1)[1], 0.0) for name in body.speeds}
    return so.flight.flights(
        body, soft.takeoff, soft.duration, accuracy=1e-5, steps=3000,
        report=so.Report(("landing_error",), extremes=[f"{name}_torque" for name in body.speeds]),
        against={"somersault": 2 * np.pi, "tilt": 0.0, "twist": -3 * np.pi, **landed},
    )  # fmt: skip


def moves() -> dict[str, so.Choose]:
    """The numbers of the motion, from those of so.rudi on."""
    chosen = {}
    for name, reach in REACH.items():
        begin = inspect.signature(so.rudi).parameters[name].default
        most = MOST.get(name, np.inf)
        low = max(begin - reach, LEAST.get(name, -most))
        unit = "rad" if name in ANGLES else "s"
        chosen[name] = so.Choose(between=(low, min(begin + reach, most)), start=begin, unit=unit)
    return chosen


def gains(what: str, between: tuple[float, float], begins: dict[str, float]) -> dict[str, Any]:
    """Natural frequencies (rad/s) or damping ratios of the groups."""
    unit = "rad/s" if what == "frequency" else ""
    return {
        f"{what}_{group}": so.Choose(between=between, start=begin, scale="log", unit=unit)
        for group, begin in begins.items()
    }


def search(what: Any, chosen: dict[str, so.Choose], out: Path, **options: Any) -> Any:
    """The best of what is chosen; a folder keeps how far it is."""
    return so.design(
        what, chosen, SCATTER, Mean("landing_error", counts_as=1.0),
        limits=[Limit(f"*{group}*_torque", most=0.98 * most) for group, most in ATHLETE.items()],
        size=32, population=16, seed=1, out=out, progress=True, **options,
    )  # fmt: skip


def main(model: str = "gymnast", damped: str = "") -> None:
    """Search, judge, and keep."""
    body = so.load(model)
    if damped not in ("", "damped"):
        raise so.SomersaultError(f"{damped} is nothing that is chosen here; say damped, or nothing")
    chosen = moves() | gains("frequency", FREQUENCIES, GROUPS)
    maneuver(body, **{name: one.start for name, one in chosen.items()})  # refuses no athlete
    out = Path("rudi_design")
    found = search(partial(flights, body), chosen, out, evaluations=1_200, width=0.015)
    best = found.best
    if damped:
        out = Path("rudi_design_damped")
        motion = {name: best[name] for name in moves()}
        begins = {group: best[f"frequency_{group}"] for group in GROUPS}
        chosen = gains("frequency", FREQUENCIES, begins)
        chosen |= gains("damping", RATIOS, dict.fromkeys(GROUPS, 0.7))
        about = partial(flights, body, **motion)
        found = search(about, chosen, out, evaluations=480, width=0.05)
        best = motion | found.best
    print(found)
    data = found.dataset.sel(candidate="best")
    print(f"{100 * float((data.landing_error < 0.1).mean()):.1f} % land with an error below 0.1")
    for group in ATHLETE:
        names = [n for n in data.data_vars if group in str(n) and str(n).endswith("_torque")]
        print(f"{group}: {max(float(abs(data[n]).max()) for n in names):.0f} N m at most")
    (out / "rudi.json").write_text(json.dumps(best, indent=1) + "\n", encoding="utf-8")
    maneuver(body, **best).save(out / "rudi.toml")
    found.on(size=32).plot(steps=5).savefig(out / "design.png")


if __name__ == "__main__":
    try:
        main(*sys.argv[1:3])
    except so.SomersaultError as mistake:
        sys.exit(str(mistake))
    except KeyboardInterrupt:
        sys.exit("stopped; the same call goes on from here")
