"""Everything that is done to the junctions of a traced drawing: one file per verb."""
