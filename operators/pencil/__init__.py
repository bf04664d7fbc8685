"""Lines and their pencil strokes in a rough drawing: several become one, one becomes several."""
