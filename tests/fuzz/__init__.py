"""Hostile inputs for every reader of the package.

    python -m tests.fuzz --count 20000 --seed 1

Good files (`good.py`) are changed by `mutations.py` and `trees.py`, and read (`readers.py`) many to
a process (`child.py`), which `run.py` watches. Everything follows from a seed, the reader's name
and the input's number, so that any input can be had again.
"""
