"""What is looked at and where it lies on the screen; below the verbs and `ui`, which draws it.

view_state       the current junction, the preview, the filters; not saved, not undone
junction_table   all junctions of a drawing as arrays: lists and filters
junction_words   how people read a junction: letters, arrows, percentages
card_layout      where the cards of the alternatives lie (arithmetic)
picking          projecting and picking (arithmetic)
alike            which junctions look like one another (arithmetic)
following        which lines a gesture follows (arithmetic)
framing          look straight at a drawing
on_screen        both, for what a region shows
"""
