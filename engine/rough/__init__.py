"""Rough drawings: many pencil strokes say one line."""
