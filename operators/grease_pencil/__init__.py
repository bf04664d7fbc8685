"""The Grease Pencil data layer, the only one that touches strokes: arrays, splicing, state."""
