"""A law as a formula in text: what may stand in it, and its value in symbols.

A formula is read with Python's own grammar, of which only arithmetic is let in: nothing is run.
"""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any

import casadi as ca
import numpy as np

from somersault._core.checks import by_name, text
from somersault._core.errors import SomersaultError
from somersault._core.numbers import number

_MOST_CHARACTERS = 2_000
_MOST_PARTS = 500


def wrapped(angle: Any) -> Any:
    """An angle without its whole turns.

    Parameters
    ----------
    angle : casadi.SX or float
        rad.

    Returns
    -------
    casadi.SX or float
        From −π to below π.

    Examples
    --------
    >>> from somersault.laws import wrapped
    >>> round(wrapped(7.0), 4)
    0.7168
    """
    return angle - 2 * np.pi * ca.floor(angle / (2 * np.pi) + 0.5)


# What is no number stays none, so that a law that gives none ends the flight.


def _least(a: Any, b: Any) -> Any:
    return _first(a, b, a <= b, b <= a)


def _greatest(a: Any, b: Any) -> Any:
    return _first(a, b, a >= b, b >= a)


def _first(a: Any, b: Any, this: Any, that: Any) -> Any:
    """`a` if `this` is true, `b` if `that` is."""
    return ca.if_else(this, a, ca.if_else(that, b, a + b))


def _chosen(condition: Any, yes: Any, no: Any) -> Any:
    either = ca.if_else(condition < 0, yes, ca.if_else(condition >= 0, no, condition))
    return ca.if_else(condition > 0, yes, either)


def _compared(is_so: Any, is_not: Any, a: Any, b: Any) -> Any:
    """1 or 0, or no number."""
    return ca.if_else(is_so, 1.0, ca.if_else(is_not, 0.0, a - b))


_FUNCTIONS: dict[str, tuple[int, Callable[..., Any]]] = {
    "sin": (1, ca.sin),
    "cos": (1, ca.cos),
    "atan2": (2, ca.atan2),
    "sqrt": (1, ca.sqrt),
    "abs": (1, ca.fabs),
    "sign": (1, lambda x: ca.if_else(x > 0, 1.0, ca.if_else(x < 0, -1.0, x))),
    "min": (2, _least),
    "max": (2, _greatest),
    "clip": (3, lambda x, low, high: _least(_greatest(x, low), high)),
    "wrap": (1, wrapped),
    "where": (3, _chosen),
}
_OPERATIONS: dict[type[ast.AST], Callable[..., Any]] = {
    ast.Add: lambda a, b: a + b,
    ast.Sub: lambda a, b: a - b,
    ast.Mult: lambda a, b: a * b,
    ast.Div: lambda a, b: a / b,
    ast.UAdd: lambda a: a,
    ast.USub: lambda a: -a,
    ast.Lt: lambda a, b: _compared(a < b, a >= b, a, b),
    ast.LtE: lambda a, b: _compared(a <= b, a > b, a, b),
    ast.Gt: lambda a, b: _compared(a > b, a <= b, a, b),
    ast.GtE: lambda a, b: _compared(a >= b, a < b, a, b),
}
_CONSTANTS = {"pi": np.pi}


