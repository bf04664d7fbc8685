"""What is drawn over the viewport; where it lies is worked out in `operators.view`.

overlay            the handlers: rings and the lines of the current junction
cards              the letters and the cards of the alternatives
overlay_geometry   lines and rings as arrays
colors             colours, readable for the colour-blind
drawn_batches      what was made for one redraw is kept for the next
"""
