"""Captures: pictures of one scene under many lights."""

from __future__ import annotations

import ctypes
import dataclasses
import os

import numpy as np

from ._abi import CONSTANTS, structs
from ._arrays import Buffer, copy_from, take_image, transfer_of, vectors
from ._library import Handle, Log, Progress, UsageError, lib

_SAMPLES = {np.dtype(np.float32): "RELUME_SAMPLE_FLOAT", np.dtype(np.uint8): "RELUME_SAMPLE_8",
            np.dtype(np.uint16): "RELUME_SAMPLE_16"}


def parse(function, text: str | None, what: str) -> int:
    out = ctypes.c_int(0)
    if text is not None and function(ctypes.byref(out), str(text).encode()):
        raise UsageError(f"{what} '{text}' is unknown")
    return out.value


def domain_of(text: str | None) -> dict:
    """What parameters say of it: domain and display."""
    out, display = ctypes.c_int(0), structs["relume_transfer"]()
    if lib.relume_domain_parse(ctypes.byref(out), ctypes.byref(display), (text or "auto").encode()):
        raise UsageError(f"domain '{text}' is unknown; expected linear, display, log or log:DELTA")
    return {"domain": out.value, "display": display}


def basis_named(name: str) -> int:
    found = lib.relume_basis_find(name.encode())
    if not found:
        raise UsageError(f"basis '{name}' is unknown; expected auto or one of {', '.join(bases())}")
    return found


def bases() -> list[str]:
    """The names of all bases."""
    table = (ctypes.c_void_p * 1024).in_dll(lib, "relume_bases")  # ends with NULL
    names: list[str] = []
    while table[len(names)]:
        names.append(name_of(table[len(names)]))
    return names


def _interpolant_named(name: str | None) -> int | None:
    if name in (None, "auto"):
        return None
    found = lib.relume_interpolant_find(name.encode())
    if not found:
        raise UsageError(f"interpolant '{name}' is unknown; see 'relume help encode'")
    return found


_PYRAMIDS = {None: CONSTANTS["RELUME_PYRAMID_DEFAULT"], True: CONSTANTS["RELUME_PYRAMID_YES"],
             False: CONSTANTS["RELUME_PYRAMID_NO"]}
_MOVING = {None: "DEFAULT", "auto": "AUTO", True: "YES", "yes": "YES", False: "NO", "no": "NO"}


def _moving(value: bool | str | None, what: str) -> int:
    if value not in _MOVING:
        raise UsageError(f"{what} '{value}' is unknown; expected auto, yes or no")
    return CONSTANTS["RELUME_MOVING_" + _MOVING[value]]


def _effort(value: str | None) -> int:
    known = {None: "DEFAULT", "fast": "FAST", "usual": "USUAL", "smallest": "SMALLEST"}
    if value not in known:
        raise UsageError(f"effort '{value}' is unknown; expected fast, usual or smallest")
    return CONSTANTS["RELUME_EFFORT_" + known[value]]


def name_of(address: int) -> str:
    """Of a basis or interpolant: structs that begin with their name."""
    return ctypes.c_char_p.from_address(address).value.decode()


def light_directions(pattern: str, n: int, hemisphere: bool = False, seed: int = 0) -> np.ndarray:
    """`n` unit vectors [n, 3] towards lights, spread by a pattern: hammersley, grid, random, ..."""
    found, log = lib.relume_pattern_find(pattern.encode()), Log()
    if not found:
        raise UsageError(f"pattern '{pattern}' is unknown; see 'relume lights --help'")
    out = np.empty((max(n, 0), 3))
    params = structs["relume_directions_params"](log=log.address, seed=seed, hemisphere=hemisphere)
    log.check(lib.relume_directions_make(out.ctypes.data, n, found, ctypes.byref(params)))
    return out


@dataclasses.dataclass(frozen=True)
class EncodeReport:
    """How well a file holds a capture, over all views; errors are linear, 1 is white."""

    basis: str
    coefficients: int
    fit_rms: float
    """captured values against unquantised coefficients"""
    store_rms: float
    """unquantised against stored coefficients"""
    psnr_db: float
    """the captured photographs, reproduced, display values"""
    unseen_db: float | None
    """predicted for light directions that were not captured; None: unknown"""
    bits: str | None
    """how coefficients are stored; None: coded with loss"""
    domain: str
    shadows: bool
    """shadows move with the light"""
    highlights: bool
    """highlights move with the light"""
    jnd: float | None
    """just noticeable differences that 99 % of the pixels of every photograph keep; None: not judged"""
    reached: bool
    """the quality, size or JND that was asked for is kept"""


