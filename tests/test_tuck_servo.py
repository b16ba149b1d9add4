"""The tuck servo and the landing window as functions of what is sensed, without a robot."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from somersault import SomersaultError
from somersault.robot import landing_window as window
from somersault.robot import tuck_servo as servo
from somersault.robot.tuck_servo import LiftOff, Somersault, Tuck

TUCK = Tuck(1.02, 0.06, 2 * 0.652, 0.243, 0.647, 0.862)
UP = LiftOff(speed=3.3, height=0.79, ago=0.1)
G = 9.81


def flip(
    momentum: float = 12.2, left: float = 5.4, sweep: float = 0.0, lean: float = -0.1
) -> Somersault:
    return Somersault(momentum, left, sweep, lean)


def f(length: float, of: Somersault, up: LiftOff = UP, tuck: Tuck = TUCK) -> float:
    return float(servo.mismatch(tuck, up, of, length))


class TestFlightTime:
    @given(st.floats(0.5, 5), st.floats(0.4, 1.2), st.floats(0.4, 1.2))
    def test_is_when_the_parabola_comes_down_to_the_height(
        self, speed: float, height: float, landing: float
    ) -> None:
        if speed**2 / (2 * G) + height < landing + 1e-3:
            return
        t = float(servo.flight_time(LiftOff(speed, height, 0.0), landing))
        assert height + speed * t - G * t**2 / 2 == pytest.approx(landing, abs=1e-9)
        assert speed - G * t <= 1e-9

    def test_where_it_never_gets_there_it_is_the_time_to_the_top(self) -> None:
        t = float(servo.flight_time(LiftOff(1.0, 0.5, 0.0), 2.0))
        assert t == pytest.approx(1.0 / G, abs=1e-3)


class TestSlope:
    @pytest.mark.parametrize("length", [0.66, 0.75, 0.85])
    @pytest.mark.parametrize("sweep", [0.0, 0.6, -0.3])
    def test_is_the_derivative(self, length: float, sweep: float) -> None:
        of, h = flip(sweep=sweep), 1e-6
        difference = (f(length + h, of) - f(length - h, of)) / (2 * h)
        assert float(servo.mismatch_slope(TUCK, UP, of, length)) == pytest.approx(
            difference, rel=1e-7
        )

    def test_is_the_corrected_derivative_and_not_the_printed_one(self) -> None:
        """Eq. 3.11 has dΦ̇/dl = −2 m_l r Φ̇/(I_o + m_l r²); it is −4 m_l r Φ̇/(I_o + 2 m_l r²)."""
        length, of = 0.75, flip()
        r, m = length - 0.243, 0.652
        rate = of.momentum / (1.02 + 2 * m * r**2)
        fall = -math.cos(of.lean) / math.sqrt(
            UP.speed**2 + 2 * G * (UP.height - math.cos(of.lean) * length)
        )
        right = fall + of.left / rate**2 * (-4 * m * r * rate / (1.02 + 2 * m * r**2))
        printed = fall + of.left / rate**2 * (-2 * m * r * rate / (1.02 + m * r**2))
        slope = float(servo.mismatch_slope(TUCK, UP, of, length))
        assert slope == pytest.approx(right, rel=1e-12)
        assert abs(slope / printed - 1) > 0.2


class TestServo:
    @given(
        st.floats(0.66, 0.85), st.floats(0.0, 0.5), st.floats(-0.5, 0.8), st.floats(0.647, 0.862)
    )
    def test_finds_the_length_that_lands_right(
        self, length: float, ago: float, sweep: float, guess: float
    ) -> None:
        """Made the other way round: the momentum for which a length is right gives that length."""
        up = LiftOff(3.3, 0.79, ago)
        left = 5.9 * (0.68 - ago) / 0.68
        time = float(servo.flight_time(up, math.cos(-0.1) * length)) - ago
        still = left - float(TUCK.legs(length) / TUCK.whole(length)) * sweep
        momentum = still * float(TUCK.whole(length)) / time
        of = Somersault(momentum, left, sweep, -0.1)
        assert float(servo.leg_length(TUCK, up, of, guess)) == pytest.approx(length, abs=1e-8)

    def test_converges_as_newton_does(self) -> None:
        """Each error is about the square of the one before: the printed derivative is linear."""
        of, length, errors = flip(), 0.65, []
        for _ in range(5):
            errors.append(abs(f(length, of)))
            length -= f(length, of) / float(servo.mismatch_slope(TUCK, UP, of, length))
        assert errors[0] > 0.01
        assert errors[3] < 1e-8
        assert errors[4] < 1e-14

    @pytest.mark.parametrize(("momentum", "limit"), [(25.0, 0.862), (5.0, 0.647)])
    def test_is_at_the_nearer_limit_where_no_length_would_do(
        self, momentum: float, limit: float
    ) -> None:
        """One that is too fast gets the longest legs, one that is too slow the shortest."""
        of = flip(momentum)
        assert all(f(x, of) * (momentum - 12) > 0 for x in (0.647, 0.862))
        for guess in (0.647, 0.75, 0.862):
            assert float(servo.leg_length(TUCK, UP, of, guess)) == limit

    def test_a_robot_that_is_late_still_has_an_answer(self) -> None:
        up = LiftOff(3.3, 0.79, ago=0.8)  # past the time at which it should have landed
        length = float(servo.leg_length(TUCK, up, flip(left=0.2), 0.75))
        assert 0.647 <= length <= 0.862

    def test_momentum_is_kept_when_the_legs_are_swept(self) -> None:
        """The time to turn against stepping I Φ̇ + I_legs q̇ = h through a sweep of any shape."""
        length, sweep = 0.78, 0.5
        of = flip(sweep=sweep)
        time = float(servo.time_to_turn(TUCK, of, length))
        t = np.linspace(0, time, 20_001)
        swing = -sweep * (np.pi / (2 * time)) * np.sin(np.pi * t / time)  # forward, all in all
        whole, legs = float(TUCK.whole(length)), float(TUCK.legs(length))
        rate = (of.momentum - legs * swing) / whole
        assert np.trapezoid(rate, t) == pytest.approx(of.left, rel=1e-6)

    def test_without_a_sweep_it_is_equation_3_3(self) -> None:
        """Time to landing less (Φ_td − Φ)/Φ̇."""
        of, length = flip(), 0.8
        rate = of.momentum / (1.02 + 2 * 0.652 * (length - 0.243) ** 2)
        z = math.cos(of.lean) * length
        landing = (UP.speed + math.sqrt(UP.speed**2 + 2 * G * (UP.height - z))) / G
        assert f(length, of) == pytest.approx(landing - UP.ago - of.left / rate, abs=1e-12)


class TestWindow:
    def test_is_open_from_before_the_landing_on_and_stays_so(self) -> None:
        opened = [bool(window.is_open(left, 0.12)) for left in (0.3, 0.13, 0.11, 0.0, -0.2)]
        assert opened == [False, False, True, True, True]
        assert not bool(window.is_open(0.01, -1e9))

    @given(st.floats(-0.3, 0.3), st.floats(0.647, 0.862))
    def test_inclination_puts_the_foot_there(self, forward: float, length: float) -> None:
        """d = −l sin β, as foot back is positive here."""
        lean = float(window.inclination(forward, length))
        assert -length * math.sin(lean) == pytest.approx(forward, abs=1e-9)

    @given(st.floats(-0.5, 0.5), st.floats(5.5, 7.0))
    def test_hip_and_body_make_the_inclination(self, lean: float, somersault: float) -> None:
        """At any attitude near a landing, one turn aside."""
        hip = float(window.hip_angle(lean, somersault))
        assert math.remainder(somersault + hip - lean, 2 * math.pi) == pytest.approx(0, abs=1e-9)
        assert abs(hip) <= math.pi

    def test_data_of_figure_3_5(self) -> None:
        """Φ 325° with the feet 24° back is a leg at −11°, as printed."""
        hip = float(window.hip_angle(math.radians(-11), math.radians(325)))
        assert math.degrees(hip) == pytest.approx(24)

    def test_a_foot_half_a_stance_in_front_keeps_the_speed(self) -> None:
        assert float(window.displacement(1.0, 1.0, 0.2, 0.07, 0.0)) == pytest.approx(0.1)
        assert float(window.displacement(1.2, 1.0, 0.2, 0.07, 0.0)) > 0.12

    def test_how_much_attitude_the_window_forgives(self) -> None:
        """With hips of ±60° a landing at 350° may be some 50° off."""
        lean = math.radians(-6)
        good = [
            d for d in range(-90, 91, 5)
            if window.reaches(window.hip_angle(lean, math.radians(350 + d)), *np.radians([-60, 60]))
        ]  # fmt: skip
        assert (min(good), max(good)) == (-55, 60)


class TestMistakes:
    @pytest.mark.parametrize("momentum", [0.0, math.nan, math.inf])
    def test_no_length_ends_a_somersault_that_does_not_turn(self, momentum: float) -> None:
        with pytest.raises(SomersaultError, match="momentum"):
            servo.leg_length(TUCK, UP, flip(momentum=momentum), 0.7)

    def test_what_is_no_number_is_named(self) -> None:
        with pytest.raises(SomersaultError, match="height must be a finite"):
            LiftOff(speed=3.3, height=math.nan, ago=0.1)
        with pytest.raises(SomersaultError, match="offset must be a finite"):
            replace(TUCK, offset=math.nan)
        with pytest.raises(SomersaultError, match="guess must be a finite"):
            servo.leg_length(TUCK, UP, flip(), math.nan)
