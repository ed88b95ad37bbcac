"""Relume files: opened, looked into, relit."""

from __future__ import annotations

import ctypes
import dataclasses
import os
import threading
from typing import Sequence, Union

import numpy as np

from ._abi import CONSTANTS, structs
from ._arrays import Buffer, Source, copy_from, memory, take_image
from ._capture import Capture, name_of
from ._library import Context, Handle, Log, Progress, UsageError, lib

Light = Union[str, Sequence[float], np.ndarray]
"""A light in the words of the command line ("point 1 2 3", "env sky.hdr 90"), or a vector towards a
directional light of value 1."""


@dataclasses.dataclass(frozen=True)
class Info:
    """What a file says of itself."""

    basis: str
    coefficients: int
    projection: str
    width: int
    height: int
    views: int
    lights: int
    bits: str
    domain: str
    """"linear" or "display": in which light the coefficients live"""
    codebooks: int
    has_depth: bool
    has_mask: bool
    file_bytes: int


@dataclasses.dataclass(frozen=True)
class Evaluation:
    """How well a file shows a capture; the numbers of `relume eval`."""

    psnr_db: float
    psnr_pooled_db: float
    rms: float
    ssim: float
    delta_e: float
    file_bytes: int
    bits_per_pixel: float
    ratio: float
    light_psnr_db: np.ndarray
    """[light], mean over views"""


def _words(lights: Light | Sequence[Light]) -> list[str]:
    """Every light in words."""
    one = isinstance(lights, str) or (len(lights) == 3 and np.ndim(lights[0]) == 0 and
                                      not isinstance(lights[0], str))
    return [light if isinstance(light, str) else "dir " + " ".join(f"{float(v):.17g}" for v in light)
            for light in ([lights] if one else lights)]


def _camera(view, eye, look, size):
    camera = structs["relume_camera"](width=size[0], height=size[1])
    if sum(x is not None for x in (view, eye, look)) > 1:
        raise UsageError("view, eye and look exclude each other")
    if view is not None:
        camera.framing, camera.view = CONSTANTS["RELUME_FRAME_VIEW"], view
    if eye is not None:
        camera.framing, camera.eye = CONSTANTS["RELUME_FRAME_EYE"], structs["relume_vec3"](*eye)
    if look is not None:
        camera.framing, camera.look = CONSTANTS["RELUME_FRAME_LOOK"], structs["relume_pan_tilt"](*look)
    return camera


