"""`somersault equations MODEL`: its equations of motion, as LaTeX or C."""

from __future__ import annotations

import argparse
from pathlib import Path

EXAMPLES = """examples:
  somersault equations book
  somersault equations simplest --out simplest.tex
  somersault equations my_robot.urdf --c --out my_robot.c"""


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """Declare the command's arguments."""
    parser.add_argument("model", metavar="MODEL", help="a shipped model's name or a model file")
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--latex", action="store_true", help="LaTeX (the default)")
    kind.add_argument("--c", action="store_true", help="C functions of every quantity")
    parser.add_argument("--out", type=Path, metavar="FILE", help="write to a file, .tex or .c")


def run(chosen: argparse.Namespace) -> None:
    """Print the equations or write them to a file."""
    from somersault._core.files import write
    from somersault._core.places import check_file
    from somersault.dynamics import c_code, latex
    from somersault.model import load

    if chosen.out is not None:
        check_file(chosen.out, (".c",) if chosen.c else (".tex",))
    model = load(chosen.model)
    text = c_code(model) if chosen.c else latex(model)
    if chosen.out is None:
        print(text, end="")
    else:
        write(chosen.out, text)
        print(f"{model.name}\n  equations: {chosen.out}")
