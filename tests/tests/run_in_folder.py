"""Runs a script in a folder.

Usage: run_in_folder.py FOLDER SCRIPT
"""

import os
import runpy
import sys

os.chdir(sys.argv[1])
runpy.run_path(sys.argv[2])
