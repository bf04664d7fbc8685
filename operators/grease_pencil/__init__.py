"""The Grease Pencil data layer: nothing else reads or writes strokes.

core             pure NumPy: strokes as arrays, and the plan of what a rerouting changes
cels             the strokes of one layer at one keyframe <-> arrays
writing          a whole drawing -> layers, keyframes, materials
state            what the data-block remembers of its traces
stored_trace     how one of them is encoded, and decoded with every check
change           what the artist has changed since the trace, in few bytes
saving           before a file is saved, data-blocks adopt what their strokes need
routing_change   the one way in for everything that changes a routing: state and strokes
retracing        another trace of the same picture, or one cleaned again; the artist's work stays
vertex_weights   the weights that artists paint, which only geometry nodes can tell
"""
