"""What all tests share."""

from __future__ import annotations

try:
    from hypothesis import settings
except ImportError:  # the environments that only hold Blender
    pass
else:
    # Machines are loaded now and then: no example fails for being slow.
    settings.register_profile("involute", deadline=None)
    settings.load_profile("involute")
