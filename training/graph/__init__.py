"""Training of what the graph stage learns."""
