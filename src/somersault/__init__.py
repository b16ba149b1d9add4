"""Bodies in the air: which spins are stable, and which springs make them so.

    import somersault as so

    spin = so.spin("furrer", axis=2, pose={"shoulder": 1.4})
    layout = spin.linear(stiffness={"shoulder": 1.2})
    print(layout.stable, layout.energy_signature)

Names are imported when they are first used, so that starting costs little.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from somersault import ensembles, stability
    from somersault._errors import SomersaultError, SomersaultWarning
    from somersault.dynamics import Equations
    from somersault.ensembles import Ensemble, Report, Vary, ensemble
    from somersault.flight import (
        Flight,
        JointTakeoff,
        Landing,
        Maneuver,
        Motion,
        Release,
        Stop,
        Swing,
        Takeoff,
        arm_tilt,
        cat_turn,
        compliant,
        deviated_flight,
        fly,
        hula,
        inertia_change,
        off_nominal,
        read_motion,
        released,
        sampled_motion,
        swing,
        torque_twist,
        with_momentum,
    )
    from somersault.model import (
        Body,
        Joint,
        Model,
        Mount,
        athlete,
        athlete_from_measurements,
        load,
        mounted,
        named_pose,
        shipped,
    )
    from somersault.stability import LinearSpin, Mode, Spin, spin

__version__ = "0.1.0"

_HOME = {
    "SomersaultError": "somersault._errors",
    "SomersaultWarning": "somersault._errors",
    "Body": "somersault.model",
    "Joint": "somersault.model",
    "Model": "somersault.model",
    "athlete": "somersault.model",
    "athlete_from_measurements": "somersault.model",
    "Mount": "somersault.model",
    "load": "somersault.model",
    "mounted": "somersault.model",
    "named_pose": "somersault.model",
    "shipped": "somersault.model",
    "Equations": "somersault.dynamics",
    "Ensemble": "somersault.ensembles",
    "Report": "somersault.ensembles",
    "Vary": "somersault.ensembles",
    "ensemble": "somersault.ensembles",
    "Flight": "somersault.flight",
    "JointTakeoff": "somersault.flight",
    "Landing": "somersault.flight",
    "Maneuver": "somersault.flight",
    "Motion": "somersault.flight",
    "arm_tilt": "somersault.flight",
    "cat_turn": "somersault.flight",
    "hula": "somersault.flight",
    "inertia_change": "somersault.flight",
    "torque_twist": "somersault.flight",
    "Release": "somersault.flight",
    "Stop": "somersault.flight",
    "Swing": "somersault.flight",
    "released": "somersault.flight",
    "swing": "somersault.flight",
    "Takeoff": "somersault.flight",
    "compliant": "somersault.flight",
    "read_motion": "somersault.flight",
    "sampled_motion": "somersault.flight",
    "off_nominal": "somersault.flight",
    "with_momentum": "somersault.flight",
    "deviated_flight": "somersault.flight",
    "fly": "somersault.flight",
    "LinearSpin": "somersault.stability",
    "Mode": "somersault.stability",
    "Spin": "somersault.stability",
    "spin": "somersault.stability",
}

__all__ = [
    "Body",
    "Ensemble",
    "Equations",
    "Flight",
    "Joint",
    "JointTakeoff",
    "Landing",
    "LinearSpin",
    "Maneuver",
    "Mode",
    "Model",
    "Motion",
    "Mount",
    "Release",
    "Report",
    "SomersaultError",
    "SomersaultWarning",
    "Spin",
    "Stop",
    "Swing",
    "Takeoff",
    "Vary",
    "arm_tilt",
    "athlete",
    "athlete_from_measurements",
    "cat_turn",
    "compliant",
    "deviated_flight",
    "ensemble",
    "ensembles",
    "fly",
    "hula",
    "inertia_change",
    "load",
    "mounted",
    "named_pose",
    "off_nominal",
    "read_motion",
    "released",
    "sampled_motion",
    "shipped",
    "spin",
    "stability",
    "swing",
    "torque_twist",
    "with_momentum",
]


def __getattr__(name: str) -> Any:
    if name in ("ensembles", "stability"):
        return import_module(f"somersault.{name}")
    if name in _HOME:
        return getattr(import_module(_HOME[name]), name)
    raise AttributeError(f"module 'somersault' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*__all__, "__version__"])
