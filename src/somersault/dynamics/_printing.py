"""Equations of motion as text: LaTeX of a small model, C of any.

The LaTeX is of M u̇ + b = τ in the speeds u = (ω, q̇), translation of a free body eliminated,
with masses, lengths and inertias as symbols; what mirrored bodies have in common gets one.
"""

from __future__ import annotations

import re
from typing import Any

import casadi as ca

from somersault._core.checks import instance
from somersault._core.errors import SomersaultError
from somersault.dynamics._equations import Equations
from somersault.dynamics._newton_euler import inverse_dynamics
from somersault.dynamics._parameters import body_numbers, body_parameter
from somersault.dynamics._tree import Tree, link_tree
from somersault.dynamics.vectors import Vec, scale
from somersault.model import Model, common_name, mirror_pairs

MOST_JOINTS = 3  # beyond this nobody reads a page of LaTeX,
_MOST_OPERATIONS = 40_000  # nor where an entry of it is multiplied out of so many


def c_code(model: Model) -> str:
    """C code of every quantity of a model, one function for each.

    It comes from CasADi's code generator: `int NAME(const double** arg, double** res, ...)`, with
    matrices by columns. The header comment lists the arguments.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str
    """
    instance("model", model, Model)
    equations = Equations(model)
    names = [n for n in Equations.QUANTITIES if model.free or n != "inertia"]
    generator = ca.CodeGenerator("somersault_equations.c", {"with_header": False})
    lines = [f"/* Equations of motion of {_comment(model.name)}.", ""]
    for name in names:
        function = equations.expression(name).function()
        generator.add(function)
        arguments = ", ".join(
            f"{function.name_in(k)}[{function.nnz_in(k)}]" for k in range(function.n_in())
        )
        rows, columns = function.size_out(0)
        lines.append(f"   {name}({arguments}) -> {rows} x {columns}")
    joints = ", ".join(model.speeds) or "none"
    base = "(omega, velocity of the base's origin, joints), in its axes" if model.free else "joints"
    lines += ["", f"   Speeds: {base}. Joints: {_comment(joints)}. SI units, rad. */", ""]
    return "\n".join(lines) + generator.dump()


def _comment(text: str) -> str:
    return text.replace("*/", "* /").replace("/*", "/ *")


def latex(model: Model) -> str:
    """LaTeX of the equations of motion, with a table of the symbols' values.

    A fixed base hangs in gravity g along its −3 axis.

    Parameters
    ----------
    model : Model

    Returns
    -------
    str

    Raises
    ------
    SomersaultError
        For a model with more joints than anyone would read, or with ball joints.
    """
    joints = len(instance("model", model, Model).joints)
    if joints > MOST_JOINTS or any(joint.kind == "ball" for joint in model.joints):
        raise _too_long(model)
    return _Page(model).text()


def _too_long(model: Model) -> SomersaultError:
    return SomersaultError(
        f"the LaTeX of {model.name} would fill pages ({len(model.joints)} joints); models of up to "
        f"{MOST_JOINTS} hinges and slides, if they move in a plane or nearly, can be printed so, "
        "others with --c"
    )


