"""cable_convert: scenes from cables of other programs; see command.py."""
