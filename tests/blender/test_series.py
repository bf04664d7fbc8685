"""Random series of an artist's work: whatever comes after what, nothing is lost and nothing breaks.

A small version of a harness that ran a thousand of them; the seed is new each time, and printed.
"""

from __future__ import annotations

import secrets

import numpy as np
import pytest

from .example_drawings import grid
from .test_grease_pencil import make

SERIES, STEPS = 12, 12
NEAR = 1e-3  # units of the scene


class Artist:
    """One scene, and what can be done in it."""

    def __init__(self, bpy, part, random, folder):
        self.bpy, self.part, self.random, self.folder = bpy, part, random, folder
        self.ops = bpy.ops.involute
        self.log, self.marked = [], []
        obj, _ = make(bpy, part, grid(part, 3))
        self.choose(obj)

    @property
    def objects(self):
        return [o for o in self.bpy.data.objects if o.type == "GREASEPENCIL"]

    @property
    def obj(self):
        return self.bpy.context.view_layer.objects.active

    def choose(self, *some):
        for other in self.bpy.data.objects:
            other.select_set(other in some)
        self.bpy.context.view_layer.objects.active = some[0]

    def shown(self):
        return self.part("operators.view.view_state").shown_in(self.bpy.context)

    def cels(self):
        return list(self.part("operators.grease_pencil.cels").all_cels(self.obj.data))

    def call(self, operator, **words):
        """Run an operator; a refusal in words is an answer."""
        try:
            operator(**words)
        except RuntimeError as error:
            if "Traceback" in str(error):
                raise AssertionError("no answer in words") from error

    # --- what can be done ---

    def reroute(self):
        junction = int(self.random.integers(9))
        self.call(self.ops.reroute, junction=junction, alternative=int(self.random.integers(3)))

    def lock(self):
        self.call(self.ops.lock, junction=int(self.random.integers(9)))

    def ask_again(self):
        self.call(self.ops.ask_again)

    def separate_junction(self):
        self.call(self.ops.separate, junction=int(self.random.integers(9)))

    def join_halves(self):
        first, second = self.random.integers(0, 48, 2).tolist()
        self.call(self.ops.join, first=first, second=second)

    def duplicate(self):
        self.bpy.ops.object.duplicate(linked=bool(self.random.random() < 0.3))

    def join_objects(self):
        if any(len(y.frames) > 1 for o in self.objects for y in o.data.layers):
            return  # Blender 5.0 itself may crash then
        self.marked = []  # the points of the others are moved into this one's space
        self.choose(self.obj, *(o for o in self.objects if o != self.obj))
        self.call(self.bpy.ops.object.join)

    def other_object(self):
        self.choose(self.objects[int(self.random.integers(len(self.objects)))])

    def own_data(self):
        self.obj.data = self.obj.data.copy()

    def copy_keyframe(self):
        target = int(self.random.integers(2, 30))
        frame = self.bpy.context.scene.frame_current
        for layer in self.obj.data.layers:
            source = layer.get_frame_at(frame)
            if source and all(f.frame_number != target for f in layer.frames):
                layer.frames.copy(source.frame_number, target)
        self.bpy.context.scene.frame_set(target)

    def go_to_frame(self):
        self.bpy.context.scene.frame_set(int(self.random.integers(1, 30)))

    def move_a_point(self):
        cels = [cel for cel in self.cels() if len(cel.strokes)]
        if cels:
            places = cels[int(self.random.integers(len(cels)))].attributes["position"].data
            spot = self.random.uniform(-9, 9, 3)
            at = places[int(self.random.integers(len(places)))]
            self.forget_mark(at.vector)
            at.vector = spot
            self.marked.append(spot)

    def delete_a_stroke(self):
        cels = [cel for cel in self.cels() if len(cel.strokes)]
        if cels:
            cel = cels[int(self.random.integers(len(cels)))]
            which = int(self.random.integers(len(cel.strokes)))
            for point in cel.strokes[which].points:
                self.forget_mark(point.position)
            cel.remove_strokes(indices=[which])

    def save_and_open(self):
        path, name = str(self.folder / "series.blend"), self.obj.name
        self.bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False)
        self.bpy.ops.wm.open_mainfile(filepath=path, load_ui=False)
        self.part("operators.grease_pencil.stored_trace")._decoded.clear()
        self.part("operators.view.junction_table")._tables.clear()
        self.choose(self.bpy.data.objects[name])

    def forget_mark(self, place):
        near = [np.abs(np.array(place) - mark).max() > NEAR for mark in self.marked]
        self.marked = [mark for mark, stays in zip(self.marked, near, strict=True) if stays]

    # --- what always holds ---

    def check(self):
        for panel in ("INVOLUTE_PT_junctions", "INVOLUTE_PT_junction", "INVOLUTE_PT_summary"):
            getattr(self.bpy.types, panel).poll(self.bpy.context)
        list(self.part("operators.view.view_state").traced_in(self.bpy.context))
        shown = self.shown()  # InvoluteError where junctions were lost
        if shown is not None:
            drawing = shown.trace.drawing
            self.part("engine.soundness").check_involution(drawing.graph, drawing.routing.partner)
            count = len(drawing.graph.places) + len(drawing.bundles)
            assert shown.world_positions.shape == (count, 3)
        places = [np.zeros((0, 3))]
        for obj in self.objects:
            for cel in self.part("operators.grease_pencil.cels").all_cels(obj.data):
                if "position" in cel.attributes:
                    values = np.zeros(3 * len(cel.attributes["position"].data), np.float32)
                    cel.attributes["position"].data.foreach_get("vector", values)
                    places.append(values.reshape(-1, 3))
        every = np.concatenate(places)
        assert np.isfinite(every).all()
        for mark in self.marked:
            assert np.abs(every - mark).max(1).min() < NEAR, "a point made by hand is gone"


WORK = [name for name, how in vars(Artist).items() if callable(how)]
WORK = WORK[WORK.index("reroute") : WORK.index("forget_mark")]


@pytest.mark.parametrize("number", range(SERIES))
def test_whatever_an_artist_does_nothing_is_lost(bpy, part, tmp_path, number):
    seed = secrets.randbits(32)
    print(f"seed {seed}")
    random = np.random.default_rng(seed)
    artist = Artist(bpy, part, random, tmp_path)
    for _ in range(STEPS):
        work = WORK[int(random.integers(len(WORK)))]
        artist.log.append(work)
        try:
            getattr(artist, work)()
            artist.check()
        except Exception as error:
            raise AssertionError(f"seed {seed}: {artist.log}") from error
