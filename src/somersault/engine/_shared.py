"""Vector code that makes a quotient's denominator and an angle's reduction only once."""

from __future__ import annotations

from somersault.engine._elementary import sine_cosine
from somersault.engine._vectors import Vectors, number


class Shared(Vectors):
    """Writes vector code; what was made before of the same value is taken again."""

    def __init__(self) -> None:
        super().__init__()
        self._inverses: dict[str, str] = {}
        self._sines_cosines: dict[str, tuple[str, str]] = {}

    def inverse(self, a: str) -> str:
        """1 / a."""
        if a not in self._inverses:
            self._inverses[a] = self.div(number(1.0), a)
        return self._inverses[a]

    def sine_cosine(self, a: str) -> tuple[str, str]:
        """sin a and cos a."""
        if a not in self._sines_cosines:
            self._sines_cosines[a] = sine_cosine(self, a)
        return self._sines_cosines[a]

    def holds(self, how: str, a: str, b: str) -> str:
        """1 where a comparison holds, else 0; `how` is LLVM's name of it."""
        return self.indicator(self.test(how, a, b))

    def true(self, a: str) -> str:
        """A mask of the lanes where a is not 0."""
        return self.test("une", a, number(0.0))

    def sign(self, a: str) -> str:
        """−1, 0 or 1."""
        return self.sub(self.holds("olt", number(0.0), a), self.holds("olt", a, number(0.0)))
