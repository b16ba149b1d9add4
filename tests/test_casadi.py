"""Equations as functions of CasADi's: the same numbers as the compiled ones, and derivatives."""

import casadi as ca
import numpy as np
import pytest

import somersault as so

NAMES = so.Equations.QUANTITIES


def random_arguments(function: ca.Function, rng: np.random.Generator) -> dict[str, np.ndarray]:
    return {
        function.name_in(k): rng.normal(size=function.nnz_in(k)) for k in range(function.n_in())
    }


@pytest.mark.parametrize("model", ["furrer", "gymnast", "doll"])
@pytest.mark.parametrize("name", NAMES)
def test_agrees_with_the_compiled_form(model: str, name: str) -> None:
    equations, rng = so.Equations(model), np.random.default_rng(0)
    function = equations.casadi(name)
    for _ in range(5):
        arguments = random_arguments(function, rng)
        ours = np.asarray(getattr(equations, name)(**arguments))
        theirs = np.array(function(**arguments)[name]).reshape(ours.shape)
        np.testing.assert_allclose(theirs, ours, rtol=1e-10, atol=1e-10)


def test_inputs_and_outputs_have_names() -> None:
    function = so.Equations("furrer").casadi("inverse_dynamics")
    assert function.name_in() == ["q", "v", "a", "gravity"]
    assert function.name_out() == ["inverse_dynamics"]
    assert so.Equations("book").casadi("mass_matrix").name_in() == []


def test_open_parameters_are_an_input() -> None:
    equations = so.Equations("furrer", parameters=["bodies.left_arm.mass"])
    function = equations.casadi("mass_matrix")
    assert function.name_in() == ["q", "parameters"]
    q, mass = [0.3, -0.2], [5.0]
    ours = equations.mass_matrix(q, mass)
    np.testing.assert_allclose(np.array(function(q, mass)), ours, atol=1e-12)


def test_takes_symbols_and_is_differentiated() -> None:
    equations = so.Equations("furrer")
    v = ca.MX.sym("v", 8)
    energy = equations.casadi("kinetic_energy")(q=[1.0, -0.5], v=v)["kinetic_energy"]
    slope = ca.Function("slope", [v], [ca.gradient(energy, v)])
    speeds = np.random.default_rng(1).normal(size=8)
    expected = equations.mass_matrix([1.0, -0.5]) @ speeds  # of ½ vᵀ M v
    np.testing.assert_allclose(np.array(slope(speeds)).ravel(), expected, atol=1e-10)


def test_unknown_quantities_are_named() -> None:
    with pytest.raises(so.SomersaultError, match="no quantity is called 'mass'; there are forward"):
        so.Equations("furrer").casadi("mass")
