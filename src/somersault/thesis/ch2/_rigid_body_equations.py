"""Equations 2.1 to 2.14, checked on random bodies and against flights."""

from __future__ import annotations

import numpy as np

from somersault import attitude, rigid
from somersault import stability as st
from somersault.flight import JointTakeoff, Takeoff, fly
from somersault.thesis._claims import Claim, number, statement
from somersault.thesis._entries import Result
from somersault.thesis.ch2._inertia_ratios import STABLE, random_bodies, roots
from somersault.thesis.ch4._furrer import MODEL, NOMINAL


def rigid_body_equations() -> Result:
    """The equations of the rigid body."""
    claims = (*_kinematics(), *_motion(), *_matrices(), *_roots(), *_growth())
    return Result(
        "Euler's equations, somersault, tilt and twist, their small deviations from a steady "
        "somersault, the inertia ratios and the roots of the characteristic equation.",
        "All hold on random bodies and against flights of the shipped models, except for one sign: "
        "the pair that §2.3.2 prints as ±ν is ±jν (errata). Equation 2.3 has lost its fraction "
        "bars in "
        "the scan: sin Θ cos Θ there is sin Θ/cos Θ, and the last row is divided by cos Θ.",
        claims,
    )


def _kinematics() -> list[Claim]:
    chance = np.random.default_rng(22)
    angles = chance.uniform(-1, 1, (1000, 3)) * [np.pi, 1.5, np.pi]
    rates = chance.normal(size=(1000, 3))
    cosines = attitude.direction_cosines(*angles.T)
    turned = attitude.matrix_from_quaternion(attitude.quaternion_from_angles(*angles.T))
    off = float(np.abs(cosines - np.swapaxes(turned, -1, -2)).max())
    back = attitude.angle_rates(angles, attitude.body_rates(angles, rates))
    inverse = float(np.abs(back - rates).max())
    step = 1e-6
    moved = [attitude.direction_cosines(*(angles + s * step * rates).T) for s in (1, -1)]
    spin = -(moved[0] - moved[1]) / (2 * step) @ np.swapaxes(cosines, -1, -2)
    omega = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], -1)
    from_matrix = float(np.abs(omega - attitude.body_rates(angles, rates)).max())
    upright = attitude.body_rates([[0.3, np.pi / 2, 0.4]] * 3, np.eye(3))
    return [
        statement(
            "eq2.2", "eq. 2.2", "direction cosines of the 2-1-3 sequence", "C_bi as printed",
            f"the turn of the quaternion of the same angles to {off:.0e}", off < 1e-14,
        ),
        statement(
            "eq2.4", "eq. 2.4", "angular velocity from the rates of the angles", "as printed",
            f"−Ċ Cᵀ of eq. 2.2, by differences, to {from_matrix:.0e}", from_matrix < 1e-8,
        ),
        statement(
            "eq2.3", "eq. 2.3", "rates of the angles are eq. 2.4 inverted", "the inverse",
            f"to {inverse:.0e}, with tan Θ and 1/cos Θ", inverse < 1e-11,
            "Read with the fraction bars that the scan has lost.",
        ),
        statement(
            "eq2.singular", "§2.2", "the sequence is singular at a tilt of ±π/2", "±π/2",
            f"determinant of eq. 2.4 there {np.linalg.det(upright):.0e}, elsewhere ± cos Θ",
            abs(np.linalg.det(upright)) < 1e-15,
        ),
    ]  # fmt: skip


def _motion() -> list[Claim]:
    bodies = random_bodies()
    chance = np.random.default_rng(23)
    omega = chance.normal(size=bodies.shape)
    change = rigid.euler_rates(bodies, omega)
    power = np.abs(np.sum(bodies * omega * change, -1)).max()
    torque = np.abs(np.sum(bodies**2 * omega * change, -1)).max()
    pure = np.abs(rigid.euler_rates(bodies[:, None, :], np.eye(3))).max()
    held = {
        name: JointTakeoff(motion="locked", angle=sign * NOMINAL)
        for name, sign in (("left_shoulder", 1), ("right_shoulder", -1))
    }
    start = [1.0, 4.0, -6.0]
    flown = fly(MODEL, Takeoff(angular_velocity=start, joints=held), 5.0)
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    exact = rigid.RigidMotion(inertias, start).omega(flown.times)
    off = float(np.abs(exact - flown.dataset["angular_velocity"].values).max())
    return [
        statement(
            "eq2.1", "eq. 2.1", "Euler's equations govern a free rigid body", "eq. 2.1",
            f"a flight of furrer with locked arms is their exact solution to {off:.0e} rad/s, 5 s",
            off < 1e-7,
        ),
        statement(
            "eq2.1.integrals", "§2.5", "angular momentum and energy are conserved", "conserved",
            f"2.15 and 2.16 change at rates of {torque:.0e} and {power:.0e}, random bodies",
            max(power, torque) < 1e-12,
        ),
        statement(
            "eq2.1.pure", "§2.2", "pure spins about the three axes are solutions", "three",
            f"largest acceleration of any {pure:.0e}", pure == 0,
        ),
    ]  # fmt: skip


