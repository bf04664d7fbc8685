"""Small numbered pages: what a farm gets."""

from __future__ import annotations

import cv2
import numpy as np


def make_frames(folder, numbers):
    folder.mkdir()
    for k in numbers:
        image = np.full((120, 120), 255, np.uint8)
        cv2.line(image, (15, 20 + k), (105, 40 + k), 0, 3, cv2.LINE_AA)
        cv2.line(image, (20 + k, 105), (60 + k, 70), 0, 3, cv2.LINE_AA)
        cv2.imwrite(str(folder / f"walk_{k:04d}.png"), image)
