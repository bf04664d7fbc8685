"""The perspective of a photographed sheet taken out: its four corners become those of a rectangle.

Only where the outline of the sheet leaves no doubt: four straight sides, all corners in the
picture. The sheet stays where it was and as large as it was; what is drawn on it has right angles
and true proportions again.
"""

from __future__ import annotations

from dataclasses import replace

import cv2
import numpy as np

from ..arrays.sampling import sample
from ..values import Array
from .picture import darkest_gray, unit
from .sheet import Sheet

_ROUGHLY = 0.025  # of the longer side: how far the outline may run beside four straight lines
_ACROSS = 0.02  # of the longer side: how far from these the edge itself is looked for
_STRAIGHT = 0.0025  # of the longer side: how far the edge may be off the line that it is
_MOST = 0.75  # of the edge that is no farther off
_INSIDE = 0.004  # of the longer side: how far all corners lie within the picture
_SAMPLES = 96  # places along a side at which its edge is looked for
_MIDDLE = 0.08, 0.92  # of a side: where; corners are round or bent
_KNOWN = (2**0.5, 11 / 8.5, 1.0)  # long side by short side: A4 and the like, letter, square
_NEARLY = 0.07  # of such a proportion: how far the measured one may be off


_USUAL, _FOCAL = 0.85, (0.6, 1.5)  # focal length of telephones, times the longer side
_FAR = 0.05  # of the way along a side that the sides beside it get narrower: else they are parallel


def corners_of(sheet: Sheet, picture: Array) -> Array | None:
    """The corners of a sheet, (4, 2) px: as one reads them, from the upper left clockwise; None
    where they are not sure.

    Args:
        picture: (H, W) or (H, W, 3), with what lies beyond the sheet.
    """
    few = _quadrangle(sheet.outline)
    if few is None:
        return None
    size = np.array(picture.shape[1::-1], np.float32)
    longer = float(size.max())
    gray = unit(darkest_gray(picture))
    lines = [
        _edge(gray, a, b, few.mean(0), longer)
        for a, b in zip(few, np.roll(few, -1, 0), strict=True)
    ]
    if any(line is None for line in lines):
        return None
    found = _meetings(np.array(lines))
    if found is None or np.minimum(found, size - found).min() < _INSIDE * longer:
        return None
    return _from_upper_left(found)


def _quadrangle(outline: Array) -> Array | None:
    """The four corners of a convex outline (N, 2), about; None where it has others."""
    length = cv2.arcLength(outline[:, None], True)
    for loose in (0.01, 0.02, 0.03, 0.04):
        few = cv2.approxPolyDP(outline[:, None], loose * length, True)[:, 0]
        if len(few) <= 4:
            break
    if len(few) != 4 or not cv2.isContourConvex(few[:, None]):
        return None
    sides = zip(few, np.roll(few, -1, 0), strict=True)
    off = np.min([np.abs(_beside(outline, a, b)) for a, b in sides], axis=0)
    return few if off.max() < _ROUGHLY * length / 4 else None


def _beside(points: Array, a: Array, b: Array) -> Array:
    """(N,) how far points lie beside the line from a to b, px."""
    way = b - a
    return (points - a) @ np.array([-way[1], way[0]]) / np.hypot(*way)


