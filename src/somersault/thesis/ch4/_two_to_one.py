"""The spring at which a body's slow wobble and its symmetric arms are in resonance, 2 : 1."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

from scipy import optimize

from somersault import stability as st
from somersault.thesis.ch4._columns import edges

_WIDE = 10.0  # in units of Ω: however far off
_STEP = 1e-4  # of K_sh
_OFF = 1e-6  # of K_sh from the region's edge


@dataclass(frozen=True, eq=False)
class TwoToOne:
    """K_sh of exact resonance, the linear system there, what it does, and how the detuning
    ω_s − 2 ω_1 changes with K_sh."""

    stiffness: float
    spin: st.LinearSpin
    burst: st.Burst
    slope: float

    def band(self, amplitude: float) -> tuple[float, float]:
        """The K_sh at which a slow wobble of that amplitude bursts."""
        reach = self.burst.width(amplitude) / abs(self.slope)
        return self.stiffness - reach, self.stiffness + reach


@cache
def two_to_one(model: str, angle: float) -> TwoToOne:
    """The explosive resonance of order three of a layout somersault with sprung shoulders, from the
    frequencies of the linear modes."""
    steady = st.spin(model, pose={"shoulder": angle})

    def found(stiffness: float) -> st.Resonance:
        near = steady.linear({"shoulder": stiffness}).resonances(order=3, within=_WIDE)
        (one,) = (r for r in near if r.explosive and sorted(map(abs, r.counts)) == [1, 2])
        return one

    def off(stiffness: float) -> float:
        resonance = found(stiffness)
        of_fast = next(n for n in resonance.counts if abs(n) == 1)
        return of_fast * resonance.detuning

    low, high = edges(model, angle)
    exact = float(optimize.brentq(off, low + _OFF, high - _OFF, xtol=1e-10))
    spin = steady.linear({"shoulder": exact})
    slope = (off(exact + _STEP) - off(exact - _STEP)) / (2 * _STEP)
    return TwoToOne(exact, spin, st.burst(spin, found(exact)), slope)
