"""What goes from a graph because it is no stroke: one file for each reason."""