def _report_of(result) -> EncodeReport:
    measured, moves = result.measured, CONSTANTS["RELUME_MOVING_MOVES"]
    return EncodeReport(
        basis=name_of(result.basis), coefficients=result.coefficients, fit_rms=measured.fit_rms,
        store_rms=measured.store_rms, psnr_db=measured.psnr_db, unseen_db=result.unseen_db or None,
        bits=None if result.lossy else lib.relume_storage_name(result.storage).decode(),
        domain=lib.relume_domain_name(result.domain, result.display).decode(),
        shadows=result.shadows.outcome == moves, highlights=result.highlights.outcome == moves, jnd=result.jnd or None,
        reached=result.reach == CONSTANTS["RELUME_REACHED"])


class Capture(Handle):
    """Pictures under many lights, in memory (`Capture(...)`) or on disk (`Capture.open`).

    Safe to use from several threads.
    """

    def __init__(self, pictures=None, directions=None, *, positions=None, intensities=None,
                 transfer: str | None = None, depth=None, mask=None, repair: bool = False):
        """`pictures`: [light, y, x, 3] or [light, y, x], float (linear), uint8 or uint16 (sRGB);
        `transfer` ("linear", "srgb", "gamma:2.2") says otherwise. `directions`: [light, 3] from
        the scene towards the lights, any length; or `positions` of near lights, world units (the
        picture is 2 wide, z = 0). `intensities`: [light, 3], by which pictures are divided. `depth`
        and `mask`: [y, x]. Float arrays that are contiguous float32 are not copied and must not
        change.
        """
        super().__init__(lib.relume_capture_destroy)
        self._kept: list = []
        self._name = b"memory"
        if pictures is None:
            return
        log = Log()
        manifest = self._manifest_of(directions, positions, intensities, transfer)
        array = self._pictures_of(pictures, depth, mask)
        if np.shape(pictures)[0] != manifest.lights:
            raise UsageError(f"{np.shape(pictures)[0]} pictures and {manifest.lights} lights; "
                             "expected a light for every picture")
        params = structs["relume_capture_params"](log=log.address, repair=repair)
        log.check(lib.relume_capture_create(self.out, ctypes.byref(manifest), ctypes.byref(array),
                                            ctypes.byref(params)))

    @classmethod
    def open(cls, path: str | os.PathLike, *, transfer: str | None = None,
             skip_missing: bool = False, repair: bool = False, crop=None,
             progress: Progress | None = None) -> "Capture":
        """A capture.json, a folder with one, or a .lp file. `crop`: the part x, y, width, height of
        its pictures, or "auto": the object."""
        self, log = cls(), Log(progress)
        params = structs["relume_capture_params"](
            log=log.address, transfer=transfer_of(transfer), skip_missing=skip_missing,
            repair=repair)
        self._name = os.fsencode(path)
        part = structs["relume_acquire_params"](crop_auto=crop == "auto")
        if crop is not None and crop != "auto":
            part.crop[:] = [int(number) for number in crop]
        log.check(lib.relume_capture_open_photographs(self.out, self._name, ctypes.byref(params),
                                                      ctypes.byref(part), None))
        return self

    def _keep(self, array: np.ndarray) -> int:
        self._kept.append(array)
        return array.ctypes.data

    def _manifest_of(self, directions, positions, intensities, transfer):
        if directions is None and positions is None:
            raise UsageError("no lights; expected directions or positions")
        manifest = structs["relume_manifest"](transfer=transfer_of(transfer))
        for field, values in ("directions", directions), ("positions", positions):
            if values is not None:
                array = vectors(values, field)
                if manifest.lights not in (0, len(array)):
                    raise UsageError("expected as many positions as directions")
                manifest.lights = len(array)
                setattr(manifest, field, self._keep(array))
        if intensities is not None:
            array = np.ascontiguousarray(intensities, np.float32)
            if array.shape != (manifest.lights, 3):
                raise UsageError(f"intensities: an array of shape {array.shape}; expected "
                                 f"[{manifest.lights}, 3]")
            manifest.intensities = self._keep(array)
        return manifest

    def _pictures_of(self, pictures, depth, mask):
        array = np.asarray(pictures)
        if array.dtype not in _SAMPLES:
            array = array.astype(np.float32)
        array = np.ascontiguousarray(array)
        if array.ndim == 3:
            array = array[..., None]
        if array.ndim != 4 or not array.size:
            raise UsageError(f"pictures: an array of shape {np.shape(pictures)}; expected "
                             "[light, y, x, 3] or [light, y, x]")
        _, height, width, channels = array.shape
        out = structs["relume_pictures"](CONSTANTS[_SAMPLES[array.dtype]], width, height, channels,
                                         self._keep(array))
        for field, values in ("depth", depth), ("mask", mask):
            if values is not None:
                plane = np.ascontiguousarray(values, np.float32)
                if plane.shape != (height, width):
                    raise UsageError(f"{field}: an array of shape {plane.shape}; expected "
                                     f"[{height}, {width}]")
                setattr(out, field, self._keep(plane))
        return out

    @property
    def _manifest(self):
        return structs["relume_manifest"].from_address(lib.relume_capture_manifest(self.pointer))

    @property
    def width(self) -> int:
        return lib.relume_capture_width(self.pointer)

    @property
    def height(self) -> int:
        return lib.relume_capture_height(self.pointer)

    @property
    def lights(self) -> int:
        return self._manifest.lights

    @property
    def views(self) -> int:
        return self._manifest.views

    @property
    def directions(self) -> np.ndarray:
        """[light, 3], unit vectors towards the lights."""
        return copy_from(self._manifest.directions, (self.lights, 3), np.float64)

    def _plane(self, function, *where) -> np.ndarray:
        log, out = Log(), structs["relume_image"]()
        log.check(function(ctypes.byref(out), self.pointer, *where, log.address))
        return take_image(out)

    def _check(self, view: int, light: int = 0) -> None:
        if not (0 <= view < self.views and 0 <= light < self.lights):
            raise IndexError(f"view {view}, light {light}; there are {self.views} views and "
                             f"{self.lights} lights")

    def image(self, light: int, view: int = 0) -> np.ndarray:
        """One picture [y, x, 3], linear, light intensity divided out."""
        self._check(view, light)
        return self._plane(lib.relume_capture_image, view, light)

    def mask(self, view: int = 0) -> np.ndarray | None:
        """[y, x], or None."""
        self._check(view)
        plane = self._plane(lib.relume_capture_mask, view)
        return plane if plane.size else None

    def depth(self, view: int = 0) -> np.ndarray | None:
        """[y, x], or None."""
        self._check(view)
        plane = self._plane(lib.relume_capture_depth, view)
        return plane if plane.size else None

    def encode(self, path: str | os.PathLike | None = None, *, basis: str = "auto",
               coefficients: int = 0, quality_db: float = 0.0, interpolant: str | None = None,
               luminance: bool = False, robust: bool = False, force: bool = False,
               domain: str | None = None, bits: str | int | None = None,
               compression: str | None = None, pyramid: bool | None = None, depth: bool = True,
               psnr_db: float = 0.0, bytes_per_pixel: float = 0.0, jnd: float = 0.0,
               effort: str | None = None, lossless: bool = False,
               shadows: bool | str | None = None, highlights: bool | str | None = None,
               threads: int = 0,
               progress: Progress | None = None) -> tuple[bytes | None, EncodeReport]:
        """Make a relume file, under `path` or as bytes, and say how good it is.

        Parameters mean what the options of `relume encode` do; 0 and None are its defaults, and
        the same ones give the same bytes.
        """
        log, buffer = Log(progress), Buffer()
        result = structs["relume_encode_result"]()
        params = structs["relume_encode_capture_params"](
            log=log.address, threads=threads, name=self._name,
            basis=None if basis == "auto" else basis_named(basis), coefficients=coefficients,
            quality_db=quality_db, luminance=luminance, robust=robust, force=force,
            interpolant=_interpolant_named(interpolant), choose_interpolant=interpolant == "auto",
            storage=parse(lib.relume_storage_parse, bits, "bits"), **domain_of(domain),
            compression=parse(lib.relume_compression_parse, compression, "compression"),
            pyramid=_PYRAMIDS[pyramid], no_depth=not depth, psnr_db=psnr_db,
            bytes_per_pixel=bytes_per_pixel, jnd=jnd, effort=_effort(effort), lossless=lossless,
            shadows=_moving(shadows, "shadows"),
            highlights=_moving(highlights, "highlights"),
            writer=ctypes.addressof(buffer.writer) if path is None else None)
        name = None if path is None else os.fsencode(path)
        log.check(lib.relume_encode_capture(name, self.pointer, ctypes.byref(result),
                                            ctypes.byref(params)))
        return (buffer.take() if path is None else None), _report_of(result)


def encode(pictures, directions, path: str | os.PathLike | None = None, *,
           transfer: str | None = None, **options) -> bytes | None:
    """Pictures [light, y, x, 3] and directions [light, 3] become a relume file, under `path` or as
    bytes. Options: those of `Capture.encode`."""
    with Capture(pictures, directions, transfer=transfer) as capture:
        return capture.encode(path, **options)[0]
