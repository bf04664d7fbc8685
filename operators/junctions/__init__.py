"""What is done to the junctions of a traced drawing: one file per verb.

`junction_operator` is what the verbs share, `card_choice` what those share that open cards. Each
goes through `grease_pencil.routing_change`.
"""
