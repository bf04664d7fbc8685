"""What Blender's Python module needs of a Linux system, and the Debian packages that bring it.

`python3 operators/system_libraries.py` prints the packages. Standard library only, no bpy.
"""

from __future__ import annotations

import ctypes
import re
import sys
from collections.abc import Sequence

LINKED = {  # without these, bpy can't be loaded: library -> package
    "libX11.so.6": "libx11-6",
    "libXext.so.6": "libxext6",
    "libXrender.so.1": "libxrender1",
    "libXfixes.so.3": "libxfixes3",
    "libXi.so.6": "libxi6",
    "libxkbcommon.so.0": "libxkbcommon0",
    "libSM.so.6": "libsm6",
    "libICE.so.6": "libice6",
    "libGL.so.1": "libgl1",
    "libstdc++.so.6": "libstdc++6",
    "libgcc_s.so.1": "libgcc-s1",
}
DRAWING = ("libegl1", "libegl-mesa0", "libgl1-mesa-dri", "libgbm1", "libglx-mesa0")
"""Packages for drawing without a window, which only the tests of the overlay do."""


def cannot_load(error: ImportError) -> str:
    """One sentence: why bpy can't be loaded, and what to install.

    Args:
        error: what `import bpy` raised.
    """
    if isinstance(error, ModuleNotFoundError) and error.name == "bpy":
        return (
            "Writing .blend files needs Blender: install the extra 'blender', or run "
            "blender -b --command involute."
        )
    named = re.match(r"(lib\S+\.so[.\d]*): cannot open shared object file", str(error))
    if named is None:
        return (
            f"Blender's Python module can't be loaded ({str(error).rstrip('.')}); "
            "run blender -b --command involute instead."
        )
    return lacks([named[1], *missing()])


def lacks(libraries: Sequence[str]) -> str:
    """One sentence: which libraries this system lacks, and how to install them."""
    packages = [LINKED[name] for name in dict.fromkeys(libraries) if name in LINKED]
    cure = "install the package that brings it"
    if packages:
        cure = f"on Debian and Ubuntu, as root: apt install {' '.join(packages)}"
    return (
        "Can't load Blender's Python module, as this system lacks "
        f"{', '.join(dict.fromkeys(libraries))}; {cure}"
    )


def missing() -> list[str]:
    """The libraries of LINKED that this system lacks; none where it is no Linux."""
    found = []
    for name in LINKED if sys.platform == "linux" else ():
        try:
            ctypes.CDLL(name)
        except OSError:
            found.append(name)
    return found


if __name__ == "__main__":
    print(*LINKED.values(), *DRAWING)
