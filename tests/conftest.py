"""How property tests run: the machine's speed is no property of the code."""

from contextlib import suppress

with suppress(ImportError):  # an environment with nothing but Blender in it has no such tests
    from hypothesis import HealthCheck, settings

    settings.register_profile(
        "any machine",
        deadline=None,
        max_examples=40,
        suppress_health_check=[HealthCheck.too_slow],
    )
    settings.load_profile("any machine")
