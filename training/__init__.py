"""Data, training and export of the networks; not part of the extension."""
