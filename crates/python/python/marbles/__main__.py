"""The command as a module: `python -m marbles`."""

import sys

from .command import main

sys.exit(main())
