"""Numbered drawings as keyframes of one object."""
