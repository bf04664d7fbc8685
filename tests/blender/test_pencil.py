"""Pencil under ink comes to a layer and a material of its own."""

from __future__ import annotations

import numpy as np


def test_pencil_under_ink_is_a_gray_layer(bpy, part, tmp_path):
    part("engine.scan")  # brings OpenCV
    import cv2

    page = np.full((300, 400), 245.0)
    pencil = [((30, 150), (370, 160)), ((190, 20), (210, 280)), ((40, 40), (360, 260))]
    ink = [((50, 60), (350, 90)), ((60, 240), (340, 200)), ((100, 50), (120, 250))]
    for lines, darkness in ((pencil, 0.35), (ink, 0.9)):
        for start, end in lines:
            share = np.zeros(page.shape, np.uint8)
            cv2.line(share, start, end, 255, 4, cv2.LINE_AA)
            page *= 1 - darkness * cv2.GaussianBlur(share / 255, (0, 0), 0.7)
    page += np.random.default_rng(0).normal(0, 2, page.shape)
    cv2.imwrite(str(tmp_path / "page.png"), np.clip(page, 0, 255).astype(np.uint8))

    quick = {"provider": "classical", "router": "geometric"}
    bpy.ops.involute.trace(filepath=str(tmp_path / "page.png"), **quick)
    data = bpy.context.active_object.data
    assert {layer.name for layer in data.layers} == {"Black", "Gray"}
    assert {material.name for material in data.materials} == {"Black", "Gray"}
    bpy.ops.involute.trace(filepath=str(tmp_path / "page.png"), ignore_inks={"gray"}, **quick)
    data = bpy.context.active_object.data
    assert [layer.name for layer in data.layers] == ["Black"]
