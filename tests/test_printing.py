"""Printed equations mean what the compiled ones compute."""

import ctypes
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest
import sympy

import somersault as so
from somersault.dynamics import Equations, c_code, latex
from somersault.dynamics._printing import _Page

PENDULUM = """
<mujoco><compiler angle="radian"/><worldbody><body name="rod" pos="0 0 2" euler="0.3 0 0">
  <joint name="pivot" axis="0 1 0" ref="0.2"/><joint name="along" type="slide" axis="0 0 -1"/>
  <inertial pos="0.01 0 -0.4" mass="1.5" fullinertia="0.08 0.085 0.01 0.002 0.001 0"/>
</body></worldbody></mujoco>"""


def numbers(page: _Page, q: np.ndarray, w: np.ndarray, u: np.ndarray) -> dict:
    """Values for the letters of a page; q is measured from the joints' references."""
    letters = page._letters
    values = dict(page._values)
    for symbols, given in ((page._q, q), (page._w, w), (page._u, u)):
        for k in range(symbols.numel()):
            values[letters[symbols[k].name()]] = given[k]
            values[sympy.Symbol(f"c_{k + 1}")] = np.cos(q[k]) if len(q) > k else 0.0
            values[sympy.Symbol(f"s_{k + 1}")] = np.sin(q[k]) if len(q) > k else 0.0
    values[letters["m"]] = page._model.mass
    values[letters["g"]] = 9.81
    return values


def printed(model: so.Model, q: np.ndarray, w: np.ndarray, u: np.ndarray) -> tuple:
    page = _Page(model)
    mass, bias = page._mass_and_bias()
    values = numbers(page, q, w, u)
    read = np.vectorize(lambda entry: float(sympy.sympify(page._tidy(entry)).subs(values)))
    return read(np.array(mass)), read(np.array(bias)).ravel()


@pytest.mark.parametrize(
    "name", ["book", "simplest", pytest.param("furrer", marks=pytest.mark.slow)]
)
def test_latex_of_free_models(name: str) -> None:
    model = so.load(name)
    equations = Equations(model)
    rng = np.random.default_rng(3)
    n = len(model.speeds)
    q, w, u = rng.uniform(-1, 1, n), rng.normal(size=3), rng.normal(size=n)
    mass, bias = printed(model, q, w, u)
    # The whole equations with the base's acceleration eliminated, numerically.
    whole = equations.mass_matrix(q)
    v = np.concatenate([w, np.zeros(3), u])
    loads = equations.inverse_dynamics(q, v, np.zeros(6 + n))
    keep, drop = np.r_[0:3, 6 : 6 + n], np.r_[3:6]
    across = whole[np.ix_(keep, drop)] @ np.linalg.inv(whole[np.ix_(drop, drop)])
    np.testing.assert_allclose(mass, (whole[keep] - across @ whole[drop])[:, keep], atol=1e-9)
    np.testing.assert_allclose(bias, loads[keep] - across @ loads[drop], atol=1e-9)


def test_latex_of_a_fixed_base(tmp_path: Path) -> None:
    (tmp_path / "rod.xml").write_text(PENDULUM)
    model = so.load(tmp_path / "rod.xml")
    q, u = np.array([0.7, 0.3]), np.array([0.4, -1.1])
    mass, bias = printed(model, q, np.zeros(3), u)
    equations = Equations(model)
    pose = q + np.array([0.2, 0.0])
    np.testing.assert_allclose(mass, equations.mass_matrix(pose), atol=1e-9)
    loads = equations.inverse_dynamics(pose, u, np.zeros(2), gravity=[0, 0, -9.81])
    np.testing.assert_allclose(bias, loads, atol=1e-9)
    assert "less 0.2" in latex(model)


def test_the_book_prints_eulers_equations() -> None:
    text = latex(so.load("book"))
    assert r"M_{22} &= I_{\mathrm{book},22}" in text
    assert r"b_{1} &= \omega_{2} \omega_{3} \left(- I_{\mathrm{book},22}" in text
    assert text.count(r"\begin{align*}") == text.count(r"\end{align*}") == 2
    assert not re.search(r"\b0\.0 ", text)


def test_latex_of_a_large_model_is_refused() -> None:
    ball = so.Joint("hip", "ball")
    eye = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    bodies = (
        so.Body("base", -1, 1.0, (0.0, 0.0, 0.0), eye),
        so.Body("leg", 0, 1.0, (0.0, 0.0, -1.0), eye, joints=(ball,)),
    )
    with pytest.raises(so.SomersaultError, match="--c"):
        latex(so.Model("two", True, bodies))


@pytest.mark.skipif(shutil.which("cc") is None, reason="no C compiler")
def test_c_code_computes_the_same(tmp_path: Path) -> None:
    model = so.load("furrer")
    source, library = tmp_path / "f.c", tmp_path / "f.so"
    source.write_text(c_code(model))
    subprocess.run(["cc", "-O1", "-shared", "-fPIC", source, "-o", library, "-lm"], check=True)
    code = ctypes.CDLL(str(library))
    rng = np.random.default_rng(5)
    arguments = {
        "q": rng.normal(size=2),
        "v": rng.normal(size=8),
        "torques": rng.normal(size=2),
        "gravity": rng.normal(size=3),
    }
    result = np.zeros(8)
    pointer = ctypes.POINTER(ctypes.c_double)
    inputs = (pointer * 5)(*[a.ctypes.data_as(pointer) for a in arguments.values()], None)
    outputs = (pointer * 1)(result.ctypes.data_as(pointer))
    work = (ctypes.c_double * 10000)()
    code.forward_dynamics(inputs, outputs, None, work, 0)
    np.testing.assert_allclose(
        result, Equations(model).forward_dynamics(*arguments.values()), rtol=1e-12
    )
