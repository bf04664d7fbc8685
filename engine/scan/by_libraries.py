"""Pictures that other libraries read, which Involute comes without: PDF, HEIC, OpenEXR.

They are the extra `pictures`; `formats.picture_kinds` says which kind needs which, and what to do
without it. Each reader takes the bytes of a file and gives (H, W), (H, W, 3) or (H, W, 4), RGB, or
None for a damaged file.
"""

from __future__ import annotations

import io
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from ..errors import InvoluteError
from ..values import Array
from .largest import MAX_SIDE, TooLargeError

PDF_DPI = 300.0
_POINT = 72.0  # to an inch


def pdf_pages(data: bytes) -> int:
    """How many pages a PDF has; 0 for a damaged one."""
    document = _pdf(data)
    return 0 if document is None else len(document)


def pdf(data: bytes, page: int) -> Array | None:
    """One page of a PDF at 300 dpi; None for a damaged one.

    Raises:
        TooLargeError: it is.
        InvoluteError: it is locked; the name of the file is to be put before it.
    """
    import pypdfium2

    document = _pdf(data)
    if document is None or not 0 <= page < len(document):
        return None
    try:
        sheet = document[page]
        if max(sheet.get_size()) * PDF_DPI / _POINT > MAX_SIDE:
            raise TooLargeError
        picture: Array = sheet.render(scale=PDF_DPI / _POINT, rev_byteorder=True).to_numpy()
    except pypdfium2.PdfiumError:  # the document is whole, the page is not
        return None
    return np.ascontiguousarray(picture[..., :3] if picture.ndim == 3 else picture)


def _pdf(data: bytes) -> Any | None:
    import pypdfium2

    try:
        return pypdfium2.PdfDocument(data)
    except pypdfium2.PdfiumError as error:
        if "password" in str(error).lower():
            raise InvoluteError("it is locked with a password; save it without one.") from None
        return None


def heic(data: bytes) -> Array | None:
    """The first picture of a HEIC, upright."""
    import pillow_heif

    try:
        file = pillow_heif.open_heif(io.BytesIO(data), convert_hdr_to_8bit=False)
        if max(file.size) > MAX_SIDE:
            raise TooLargeError
        return np.asarray(file)
    except (ValueError, RuntimeError, EOFError, SyntaxError, OSError):
        return None


def exr(data: bytes) -> Array | None:
    """An OpenEXR as one sees it: its linear light as sRGB, float32 in [0, 1]."""
    import OpenEXR

    try:
        with tempfile.TemporaryDirectory(prefix="involute-") as folder:
            path = Path(folder) / "picture.exr"
            path.write_bytes(data)
            with OpenEXR.File(str(path)) as file:
                found = {name: channel.pixels for name, channel in file.channels().items()}
    except (RuntimeError, ValueError, TypeError, KeyError, OSError):
        return None
    picture = _channels(found)
    if picture is None or not picture.size:
        return None
    picture = np.clip(np.nan_to_num(picture.astype(np.float32)), 0, 1)
    light = picture[..., :3] if picture.ndim == 3 else picture
    light[...] = np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    return picture


def _channels(found: dict[str, Array]) -> Array | None:
    """The picture in the channels of an OpenEXR; of one with others (depth, normals) none."""
    for name in ("RGBA", "RGB"):
        if name in found:
            return found[name]
    if {"R", "G", "B"} <= found.keys():
        return np.dstack([found[name] for name in "RGBA" if name in found])
    return found.get("Y")


READERS: dict[str, Callable[[bytes], Array | None]] = {"HEIC": heic, "OpenEXR": exr}