def _matrices() -> list[Claim]:
    bodies = random_bodies()
    one, two, three = bodies.T
    m, g, k = rigid.gyric_matrices(one, two, three)
    sizes = np.linalg.eigvalsh(m)[:, 0], np.linalg.eigvalsh(k)[:, 0]
    form = (
        np.array_equal(m, np.swapaxes(m, 1, 2))
        and np.array_equal(g, -np.swapaxes(g, 1, 2))
        and np.array_equal(k, np.swapaxes(k, 1, 2))
        and bool(np.all(sizes[0] > 0))
    )
    largest, least = (two > one) & (two > three), (two < one) & (two < three)
    linear = st.spin(MODEL, 2, {"shoulder": NOMINAL}).linear(lock="all")
    ours = rigid.gyric_matrices(*linear.spin.principal_inertias)
    off = max(
        float(np.abs(a[:2, :2] - b).max())
        for a, b in zip((linear.M, linear.G, linear.K), ours, strict=True)
    )
    alone = max(float(np.abs(linear.G[2]).max()), float(np.abs(linear.K[2]).max()))
    k1, k3 = rigid.inertia_ratios(one, two, three)
    inside = np.abs(np.stack([k1, k3])).max()
    back = rigid.inertias_from_ratios(k1, k3) * two[:, None] / bodies - 1
    square = np.linspace(-0.999, 0.999, 400)
    any_body = rigid.inertias_from_ratios(square[:, None], square[None, :])
    real = bool(np.all(2 * any_body.max(-1) < any_body.sum(-1)) and np.all(any_body > 0))
    static = roots(bodies, 0.1).real.max(-1)
    return [
        statement(
            "eq2.11", "eqs. 2.10, 2.11", "M, G and K of tilt and twist", "as printed",
            f"those of the whole model furrer with locked arms, linearised, to {off:.0e}",
            off < 1e-12,
        ),
        statement(
            "eq2.10.somersault", "§2.3", "deviations of the somersault grow without bound, and do "
            "not couple to tilt and twist", "I2 φ̈ = 0",
            f"its rows of G and K are zero to {alone:.0e}", alone < 1e-12,
        ),
        statement(
            "eq2.11.gyric", "§2.3.1", "the system is conservative gyric: M = Mᵀ > 0, G = −Gᵀ, "
            "K = Kᵀ", "conservative gyric", f"so for {len(bodies)} random bodies", form,
        ),
        statement(
            "eq2.11.static", "§2.3.1", "K is positive definite if I2 is the major principal "
            "inertia", "K > 0 about the major axis",
            f"so for all {int(largest.sum())} random bodies of that kind, and no others",
            bool(np.array_equal(sizes[1] > 0, largest)),
        ),
        statement(
            "eq2.damping", "§2.3.1", "damping makes statically stable systems asymptotically "
            "stable, and destabilises gyrically stabilised ones", "tends to",
            f"with D = 0.1 I1 on tilt and twist: {int((static[largest] < 0).sum())} of "
            f"{int(largest.sum())} and {int((static[least] > 0).sum())} of {int(least.sum())} "
            "random bodies", bool(np.all(static[largest] < 0) and np.all(static[least] > 0)),
        ),
        statement(
            "eq2.ratios", "§2.3.2", "every body has −1 < k1 < 1 and −1 < k3 < 1",
            "within the unit square", f"largest magnitude {inside:.4f} of {len(bodies)} bodies",
            inside < 1,
        ),
        statement(
            "eq2.ratios.all", "§2.3.2", "all possible bodies can be represented in that square",
            "all", "each point of it is a body, and the ratios give the inertias back to "
            f"{np.abs(back).max():.0e}", real and bool(np.abs(back).max() < 1e-9),
        ),
    ]  # fmt: skip


