#!/usr/bin/python3
"""refuse.py MESSAGE: says what is wrong with an argument of a launch file, and fails. A launch file starts it as a required node."""
import sys

sys.exit(sys.argv[1])
