"""What lies below the strokes of a drawing in every format: layers of areas with their colors."""

from __future__ import annotations

import numpy as np

from ..drawing import Drawing
from ..values import Array

SOLIDS, REGIONS = "Solids", "Regions"  # the names of their layers

Area = tuple[tuple[Array, ...], tuple[int, int, int]]  # its rings and its color


def area_layers(drawing: Drawing) -> dict[str, list[Area]]:
    """The layers that are not empty, from below: the colored regions, and the solid areas."""
    layers: dict[str, list[Area]] = {}
    if drawing.settings.regions and drawing.regions:
        colors = drawing.region_colors
        if colors is None or len(colors) != len(drawing.regions):
            colors = np.full((len(drawing.regions), 3), 255, np.uint8)
        pairs = zip(drawing.regions, colors.tolist(), strict=True)
        layers[REGIONS] = [(region, (red, green, blue)) for region, (red, green, blue) in pairs]
    if drawing.fills:
        layers[SOLIDS] = [(fill, (0, 0, 0)) for fill in drawing.fills]
    return layers