@dataclass(frozen=True)
class Formula:
    """A number that follows from others, by their names: "-k * twist - c * twist_rate".

    It has numbers, names, + − * / and whole powers, comparisons, brackets, `pi`, and the functions
    sin, cos, atan2, sqrt, abs, sign, min, max, clip(x, low, high), wrap(angle), which leaves whole
    turns out, and where(condition, yes, no). A name that Python would not have stands in quotes.

    Parameters
    ----------
    text : str

    Raises
    ------
    SomersaultError
        For what is no such formula.

    Examples
    --------
    >>> from somersault.laws import Formula
    >>> law = Formula("-k * twist - c * twist_rate")
    >>> sorted(law.names)
    ['c', 'k', 'twist', 'twist_rate']
    >>> float(law.value({"k": 2.0, "c": 0.5, "twist": 0.1, "twist_rate": -0.2}))
    -0.1
    """

    text: str

    def __post_init__(self) -> None:
        if len(text("a law", self.text)) > _MOST_CHARACTERS:
            raise SomersaultError(
                f"a law of {len(self.text)} characters is longer than {_MOST_CHARACTERS}; shorten "
                "it"
            )
        _ = self.names

    @cached_property
    def _tree(self) -> ast.expr:
        try:
            tree = ast.parse(self.text.strip(), mode="eval").body
        except (SyntaxError, ValueError, RecursionError, MemoryError):
            raise SomersaultError(
                f"the law {self.text!r} is no formula; write one like -k * twist - c * twist_rate"
            ) from None
        if sum(1 for _ in ast.walk(tree)) > _MOST_PARTS:
            raise SomersaultError(
                f"the law {self.text[:40]!r}… has more than {_MOST_PARTS} parts; make it simpler"
            )
        return tree

    @property
    def names(self) -> frozenset[str]:
        """Those of the numbers that it follows from."""
        return _names(self)

    def value(self, known: Mapping[str, Any]) -> Any:
        """Its value.

        Parameters
        ----------
        known : mapping of str to float or casadi.SX
            The numbers of its `names`.

        Returns
        -------
        casadi.SX

        Raises
        ------
        SomersaultError
            For a name that is not among them.
        """
        given = by_name("known", known)

        def named(name: str) -> Any:
            if name not in given:
                raise SomersaultError(
                    f"the law {self.text!r} has {name}, which is neither a gain nor sensed; there "
                    f"are {', '.join(given)}"
                )
            return given[name]

        return ca.SX(self._value(self._tree, named))

    def renamed(self, names: Mapping[str, str], sign: float = 1.0) -> Formula:
        """The same with other names in it, each of which may be a formula.

        Parameters
        ----------
        names : mapping of str to str
            What stands in the place of a name; names that are not there stay.
        sign : float
            1, or −1 for the opposite.

        Returns
        -------
        Formula

        Examples
        --------
        >>> from somersault.laws import Formula
        >>> Formula("k * twist").renamed({"twist": "-twist"}).text
        'k * -twist'
        """
        others = {
            name: Formula(text(f"names.{name}", x)) for name, x in by_name("names", names).items()
        }

        class Renaming(ast.NodeTransformer):
            def visit_Call(self, node: ast.Call) -> ast.AST:
                # Its function is no name of a number.
                node.args = [self.visit(part) for part in node.args]
                return node

            def visit_Name(self, node: ast.Name) -> ast.AST:
                return self._instead(node, node.id)

            def visit_Constant(self, node: ast.Constant) -> ast.AST:
                return self._instead(node, node.value)

            def _instead(self, node: ast.expr, name: Any) -> ast.AST:
                if isinstance(name, str) and name in others:
                    return others[name]._tree
                return node

        tree = Renaming().visit(ast.parse(self.text.strip(), mode="eval").body)
        if number("sign", sign) < 0:
            tree = ast.UnaryOp(ast.USub(), tree)
        return Formula(ast.unparse(tree))

    def _value(self, node: ast.AST, named: Callable[[str], Any]) -> Any:
        inner = [
            self._value(part, named)
            for part in ast.iter_child_nodes(node)
            if isinstance(part, ast.expr) and not _is_function(part, node)
        ]
        match node:
            case ast.Constant(value=str(name)):
                return named(name)
            case ast.Constant(value=int() | float() as number) if not isinstance(number, bool):
                return self._finite(number)
            case ast.Name(id=name):
                return _CONSTANTS[name] if name in _CONSTANTS else named(name)
            case ast.BinOp(op=ast.Pow(), right=ast.Constant(value=int(power))) if 0 < power < 10:
                return _product([inner[0]] * power)
            case ast.BinOp(op=ast.Div()) if ca.SX(inner[1]).is_zero():
                raise SomersaultError(
                    f"the law {self.text[:40]!r} divides by {ast.unparse(node.right)}, which is 0; "
                    "correct it"
                )
            case ast.BinOp(op=operation) | ast.UnaryOp(op=operation):
                if type(operation) in _OPERATIONS:
                    return _OPERATIONS[type(operation)](*map(ca.SX, inner))
            case ast.Compare(ops=[operation]) if type(operation) in _OPERATIONS:
                return _OPERATIONS[type(operation)](*map(ca.SX, inner))
            case ast.Call(func=ast.Name(id=name), keywords=[]) if name in _FUNCTIONS:
                count, function = _FUNCTIONS[name]
                if len(inner) == count:
                    return function(*map(ca.SX, inner))
                raise SomersaultError(
                    f"the law {self.text!r} has {name} of {len(inner)} numbers; it takes {count}"
                )
            case ast.Call(func=ast.Name(id=name)):
                raise SomersaultError(
                    f"the law {self.text!r} has the function {name}; there are "
                    f"{', '.join(_FUNCTIONS)}"
                )
        raise SomersaultError(
            f"the law {self.text!r} has {ast.unparse(node)!r}, which is more than a formula may "
            "have: numbers, names, + - * /, whole powers, comparisons and functions"
        )

    def _finite(self, number: float) -> float:
        try:
            if np.isfinite(float(number)):
                return float(number)
        except OverflowError:
            pass
        raise SomersaultError(f"the law {self.text[:40]!r} has a number that is too great")


@lru_cache(maxsize=256)
def _names(formula: Formula) -> frozenset[str]:
    """Those in a formula, read once however often it is written."""
    found: set[str] = set()

    def note(name: str) -> Any:
        found.add(name)
        return ca.SX.sym(name)

    formula._value(formula._tree, note)
    return frozenset(found)


def _is_function(part: ast.AST, node: ast.AST) -> bool:
    return isinstance(node, ast.Call) and part is node.func


def _product(factors: list[Any]) -> Any:
    result = factors[0]
    for factor in factors[1:]:
        result = result * factor
    return result
