"""The pure core of rerouting: arrays in, edits out; nothing here imports Blender.

pixel_map       pixels of a drawing <-> the space of its object
map_fit         where the pixels lie now, looked up from the strokes
stroke_arrays   strokes and their attributes as arrays
stretches       what stays whole of strokes when junctions are rerouted
pieces          cutting and joining strokes, with all attributes of their points
crossed         where a swipe crosses strokes, and cutting there
hand_edits      what the artist did to strokes, when the page is traced again
regraphed       strokes of before a cut or a join, on the graph of after it
splice          `plan`: from one routing to another, as edits of cels
"""
