"""Learning to route: pages of true strokes, planar graphs, the network, its training and export."""