def _roots() -> list[Claim]:
    bodies = random_bodies()
    one, two, three = bodies.T
    k1, k3 = rigid.inertia_ratios(one, two, three)
    numeric, closed = roots(bodies), rigid.gyric_roots(k1, k3)
    apart = np.abs(numeric[:, :, None] - closed[:, None, :])
    off = float(max(apart.min(1).max(), apart.min(2).max()))
    mirrored = np.abs(numeric[:, :, None] + numeric[:, None, :]).min(2).max()
    stable = numeric.real.max(-1) <= STABLE
    same = k1 * k3 > 0
    least = (two < one) & (two < three)
    b1, b2 = 1 + k1 * k3, k1 * k3
    squared = closed**2
    poly = np.abs(squared**2 + b1[:, None] * squared + b2[:, None]).max()
    automatic = bool(np.all(b1 > 0) and np.all(b1**2 - 4 * b2 > 0))
    real = np.abs(closed[same, 2].real).max()
    return [
        statement(
            "eq2.12", "eq. 2.12", "the characteristic equation, b̂1 = 1 + k1 k3, b̂2 = k1 k3",
            "as printed", f"its roots are the eigenvalues of eq. 2.11 to {off:.0e}",
            off < 1e-6 and bool(poly < 1e-12), "Eigenvalues near a double root carry half the "
            "digits.",
        ),
        statement(
            "eq2.12.mirror", "§2.3.1", "with every root s, −s is a root: asymptotic stability is "
            "impossible", "−s too", f"so to {mirrored:.0e}", bool(mirrored < 1e-6),
        ),
        statement(
            "eq2.12.conditions", "§2.3.2", "the only condition not met automatically is k1 k3 > 0",
            "b̂1 > 0 and b̂1² > 4 b̂2 always", f"so for {len(bodies)} random bodies", automatic,
        ),
        statement(
            "eq2.stable", "§2.3.2", "the spin is stable if and only if k1 and k3 have the same "
            "sign", "k1 k3 > 0", f"so for {int((stable == same).sum())} of {len(bodies)} bodies",
            bool(np.array_equal(stable, same)),
        ),
        statement(
            "eq2.minor", "§2.3.1", "rotation about the minor axis is stable too, gyrically",
            "stable", f"all {int(least.sum())} random bodies of that kind",
            bool(np.all(stable[least]) and least.any()),
        ),
        statement(
            "eq2.stroboscopic", "§2.3.2", "two roots lie at s = ±j Φ̇", "±j",
            f"to {np.abs(numeric[:, :, None] - np.array([1j, -1j])).min(1).max():.0e}",
            bool(np.abs(numeric[:, :, None] - np.array([1j, -1j])).min(1).max() < 1e-6),
        ),
        statement(
            "eq2.nu", "§2.3.2", "the other two roots lie at s = ±ν, ν = √(k1 k3) Φ̇", "±ν",
            f"±jν: where k1 k3 > 0 their real parts are at most {real:.0e} and not ν",
            bool(np.abs(np.abs(closed[same, 2]) - closed[same, 2].real).max() < 1e-9),
            "Printed without the j (errata): only imaginary roots oscillate, as the same paragraph "
            "says they do.",
        ),
    ]  # fmt: skip


def _growth() -> list[Claim]:
    """Eq. 2.13 on the exact, non-linear motion: along the separatrix, from near the axis."""
    inertias = st.principal_inertias(MODEL, {"shoulder": NOMINAL})
    k1, k3 = rigid.inertia_ratios(*inertias)
    angle = float(rigid.growth_angle(k1, k3))
    circle = rigid.separatrix(inertias, 5)[0]
    small = 1e-5
    factors = []
    for along in (circle[1], circle[3], rigid.separatrix(inertias, 5)[1][1]):
        cosines = np.array([0.0, 1.0, 0.0]) + small * along
        begun = rigid.RigidMotion(inertias, cosines / inertias * inertias[1])
        c = begun.omega(angle) * inertias / np.linalg.norm(begun.inertias * begun.omega0)
        factors.append(np.hypot(c[0], c[2]) / small)
    return [
        number(
            "eq2.14", "eqs. 2.13, 2.14", "growth over Φ = ln 10/√(−k1 k3) of the exact motion of "
            "furrer, Γ = 1.3 rad, that leaves the middle axis", 10.0, float(max(factors)), "1",
            0.01, f"From a deviation of 1e-5 along the separatrix; Φ = {angle:.3f} rad. The other "
            f"circle of the separatrix leads towards the axis: × {min(factors):.3f}.",
        ),
    ]  # fmt: skip
