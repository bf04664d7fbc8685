"""DXF for CAD programs, cutters and plotters, in mm with y up: a layer per ink.

Polylines carry their width at every point; Bezier strokes become splines, which have none in DXF:
the lineweight nearest to their mean width stands for it. Solid areas become solid hatches.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import ezdxf
import numpy as np
from ezdxf import colors, units
from ezdxf.document import Drawing as Document
from ezdxf.layouts import Modelspace
from ezdxf.lldxf import const

from ..drawing import Drawing
from ..strokes.small_parts import layers_of
from ..values import Array, Stroke
from .areas import SOLIDS
from .flatten import controls

_VERSION = "R2010"  # the oldest with hatches, true colors and lineweights that all programs read


def write(drawing: Drawing, path: Path) -> None:
    """Write the strokes and solid areas of a drawing to a DXF file."""
    with _without_time():
        document = ezdxf.new(_VERSION, units=units.MM)
        _fill(document, drawing)
        # ezdxf would add these in the order of a set, which differs from process to process.
        for name in sorted(document.entitydb.dxf_types_in_use()):
            document.classes.add_class(name)
        document.saveas(path)


@contextmanager
def _without_time() -> Iterator[None]:
    """No time of day and no random names: the same drawing gives the same bytes."""
    before = ezdxf.options.write_fixed_meta_data_for_testing
    ezdxf.options.write_fixed_meta_data_for_testing = True
    try:
        yield
    finally:
        ezdxf.options.write_fixed_meta_data_for_testing = before


def _fill(document: Document, drawing: Drawing) -> None:
    space, mm = document.modelspace(), drawing.mm_per_px
    width, height = (side * mm for side in drawing.size)

    def placed(points: Array) -> Array:
        """Millimetres, the page's lower left corner at the origin."""
        return points.astype(np.float64) * (mm, -mm) + (0.0, height)

    document.header["$EXTMIN"], document.header["$EXTMAX"] = (0, 0, 0), (width, height, 0)
    document.header["$LWDISPLAY"] = 1
    space.reset_extents((0, 0, 0), (width, height, 0))
    if drawing.fills:
        document.layers.add(SOLIDS)
        for fill in drawing.fills:
            _add_area(space, [placed(ring) for ring in fill])
    for ink in layers_of(drawing):
        document.layers.add(ink.name, true_color=colors.rgb2int(ink.color))
        for number in ink.numbers:
            stroke = drawing.strokes[number]
            if stroke.handles is None:
                _add_polyline(space, ink.name, placed(stroke.points), stroke, mm)
            else:
                _add_spline(space, ink.name, placed(controls(stroke)), stroke, mm)


def _add_polyline(space: Modelspace, layer: str, line: Array, stroke: Stroke, mm: float) -> None:
    """A polyline whose width runs evenly from each point to the next."""
    widths = stroke.widths.astype(np.float64) * mm
    rows = np.column_stack([line, widths, np.roll(widths, -1)]).round(5)
    if not stroke.closed:
        rows[-1, 3] = rows[-1, 2]
    space.add_lwpolyline(
        rows.tolist(), format="xyse", close=stroke.closed, dxfattribs={"layer": layer}
    )


def _add_spline(space: Modelspace, layer: str, points: Array, stroke: Stroke, mm: float) -> None:
    """Bezier segments as one cubic B-spline whose knots are threefold at the anchors."""
    weight = float(stroke.widths.mean()) * mm * 100  # hundredths of a mm
    weight = min(const.VALID_DXF_LINEWEIGHTS, key=lambda known: abs(known - weight))
    spline = space.add_spline(degree=3, dxfattribs={"layer": layer, "lineweight": weight})
    segments = (len(points) - 1) // 3
    spline.control_points = np.column_stack([points, np.zeros(len(points))]).round(5).tolist()
    spline.knots = [0.0, *np.repeat(np.arange(segments + 1.0), 3).tolist(), float(segments)]


def _add_area(space: Modelspace, rings: list[Array]) -> None:
    hatch = space.add_hatch(color=7, dxfattribs={"layer": SOLIDS})
    for number, ring in enumerate(rings):
        flags = const.BOUNDARY_PATH_OUTERMOST if number else const.BOUNDARY_PATH_EXTERNAL
        hatch.paths.add_polyline_path(ring.round(5).tolist(), is_closed=True, flags=flags)
