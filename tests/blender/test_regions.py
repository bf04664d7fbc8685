"""Fills of closed regions lie on a layer below the lines, in the colour of the page."""

from __future__ import annotations

import numpy as np


def test_regions_are_filled_in_the_colours_of_the_page(bpy, part, tmp_path):
    part("engine.scan")  # brings OpenCV
    import cv2

    page = np.full((240, 320, 3), (235, 244, 248), np.uint8)
    cv2.rectangle(page, (40, 60), (140, 180), (140, 150, 236), cv2.FILLED)  # painted red
    for left in (40, 180):
        cv2.rectangle(page, (left, 60), (left + 100, 180), (30, 30, 30), 3, cv2.LINE_AA)
    cv2.imwrite(str(tmp_path / "page.png"), page)
    quick = {"provider": "classical", "router": "geometric", "solids": False}
    bpy.ops.involute.trace(filepath=str(tmp_path / "page.png"), regions=True, **quick)
    data = bpy.context.active_object.data
    assert data.layers[0].name == "Regions"
    assert len(data.layers) > 1
    gp = part("operators.grease_pencil.cels")
    curves = gp.read(data.layers[0].frames[0].drawing)
    assert len(curves) == 2
    assert curves.curve("cyclic").all()
    points = np.split(curves.point("position"), curves.offsets[1:-1])
    order = np.argsort([ring[:, 0].mean() for ring in points])
    red, white = curves.curve("fill_color")[order]
    assert red[0] > red[2] + 0.2
    assert red[3] == 1.0
    assert white[3] == 0.0  # the material's
