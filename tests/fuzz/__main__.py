"""Read hostile inputs, as many as one likes: python -m tests.fuzz --count 20000 --seed 1"""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from .readers import READERS
from .run import run

parser = argparse.ArgumentParser(prog="python -m tests.fuzz", description=__doc__)
parser.add_argument("--count", type=int, default=2000, help="inputs altogether")
parser.add_argument("--seed", type=int, default=1)
parser.add_argument("--reader", action="append", choices=tuple(READERS), help="these alone")
parser.add_argument("--jobs", type=int, default=os.cpu_count() or 1, help="processes at once")
parser.add_argument("--out", type=Path, help="a new folder for the inputs that fail")
given = parser.parse_args()
report = run(
    given.count,
    given.seed,
    tuple(given.reader or READERS),
    given.jobs,
    lambda line: print(line, flush=True),
)
if given.out is not None:
    report.write(given.out)
print(report)
sys.exit(bool(report.failures))
