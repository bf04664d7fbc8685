"""The kinds of pictures: which are read, and what to do with those that are not.

A kind is declared once: the command line's folders, Blender's file browser, the decoder's messages
and the manual's table follow. Whether a file is of a kind is seen from its first bytes, never
from its name alone.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from importlib.util import find_spec
from pathlib import Path


@dataclass(frozen=True)
class Kind:
    """One kind of picture.

    suffixes: of its files.
    starts: the first bytes of its files; "?" stands for any byte.
    remedy: what to do with a kind that is not read; None = it is read.
    about: what of it is read, for the manual.
    needs: the module of a library that reads it, where Involute comes without; then it is read when
        that is there, and `remedy` is what to do when it is not.
    """

    name: str
    suffixes: tuple[str, ...]
    starts: tuple[bytes, ...]
    remedy: str | None = None
    about: str = ""
    needs: str | None = None

    @cached_property
    def is_read(self) -> bool:
        if self.needs:
            return find_spec(self.needs) is not None
        return self.remedy is None


_SAVE = "save it as PNG or TIFF first"
KINDS = (
    Kind("PNG", (".png",), (b"\x89PNG\r\n\x1a\n",)),
    Kind("JPEG", (".jpg", ".jpeg"), (b"\xff\xd8\xff",)),
    Kind(
        "TIFF",
        (".tif", ".tiff"),
        (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+"),
        about="every page; 1 to 64 bit, whole numbers and floats",
    ),
    Kind("WebP", (".webp",), (b"RIFF????WEBP",), about="the first picture"),
    Kind("BMP", (".bmp",), (b"BM",)),
    Kind("TGA", (".tga",), (), about="of RETAS and OpenToonz; with or without compression"),
    Kind("PSD", (".psd", ".psb"), (b"8BPS",), about="the flattened picture inside"),
    Kind("GIF", (".gif",), (b"GIF87a", b"GIF89a"), about="the first picture"),
    Kind(
        "PBM, PGM, PPM",
        (".pbm", ".pgm", ".ppm", ".pnm"),
        (b"P1", b"P2", b"P3", b"P4", b"P5", b"P6"),
    ),
    Kind("JPEG 2000", (".jp2", ".j2k"), (b"\0\0\0\x0cjP  \r\n\x87\n", b"\xff\x4f\xff\x51")),
    Kind("AVIF", (".avif",), (b"????ftypavif", b"????ftypavis")),
    Kind(
        "PDF",
        (".pdf",),
        (b"%PDF",),
        "save its pages as PNG or TIFF first, at 300 dpi (pdftoppm -r 300 -png does it)",
        about="every page, at 300 dpi",
        needs="pypdfium2",
    ),
    Kind(
        "HEIC",
        (".heic", ".heif"),
        tuple(b"????ftyp" + brand for brand in (b"heic", b"heix", b"hevc", b"mif1", b"msf1")),
        "save it as PNG or JPEG first; a phone can also be set to take JPEG",
        about="the first picture",
        needs="pillow_heif",
    ),
    Kind(
        "OpenEXR",
        (".exr",),
        (b"\x76\x2f\x31\x01",),
        _SAVE,
        about="RGB, RGBA or Y; linear light is taken as such",
        needs="OpenEXR",
    ),
    Kind("JPEG XL", (".jxl",), (b"\xff\x0a", b"\0\0\0\x0cJXL "), _SAVE),
    Kind("Radiance", (".hdr",), (b"#?RADIANCE", b"#?RGBE"), _SAVE),
    Kind(
        "SVG",
        (".svg",),
        (b"<svg", b"<?xml"),
        "it holds lines already; `involute trace` on the command line joins them anew",
    ),
    Kind("PostScript", (".eps", ".ps", ".ai"), (b"%!PS", b"\xc5\xd0\xd3\xc6"), _SAVE),
    Kind("Krita", (".kra",), (), _SAVE),
    Kind("GIMP", (".xcf",), (b"gimp xcf",), _SAVE),
    Kind("Clip Studio", (".clip", ".lip"), (b"CSFCHUNK",), _SAVE),
    Kind("camera raw", (".dng", ".cr2", ".nef", ".arw"), (), _SAVE),
)
SUFFIXES = tuple(suffix for kind in KINDS if kind.is_read for suffix in kind.suffixes)
"""Of the pictures that are read, in the order of KINDS."""


def kind_of(head: bytes, path: Path) -> Kind | None:
    """The kind of a file that begins with these bytes; by its name where bytes don't show it."""
    for kind in KINDS:
        if any(_begins(head, start) for start in kind.starts):
            return kind
    suffix = path.suffix.lower()
    if not suffix and _may_be_targa(head):  # out of a pipe
        suffix = ".tga"
    return next((k for k in KINDS if not k.starts and suffix in k.suffixes), None)


def read_kinds() -> str:
    """The names of what is read, for a sentence."""
    *names, last = (kind.name for kind in KINDS if kind.is_read)
    return f"{', '.join(names)} or {last}"


def why_left_out(path: Path) -> str | None:
    """Why a file of a folder is not traced, by its name; None when it is."""
    suffix = path.suffix.lower()
    found = [kind for kind in KINDS if suffix in kind.suffixes]
    if not found:
        return "not a picture"
    kind = found[0]
    return None if kind.is_read else f"{kind.name} is not read: {kind.remedy}"


def _may_be_targa(head: bytes) -> bool:
    """Whether a header has what each Targa has: numbers of a few kinds, and a size."""
    return (
        len(head) >= 18
        and head[1] in (0, 1)
        and head[2] in (1, 2, 3, 9, 10, 11)
        and head[16] in (8, 15, 16, 24, 32)
        and any(head[12:14])
        and any(head[14:16])
    )


def _begins(head: bytes, start: bytes) -> bool:
    return len(head) >= len(start) and all(
        wanted in (ord("?"), byte) for wanted, byte in zip(start, head, strict=False)
    )
