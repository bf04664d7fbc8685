"""Point at a junction and choose among its alternatives, each previewed before it is applied."""

from __future__ import annotations

import bpy
from bpy.props import BoolProperty

from ..language import label
from ..view.on_screen import junction_under
from ..view.view_state import Shown, make_current, shown_in
from .card_choice import CardChoice
from .junction_operator import alternative_property, junction_property


class INVOLUTE_OT_choose(CardChoice, bpy.types.Operator):
    """Show the alternatives of a junction as cards: point to preview, click to apply"""

    bl_idname = "involute.choose"
    bl_label = "Choose Routing"

    pick: BoolProperty(
        name="Pick",
        description="Take the junction under the mouse instead of the current one",
        default=False,
        options={"SKIP_SAVE", "HIDDEN"},
    )
    junction: junction_property()
    alternative: alternative_property()

    def invoke(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Show the cards; with `pick` of the junction under the mouse."""
        if context.region_data is None:
            return {"CANCELLED"}
        if self.pick:
            found = junction_under(context, (event.mouse_region_x, event.mouse_region_y))
            if found is None:
                return {"PASS_THROUGH"}
            make_current(context, *found)
        shown = shown_in(context)
        if shown is None or shown.junction is None:
            return {"CANCELLED"}
        return self.begin(
            context,
            label(
                "Point at a card to preview, click or Enter to apply, wheel or arrows for the "
                "next, L locks, Esc leaves"
            ),
        )

    def decide(self, context: bpy.types.Context, shown: Shown, alternative: int) -> set[str]:
        """Apply the alternative and close the cards."""
        self.junction, self.alternative = shown.junction.index, alternative
        return self.leave(context, self.execute(context))

    def lock(self, context: bpy.types.Context, shown: Shown) -> set[str]:
        """Lock or unlock the junction and close the cards."""
        index, locked = shown.junction.index, shown.junction.locked
        result = self.change(context, lambda d: d.unlock(index) if locked else d.lock(index))
        return self.leave(context, result)

    def click_elsewhere(
        self, context: bpy.types.Context, shown: Shown, mouse: tuple[float, float]
    ) -> set[str]:
        """Go to the junction there; leave where there is none."""
        found = junction_under(context, mouse)
        if found is None:
            return self.leave(context, {"CANCELLED"})
        make_current(context, *found)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        """Adjust Last Operation: another alternative for the same junction."""
        return self.apply_alternative(context, self.junction, self.alternative)


CLASSES = (INVOLUTE_OT_choose,)
