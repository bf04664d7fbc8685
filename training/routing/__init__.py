"""Data and training for routing: which half-branches continue in which."""
