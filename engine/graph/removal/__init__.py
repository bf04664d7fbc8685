"""What goes from a graph because it is no stroke: one file and one `remove_*` for each reason.

Lengths are in widths of a line: of its ridge, which is the same on every page, before the ink is
measured (spurs, rungs); of the pen where the ink is looked at (undrawn, dust, stubs).
"""