def _edge(gray: Array, a: Array, b: Array, inner: Array, longer: float) -> Array | None:
    """(3,) the line n x = d along the edge of the sheet near a side, where it gets darkest across;
    None where it is not straight."""
    t = np.linspace(*_MIDDLE, _SAMPLES)[:, None]
    along = a + t * (b - a)
    out = np.array([b[1] - a[1], a[0] - b[0]]) / np.hypot(*(b - a))
    out = out if out @ (along.mean(0) - inner) > 0 else -out
    reach = round(_ACROSS * longer)
    step = np.arange(-2 * reach, 2 * reach + 1)
    light = sample(gray, along[:, None] + step[None, :, None] * out)
    total = np.cumsum(np.pad(light, ((0, 0), (1, 0))), axis=1)
    wide = max(2, reach // 2)  # px on either side that are compared
    at = np.arange(wide, light.shape[1] - wide + 1)
    falls = 2 * total[:, at] - total[:, at - wide] - total[:, at + wide]
    points = along + (step[0] + at[falls.argmax(1)] - 0.5)[:, None] * out
    dx, dy, x, y = cv2.fitLine(points.astype(np.float32), cv2.DIST_HUBER, 0, 0.01, 0.01).ravel()
    off = np.abs((points - (x, y)) @ np.array([-dy, dx]))
    if np.mean(off < max(1.0, _STRAIGHT * longer)) < _MOST:
        return None
    return np.array([-dy, dx, -dy * x + dx * y])


def _meetings(lines: Array) -> Array | None:
    """Where the lines (4, 3) meet one after the other, (4, 2) float32; None where they don't."""
    found = []
    for one, other in zip(np.roll(lines, 1, 0), lines, strict=True):
        both = np.array([one, other])
        if abs(np.linalg.det(both[:, :2])) < 0.2:
            return None
        found.append(np.linalg.solve(both[:, :2], both[:, 2]))
    return np.array(found, np.float32)


def askew(corners: Array) -> float:
    """By how many degrees the corner that is farthest from a right angle misses it."""
    way = np.roll(corners, -1, 0) - corners
    way = way / np.hypot(*way.T)[:, None]
    return float(np.degrees(np.arcsin(np.abs((way * np.roll(way, 1, 0)).sum(1)).max())))


def straightened(picture: Array, sheet: Sheet, corners: Array) -> tuple[Array, Sheet]:
    """The picture as it were seen from straight above its sheet, and the sheet on it."""
    height, width = picture.shape[:2]
    target = _rectangle(corners, (width, height))
    # Our pixel centres lie at +0.5, OpenCV's at 0.
    way = cv2.getPerspectiveTransform(corners - np.float32(0.5), target - np.float32(0.5))
    flat = cv2.warpPerspective(
        picture, way, (width, height), flags=cv2.INTER_CUBIC, borderMode=cv2.BORDER_REPLICATE
    )
    small = sheet.beyond.shape
    shrink = np.diag([width / small[1], height / small[0], 1.0])
    beyond = cv2.warpPerspective(
        sheet.beyond.view(np.uint8),
        np.linalg.inv(shrink) @ way @ shrink,
        small[::-1],
        flags=cv2.INTER_NEAREST,
        borderValue=1,
    )
    return flat, replace(sheet, outline=target, beyond=beyond > 0)


def _from_upper_left(corners: Array) -> Array:
    """The corners clockwise, the first at the left end of the side that is uppermost."""
    way = np.roll(corners, -1, 0) - corners
    if way[0, 0] * way[1, 1] - way[0, 1] * way[1, 0] < 0:
        corners = corners[::-1]
        way = np.roll(corners, -1, 0) - corners
    return np.roll(corners, -int((way[:, 0] / np.hypot(*way.T)).argmax()), 0)


def _rectangle(corners: Array, size: tuple[int, int]) -> Array:
    """(4, 2) float32: the corners of the sheet seen from above, as large and in the same place; as
    much smaller as it takes to fit into the picture."""
    across = _proportion(corners, size)
    area = cv2.contourArea(corners)
    sides = np.array([(area * across) ** 0.5, (area / across) ** 0.5])
    sides *= min(1.0, *(np.array(size) / sides))
    middle = np.clip(corners.mean(0), sides / 2, np.array(size) - sides / 2)
    unit = np.array([(-1, -1), (1, -1), (1, 1), (-1, 1)])
    return (middle + unit * sides / 2).astype(np.float32)


def _proportion(corners: Array, size: tuple[int, int]) -> float:
    """Width by height of a sheet seen in perspective, from the lens's point of view.

    Zhang and He, "Whiteboard scanning and image enhancement", 2007: the two vanishing points of a
    rectangle give the focal length when the middle of the picture is that of the lens. Where sides
    are nearly parallel they don't, and it is that of a telephone.
    """
    a, b, d, c = (np.append(p - np.array(size) / 2, 1.0) for p in corners[[0, 1, 3, 2]])
    k = np.cross(a, c) @ d / (np.cross(b, c) @ d)
    m = np.cross(a, c) @ b / (np.cross(d, c) @ b)
    u, v = k * b - a, m * d - a
    focal = _USUAL * max(size)
    if min(abs(u[2]), abs(v[2])) > _FAR:
        squared = -(u[0] * v[0] + u[1] * v[1]) / (u[2] * v[2])
        shortest, longest = (k * max(size) for k in _FOCAL)
        focal = min(max(max(squared, 0.0) ** 0.5, shortest), longest)
    lens = np.array([focal**-2, focal**-2, 1.0])
    found = float((lens * u**2).sum() / (lens * v**2).sum()) ** 0.5
    known = [p for q in _KNOWN for p in (q, 1 / q) if abs(found / p - 1) < _NEARLY]
    return min(known, key=lambda p: abs(found / p - 1), default=found)


__all__ = ["askew", "corners_of", "straightened"]
