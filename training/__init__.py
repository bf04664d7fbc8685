"""Data, training and export of the two networks; not part of the extension."""
