"""True drawings for training: taken from public packages of vector artwork, one polyline a stroke.

python -m involute.training.drawings.rebuild --out DATA
"""
