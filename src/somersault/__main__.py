"""`python -m somersault` is the command `somersault`."""

import sys

from somersault.cli import main

sys.exit(main())