class _Page:
    """The symbols, the matrices and the layout of one model's page."""

    def __init__(self, model: Model) -> None:
        import sympy

        self._sp = sympy
        self._model = model
        self._values: dict[Any, float] = {}
        self._names: dict[str, Any] = {}
        symbols = self._open_numbers()
        self._tree: Tree = link_tree(model, symbols)
        count = len(model.speeds)
        self._q = ca.SX.sym("q", count)
        self._w = ca.SX.sym("w", 3)
        self._u = ca.SX.sym("u", count)
        self._g = ca.SX.sym("g")
        self._m = ca.SX.sym("m")  # of the whole body, lest the sum be written everywhere
        self._letters = self._all_letters()

    def text(self) -> str:
        mass, bias = self._mass_and_bias()
        sp, n = self._sp, mass.shape[0]
        speeds = self._speed_letters()
        lines = [r"\begin{align*}"]
        for i in range(n):
            for j in range(i, n):
                entry = self._tidy(mass[i, j])
                if entry != 0:
                    lines.append(rf"M_{{{i + 1}{j + 1}}} &= {sp.latex(entry)} \\")
        for i in range(n):
            entry = self._tidy(bias[i])
            if entry != 0:
                lines.append(rf"b_{{{i + 1}}} &= {sp.latex(entry)} \\")
        lines[-1] = lines[-1].removesuffix(r" \\")
        lines += [r"\end{align*}"]
        head = [
            rf"% Equations of motion of {self._model.name}: M \dot u + b = \tau, with",
            rf"% u = ({', '.join(speeds)}); M is symmetric, entries not listed are zero.",
            *self._explanation(),
            r"\[ M\,\dot u + b = \tau, \qquad u = \left("
            + ",\\; ".join(speeds)
            + r"\right)^{\mathsf T} \]",
        ]
        return "\n".join([*head, *lines, *self._table(), ""])

    def _explanation(self) -> list[str]:
        joints = "; ".join(
            f"q_{k + 1} {joint.name}" + (f" less {joint.reference:g}" if joint.reference else "")
            for k, joint in enumerate(self._model.joints)
        )
        lines = [f"% Joints: {joints}; c = cos q, s = sin q." if joints else "% No joints."]
        if self._model.free:
            lines += [
                r"% \omega: angular velocity of the base in its own axes; the centre of mass is at",
                "% rest or falls freely. tau: zero for omega, then the joint torques, springs",
                "% and dampers among them. m: the mass of all.",
            ]
        else:
            lines.append(
                "% Gravity g acts along -3. tau: the joint torques, springs and dampers too."
            )
        return lines

    def _table(self) -> list[str]:
        if not self._values:
            return []
        rows = [
            rf"{self._sp.latex(symbol)} &= {value:.6g}" for symbol, value in self._values.items()
        ]
        return [r"\begin{align*}", " \\\\\n".join(rows), r"\end{align*}"]

    # ------------------------------------------------------------------------ symbols

    def _open_numbers(self) -> dict[str, Any]:
        """A symbol for every number that is not zero; mirrored bodies share theirs."""
        shared = self._shared_names()
        symbols: dict[str, Any] = {}
        for body, kind, part, value in body_numbers(self._model):
            if value == 0.0:
                continue
            name = body_parameter(body.name, kind, part)
            letter = {"mass": "m", "com": "r", "inertia": "I", "position": "p"}[kind]
            key = _symbol(letter, shared.get(body.name, body.name), part)
            known = self._names.get(key)
            if known is not None and abs(abs(self._values[known[1]]) - abs(value)) < 1e-12:
                same = self._values[known[1]] * value > 0
                symbols[name] = known[0] if same else -known[0]
                continue
            if known is not None:
                key = _symbol(letter, body.name, part)
            pair = (ca.SX.sym(key), self._sp.Symbol(key, real=True))
            self._names[key] = pair
            self._values[pair[1]] = value
            symbols[name] = pair[0]
        return symbols

    def _shared_names(self) -> dict[str, str]:
        """Body name to the name it shares with its mirror image."""
        owners = [body.name for body in self._model.bodies for j in body.joints for _ in [j]]
        result: dict[str, str] = {}
        for pair in mirror_pairs(self._model):
            if pair.left != pair.right:
                left, right = owners[pair.left], owners[pair.right]
                result[left] = result[right] = common_name(left, right)
        return result

    def _all_letters(self) -> dict[str, Any]:
        sp = self._sp
        letters = {pair[0].name(): pair[1] for pair in self._names.values()}
        for k in range(self._q.numel()):
            letters[self._q[k].name()] = sp.Symbol(f"q_{k + 1}", real=True)
            letters[self._u[k].name()] = sp.Symbol(rf"\dot q_{k + 1}", real=True)
        for k in range(3):
            letters[self._w[k].name()] = sp.Symbol(rf"\omega_{k + 1}", real=True)
        for name in ("g", "m"):
            letters[name] = sp.Symbol(name, real=True)
        return letters

    def _speed_letters(self) -> list[str]:
        joints = [self._sp.latex(self._letters[self._u[k].name()]) for k in range(self._u.numel())]
        return [r"\omega_1", r"\omega_2", r"\omega_3", *joints] if self._model.free else joints

    # ----------------------------------------------------------------------- equations

    def _mass_and_bias(self) -> tuple[Any, Any]:
        """M and b with the base's translation eliminated, as sympy matrices."""
        count = len(self._model.speeds)
        rates = ca.SX.sym("a", 3 + count)
        loads = ca.vertcat(*self._loads([rates[k] for k in range(3 + count)]))
        mass = ca.jacobian(loads, rates)
        bias = ca.substitute(loads, rates, ca.SX.zeros(3 + count))
        if not self._model.free:
            mass, bias = mass[3:, 3:], bias[3:]
        return self._translated(mass), self._translated(bias)

    def _loads(self, rates: list[Any]) -> list[Any]:
        w, u = ([v[k] for k in range(v.numel())] for v in (self._w, self._u))
        q = [self._q[k] + joint.reference for k, joint in enumerate(self._model.joints)]
        if not self._model.free:
            up = [0.0, 0.0, self._g]
            still: Vec = [0.0] * 3
            return [*still, *inverse_dynamics(self._tree, q, still, u, still, up, rates[3:])[2]]

        def needed(a: Vec) -> tuple[Vec, Vec, list[Any]]:
            return inverse_dynamics(self._tree, q, w, u, rates[:3], a, rates[3:])

        _, force, _ = needed([0.0, 0.0, 0.0])
        whole = self._m if len(self._model.bodies) > 1 else self._tree.mass
        moment, _, torques = needed(scale(-1.0 / whole, force))
        return [*moment, *torques]

    def _translated(self, matrix: Any) -> Any:
        """A CasADi matrix as a sympy one, by walking its instructions."""
        sp = self._sp
        inputs = ca.symvar(matrix)
        f = ca.Function("f", inputs, [ca.densify(matrix)])
        letters = [self._letters[symbol.name()] for symbol in inputs]
        result = sp.zeros(*matrix.shape)
        slots: dict[int, Any] = {}
        counts: dict[int, int] = {}  # of operations, were each written wherever it is used
        operations = {
            ca.OP_ADD: lambda a, b: a + b,
            ca.OP_SUB: lambda a, b: a - b,
            ca.OP_MUL: lambda a, b: a * b,
            ca.OP_DIV: lambda a, b: a / b,
            ca.OP_NEG: lambda a: -a,
            ca.OP_SQ: lambda a: a * a,
            ca.OP_TWICE: lambda a: 2 * a,
            ca.OP_INV: lambda a: 1 / a,
            ca.OP_SIN: sp.sin,
            ca.OP_COS: sp.cos,
        }
        for k in range(f.n_instructions()):
            operation = f.instruction_id(k)
            ins, outs = f.instruction_input(k), f.instruction_output(k)
            if operation in (ca.OP_INPUT, ca.OP_CONST):
                counts[outs[0]] = 0
            if operation == ca.OP_INPUT:
                slots[outs[0]] = letters[ins[0]]
            elif operation == ca.OP_CONST:
                slots[outs[0]] = sp.nsimplify(f.instruction_constant(k), rational=True)
            elif operation == ca.OP_OUTPUT:
                row, column = outs[1] % matrix.shape[0], outs[1] // matrix.shape[0]
                result[row, column] = slots[ins[0]]
                if counts.get(ins[0], 0) > _MOST_OPERATIONS:
                    raise _too_long(self._model)
            else:
                counts[outs[0]] = 1 + sum(counts.get(i, 0) for i in ins)
                slots[outs[0]] = operations[operation](*[slots[i] for i in ins])
        return result

    def _tidy(self, entry: Any) -> Any:
        """Multiplied out in c = cos q and s = sin q, and gathered by the speeds' products."""
        sp = self._sp
        for k in range(self._q.numel()):
            angle = self._letters[self._q[k].name()]
            c, s = sp.Symbol(f"c_{k + 1}"), sp.Symbol(f"s_{k + 1}")
            entry = sp.expand(entry.subs({sp.sin(angle): s, sp.cos(angle): c}))
            entry = sp.rem(entry, s**2 + c**2 - 1, s) if entry.has(s) else entry
        entry = sp.expand(entry)
        speeds = [self._letters[v[k].name()] for v in (self._w, self._u) for k in range(v.numel())]
        present = [speed for speed in speeds if entry.has(speed)]
        if not present:
            return sp.factor_terms(entry)
        terms = sp.Poly(entry, *present).terms()
        return sp.Add(
            *(
                sp.Mul(sp.factor(factor), *(x**n for x, n in zip(present, powers, strict=True)))
                for powers, factor in terms
            ),
            evaluate=False,
        )


def _symbol(letter: str, body: str, part: str) -> str:
    subscript = rf"\mathrm{{{_tex(body)}}}" + (f",{part}" if part else "")
    return f"{letter}_{{{subscript}}}"


def _tex(name: str) -> str:
    words = re.sub(r"[_\-. ]+", r"\\ ", name)
    return re.sub(r"([#$%&{}])", r"\\\1", words)
