"""Learns on which runs of a stroke a second one goes on."""
