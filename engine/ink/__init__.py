"""Ink: its colour, its density, and which ink a line was drawn with."""
