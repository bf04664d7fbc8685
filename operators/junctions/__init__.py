"""What is done to the junctions of a traced drawing: one file per verb.

`junction_operator` is what the verbs share; each goes through `grease_pencil.routing_change`.
"""
