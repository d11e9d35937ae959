"""The command `marbles`."""

from __future__ import annotations

import signal
import sys

from . import _native


def main() -> int:
    """Runs the command with the arguments of the process. Returns the exit code."""
    # Python would notice Ctrl-C only when the command has ended.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _native.run(["marbles", *sys.argv[1:]])
