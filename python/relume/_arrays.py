"""Between NumPy arrays and the structs of the library; pictures in files and in memory."""

from __future__ import annotations

import ctypes
import os
from typing import Union

import numpy as np

from ._abi import structs
from ._library import Log, UsageError, lib

Source = Union[str, os.PathLike, bytes]
"""A file by its name, or its bytes."""


def copy_from(address: int, shape: tuple[int, ...], dtype=np.float32) -> np.ndarray:
    """A copy of what lies at an address."""
    count = int(np.prod(shape))
    size = count * np.dtype(dtype).itemsize
    return np.frombuffer(ctypes.string_at(address, size), dtype, count).reshape(shape).copy()


def take_image(image) -> np.ndarray:
    """A relume_image as an array [y, x] or [y, x, channel]; the image is destroyed."""
    shape = (image.height, image.width) + ((image.channels,) if image.channels > 1 else ())
    array = copy_from(image.data, shape) if image.data else np.empty((0, 0), np.float32)
    lib.relume_image_destroy(ctypes.byref(image))
    return array


def vectors(values, what: str) -> np.ndarray:
    array = np.ascontiguousarray(values, np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise UsageError(f"{what}: an array of shape {array.shape}; expected [n, 3]")
    return array


def transfer_of(text: str | None):
    """"linear", "srgb", "gamma:2.2"; None is what the type of the samples implies."""
    out = structs["relume_transfer"]()
    if text is not None and lib.relume_transfer_parse(ctypes.byref(out), text.encode()):
        raise UsageError(f"transfer '{text}'; expected linear, srgb or gamma:NUMBER")
    return out


def memory(data: bytes):
    """A reader of bytes, which must be kept."""
    return lib.relume_memory_reader(ctypes.cast(ctypes.c_char_p(data), ctypes.c_void_p), len(data))


class Buffer:
    """Where the library writes a file in memory."""

    def __init__(self):
        self._buffer = structs["relume_buffer"]()
        self.writer = lib.relume_buffer_writer(ctypes.byref(self._buffer))

    def take(self) -> bytes:
        data = ctypes.string_at(self._buffer.data, self._buffer.size) if self._buffer.data else b""
        lib.relume_buffer_destroy(ctypes.byref(self._buffer))
        return data

    def __del__(self):
        lib.relume_buffer_destroy(ctypes.byref(self._buffer))


def load_image(source: Source, channels: int = 3, transfer: str | None = None) -> np.ndarray:
    """A picture as linear light: float32 [y, x, 3], or [y, x] of one channel."""
    log, out = Log(), structs["relume_image"]()
    params = structs["relume_image_params"](log=log.address, channels=channels,
                                            transfer=transfer_of(transfer))
    path = None
    if isinstance(source, bytes):
        reader = memory(source)
        params.reader = ctypes.addressof(reader)
    else:
        path = os.fsencode(source)
    log.check(lib.relume_image_load(ctypes.byref(out), path, ctypes.byref(params)))
    return take_image(out)


def _image_of(array) -> tuple[np.ndarray, ctypes.Structure]:
    array = np.ascontiguousarray(array, np.float32)
    if array.ndim == 2:
        array = array[:, :, None]
    if array.ndim != 3:
        raise UsageError(f"an array of shape {array.shape}; expected [y, x] or [y, x, channel]")
    height, width, channels = array.shape
    return array, structs["relume_image"](width, height, channels, array.ctypes.data)


def _save(array, name: bytes, half: bool, writer) -> None:
    log = Log()
    kept, image = _image_of(array)
    params = structs["relume_image_params"](
        log=log.address, half=half, writer=ctypes.addressof(writer) if writer else None)
    log.check(lib.relume_image_save(ctypes.byref(image), name, ctypes.byref(params)))
    del kept


def save_image(array, path: str | os.PathLike, half: bool = False) -> None:
    """Write linear light [y, x] or [y, x, channel] in the format of the name's ending: EXR, HDR and
    PFM linear, all others sRGB-coded and clipped."""
    _save(array, os.fsencode(path), half, None)


def image_bytes(array, ending: str, half: bool = False) -> bytes:
    """The same as the bytes of a file: image_bytes(picture, ".png")."""
    buffer = Buffer()
    _save(array, b"memory" + ending.encode(), half, buffer.writer)
    return buffer.take()
