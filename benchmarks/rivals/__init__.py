"""Other ways from a scan to strokes, each in a file of its own, for the benchmark to set beside us.

A rival is a function of the path of an image that gives its strokes: (N, 2) polylines in px of
the image, y down; a closed stroke repeats its first point.
"""
