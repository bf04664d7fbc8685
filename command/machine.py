"""How many cores and how much memory this process may use: not always all that the machine has."""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

_UNKNOWN = 8e9  # bytes, where the system does not say
_GROUPS = Path("/sys/fs/cgroup")
_OWN_GROUP = Path("/proc/self/cgroup")


def cores() -> int:
    """Cores that this process may use: by its affinity, and by its container's share of time."""
    try:
        count = len(os.sched_getaffinity(0))
    except (AttributeError, OSError):  # macOS, Windows
        count = os.cpu_count() or 1
    for folder in _control_groups():
        for quota, period in _shares(folder):
            if quota > 0 and period > 0:
                count = min(count, -(-quota // period))
    return max(1, count)


def memory() -> float:
    """Bytes that this process may use: the machine's, or what its container or shell allows."""
    limits = [_UNKNOWN]
    with suppress(AttributeError, OSError, ValueError):  # Windows has none of these
        limits = [float(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES"))]
    for folder in _control_groups():
        for name in ("memory.max", "memory.limit_in_bytes"):
            limits += _numbers(folder / name)[:1]
    with suppress(ImportError, OSError, ValueError):
        import resource

        allowed, _ = resource.getrlimit(resource.RLIMIT_AS)
        limits += [allowed] if allowed != resource.RLIM_INFINITY else []
    return float(min(limit for limit in limits if limit > 0))


def _control_groups() -> Iterator[Path]:
    """Folders of the control groups that this process is in, with those above them."""
    try:
        lines = _OWN_GROUP.read_text().splitlines()
    except OSError:
        return
    for line in lines:
        _, controllers, group = line.split(":", 2)
        root = _GROUPS / controllers if controllers else _GROUPS
        # In a container the group's own path is often not mounted: its root is the group then.
        folder = root / group.lstrip("/")
        yield root
        while folder != root and root in folder.parents:
            yield folder
            folder = folder.parent


def _shares(folder: Path) -> Iterator[tuple[int, int]]:
    """(microseconds of time, of how many) that a group may use."""
    both = _numbers(folder / "cpu.max")
    if len(both) == 2:
        yield both[0], both[1]
    quota, period = (_numbers(folder / f"cpu.cfs_{n}_us") for n in ("quota", "period"))
    if quota and period:
        yield quota[0], period[0]


def _numbers(file: Path) -> list[int]:
    """The whole numbers in a small file; none when it says "max" or is not there."""
    try:
        return [int(word) for word in file.read_text().split()]
    except (OSError, ValueError):
        return []
