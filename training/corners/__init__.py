"""Learns where the pen was lifted."""