class File(Handle):
    """An open file. Calls from several threads are made one after the other."""

    def __init__(self, source: Source, *, name: str = "memory", threads: int = 0,
                 context: Context | None = None):
        """`source`: the name of a relume file or of anything else that can be shown (.ptm, .rti, a
        web folder, a capture), or the bytes of a file, whose `name` says by its ending what it is
        if it is no relume file. `context`: where names are looked for, limits."""
        super().__init__(lib.relume_pack_destroy)
        self._log, self._lock = Log(context=context), threading.RLock()
        self._source = source
        self._threads = threads
        self._renderer: Handle | None = None
        self._rig: Handle | None = None
        self._words: list[str] | None = None
        params = structs["relume_open_params"](log=self._log.address, threads=threads)
        if isinstance(source, bytes):
            self._reader = memory(source)
            params.reader = ctypes.addressof(self._reader)
        path = name if isinstance(source, bytes) else source
        self._log.check(lib.relume_open(self.out, os.fsencode(path), ctypes.byref(params)))
        how = structs["relume_frame_params"](log=self._log.address, threads=threads)
        self._renderer = Handle(lib.relume_renderer_destroy)
        self._log.check(lib.relume_renderer_create(self._renderer.out, self.pointer,
                                                   ctypes.byref(how)))

    def close(self) -> None:
        """Give the memory back. Closing twice is fine."""
        with self._lock:
            if self._renderer:
                self._renderer.close()
            super().close()

    @property
    def _info(self):
        return structs["relume_pack_info"].from_address(lib.relume_pack_info(self.pointer))

    @property
    def _coder(self):
        return structs["relume_coder_info"].from_address(lib.relume_coder_info(self._info.coder))

    @property
    def info(self) -> Info:
        i, c = self._info, self._coder
        return Info(
            basis=name_of(c.basis), coefficients=i.coefficients,
            projection=lib.relume_projection_name(i.geometry.projection).decode(), width=i.width,
            height=i.height, views=i.views, lights=c.lights,
            bits=lib.relume_storage_name(i.storage).decode(),
            domain=lib.relume_domain_name(i.domain, i.display).decode(),
            codebooks=i.books, has_depth=i.has_depth, has_mask=i.has_mask,
            file_bytes=i.file_bytes)

    @property
    def directions(self) -> np.ndarray:
        """[light, 3]: the captured lights, unit vectors towards them."""
        return copy_from(self._coder.directions, (self._coder.lights, 3), np.float64)

    def weights(self, direction: Sequence[float]) -> tuple[np.ndarray, np.ndarray]:
        """What a light from `direction` asks of the coefficients: float32 [3, K] and a constant
        [3]. Channel c of a pixel is constant[c] + sum of weights[c] * its coefficients."""
        k = self._coder.coefficients
        weights, constant = np.zeros((3, k), np.float32), np.zeros(3, np.float32)
        d = np.asarray(direction, np.float64)
        length = np.linalg.norm(d)
        if d.shape != (3,) or not np.isfinite(length) or length == 0.0:
            raise UsageError(f"direction {direction}; expected three numbers, not all 0")
        with self._lock:
            lib.relume_coder_weights(self._info.coder, structs["relume_vec3"](*(d / length)),
                                     weights.ctypes.data, constant.ctypes.data)
        return weights, constant

    def coefficients(self, view: int = 0) -> np.ndarray:
        """The stored coefficients, dequantised: float32 [3, K, y, x]; [K, y, x] where the basis has
        one set for all channels (pca); [K + 3, y, x] with `luminance`, the last three the colour."""
        out = ctypes.c_void_p()
        with self._lock:
            self._log.check(lib.relume_pack_codes(ctypes.byref(out), self.pointer, view))
            codes = structs["relume_codes"].from_address(out.value)
            size = codes.width * codes.height
            planes = np.empty((codes.planes, codes.height, codes.width), np.float32)
            for p in range(codes.planes):
                lib.relume_codes_plane(out, p, 0, size, planes[p].ctypes.data)
        if self._coder.joint:
            return planes
        k = codes.planes // 3
        return np.ascontiguousarray(
            planes.reshape(k, 3, codes.height, codes.width).transpose(1, 0, 2, 3))

    def _plane(self, function, view: int) -> np.ndarray | None:
        out = structs["relume_image"]()
        with self._lock:
            self._log.check(function(ctypes.byref(out), self.pointer, view))
        plane = take_image(out)
        return plane if plane.size else None

    def depth(self, view: int = 0) -> np.ndarray | None:
        """[y, x] in world units, or None."""
        return self._plane(lib.relume_pack_depth, view)

    def mask(self, view: int = 0) -> np.ndarray | None:
        """[y, x], or None."""
        return self._plane(lib.relume_pack_mask, view)

    def _set_lights(self, lights: Light | Sequence[Light]) -> None:
        """What the renderer has kept for the same lights stays."""
        words = _words(lights)
        if words == self._words:
            return
        rig = Handle(lib.relume_rig_destroy)
        self._log.check(lib.relume_rig_create(rig.out))
        for spec in words:
            self._log.check(lib.relume_rig_add(rig.pointer, spec.encode(), None,
                                               self._log.address))
        self._words = None
        self._log.check(lib.relume_renderer_set_rig(self._renderer.pointer, rig.pointer))
        self._rig, self._words = rig, words  # the renderer borrows what the rig owns

    def _draw(self, lights, camera, format_: str, dtype, exposure_ev: float = 0.0) -> np.ndarray:
        size = (ctypes.c_int * 2)()
        with self._lock:
            lib.relume_camera_rect(size, lib.relume_pack_info(self.pointer), ctypes.byref(camera))
            self._set_lights(lights)
            out = np.empty((size[1], size[0], 3 if format_ == "RGB" else 4), dtype)
            target = structs["relume_target"](out.ctypes.data, CONSTANTS["RELUME_TARGET_" + format_],
                                              size[0], size[1], exposure_ev=exposure_ev)
            self._log.check(lib.relume_renderer_draw(self._renderer.pointer, ctypes.byref(camera),
                                                     ctypes.byref(target)))
        return out

    def relight(self, lights: Light | Sequence[Light] = (0.0, 0.0, 1.0), *, view: int | None = None,
                eye: Sequence[float] | None = None,
                look: tuple[float, float, float] | None = None,
                size: tuple[int, int] = (0, 0)) -> np.ndarray:
        """The scene under one light or the sum of several: float32 [y, x, 3], linear.

        `view`: a captured view; `eye`: from there (slabs); `look`: pan and tilt in degrees and
        zoom (panoramas); else what the file shows by itself. `size`: width, height.
        """
        return self._draw(lights, _camera(view, eye, look, size), "RGB", np.float32)

    def display(self, lights: Light | Sequence[Light] = (0.0, 0.0, 1.0), *, exposure_ev: float = 0.0,
                view: int | None = None, eye: Sequence[float] | None = None,
                look: tuple[float, float, float] | None = None,
                size: tuple[int, int] = (0, 0)) -> np.ndarray:
        """The same for the screen: uint8 [y, x, 4], sRGB and alpha, times 2^exposure_ev."""
        return self._draw(lights, _camera(view, eye, look, size), "RGBA8", np.uint8, exposure_ev)

    def export(self, format: str, *, view: int = 0, quality: int = 0) -> bytes:
        """The bytes of a "ptm", "lptm" or "rti"; of the first two a `quality` makes JPEG planes."""
        kind = ctypes.c_int()
        if lib.relume_exchange_parse(ctypes.byref(kind), format.encode()):
            raise UsageError(f"format '{format}'; expected ptm, lptm or rti")
        log, buffer = Log(), Buffer()
        params = structs["relume_export_params"](log=log.address, view=view, quality=quality,
                                                 threads=self._threads,
                                                 writer=ctypes.addressof(buffer.writer))
        with self._lock:
            log.check(lib.relume_export(self.pointer, None, kind, None, ctypes.byref(params)))
        return buffer.take()

    def evaluate(self, capture: Capture, *, ssim: bool = True, delta_e: bool = True,
                 progress: Progress | None = None) -> Evaluation:
        """Relight with every light of `capture` and compare with its pictures."""
        log, out = Log(progress), structs["relume_evaluation"]()
        params = structs["relume_evaluate_params"](log=log.address, threads=self._threads,
                                                   no_ssim=not ssim, no_delta_e=not delta_e)
        with self._lock:
            log.check(lib.relume_evaluate(ctypes.byref(out), self.pointer, capture.pointer,
                                          ctypes.byref(params)))
        each = copy_from(out.light, (out.lights, 2), np.float64)
        found = Evaluation(out.psnr_db, out.psnr_pooled_db, out.rms, out.ssim, out.delta_e,
                           int(out.file_bytes), out.bits_per_pixel, out.ratio, each[:, 1])
        lib.relume_evaluation_destroy(ctypes.byref(out))
        return found


def open(source: Source, *, name: str = "memory", threads: int = 0,
         context: Context | None = None) -> File:
    """Open a relume file, anything that can be shown as one, or the bytes of one, called `name`."""
    return File(source, name=name, threads=threads, context=context)
