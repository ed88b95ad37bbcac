"""The C library: found, loaded, and its statuses and sentences as exceptions and log records."""

from __future__ import annotations

import ctypes
import ctypes.util
import errno
import logging
import os
import pathlib
from typing import Callable, Mapping, Optional

from . import _abi
from ._abi import CONSTANTS, structs

Progress = Callable[[str, float], Optional[bool]]
"""Called with what is being done and the part that is done, 0 to 1; False stops the work."""

log = logging.getLogger("relume")


class Error(Exception):
    """The library could not do it; the text is its sentence. `status` is that of relume/base.h."""

    status = 0


class UsageError(Error, ValueError):
    """An argument is unknown or out of range."""


class InputError(Error):
    """An input is at fault; what is raised is one of the six below."""


class NotFoundError(InputError, FileNotFoundError):
    """An input is not there, or cannot be opened or read."""


class FormatError(InputError):
    """An input is something else than what is expected."""


class DamagedError(InputError):
    """An input is cut short, or its values are broken."""


class LimitError(InputError):
    """An input is larger than the limits."""


class UnsupportedError(InputError):
    """An input is sound, but of a kind or version that this library does not do."""


class UnfitError(InputError):
    """An input is sound, but does not do here: sizes differ, lights are too few."""


class OutputError(Error, OSError):
    """An output cannot be written."""


class MachineError(Error, OSError):
    """The machine lacks something: threads, a module."""


class Cancelled(Error):
    """A progress function asked to stop."""


def _candidates():
    if os.environ.get("RELUME_LIBRARY"):
        yield os.environ["RELUME_LIBRARY"]
        return
    beside = pathlib.Path(__file__).parent
    yield from (str(p) for p in sorted(beside.glob("librelume.so*")))
    yield from ("librelume.so.0", "librelume.so")
    found = ctypes.util.find_library("relume")
    if found:
        yield found


def _load() -> ctypes.CDLL:
    tried = []
    for name in _candidates():
        try:
            library = ctypes.CDLL(name)
            _abi.bind(library)
            return library
        except (OSError, AttributeError) as why:
            tried.append(f"{name}: {why}")
    raise ImportError(
        "librelume.so cannot be loaded; install relume, or set RELUME_LIBRARY to the path of the "
        "library; tried " + "; ".join(tried))


lib = _load()

_EXCEPTIONS = {
    CONSTANTS["RELUME_ENOTFOUND"]: NotFoundError,
    CONSTANTS["RELUME_EFORMAT"]: FormatError,
    CONSTANTS["RELUME_EDAMAGED"]: DamagedError,
    CONSTANTS["RELUME_ELIMIT"]: LimitError,
    CONSTANTS["RELUME_EUNSUPPORTED"]: UnsupportedError,
    CONSTANTS["RELUME_EUNFIT"]: UnfitError,
    CONSTANTS["RELUME_EINVAL"]: UsageError,
    CONSTANTS["RELUME_EIO"]: OutputError,
    CONSTANTS["RELUME_ESYSTEM"]: MachineError,
    CONSTANTS["RELUME_ECANCEL"]: Cancelled,
    CONSTANTS["RELUME_ECODER"]: MachineError,
}
_MESSAGE = ctypes.CFUNCTYPE(None, ctypes.c_void_p, ctypes.c_int, ctypes.c_char_p)
_PROGRESS = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_char_p, ctypes.c_double)


class Log:
    """A relume_log: keeps the sentences of errors, passes warnings and notes on to logging."""

    def __init__(self, progress: Progress | None = None, context: Context | None = None):
        self._progress, self._errors = progress, []
        self._raised: BaseException | None = None
        self._functions = (_MESSAGE(self._hear), _PROGRESS(self._go_on))
        self.struct = structs["relume_log"](
            ctypes.cast(self._functions[0], ctypes.c_void_p),
            ctypes.cast(self._functions[1], ctypes.c_void_p) if progress else None,
            context=context.pointer if context else None)
        self._context = context  # lives as long

    @property
    def address(self) -> int:
        return ctypes.addressof(self.struct)

    def _hear(self, _user, level, text):
        sentence = text.decode("utf-8", "replace")
        if level == CONSTANTS["RELUME_ERROR"]:
            self._errors.append(sentence)
        else:
            warning = level == CONSTANTS["RELUME_WARNING"]
            log.log(logging.WARNING if warning else logging.INFO, "%s", sentence)

    def _go_on(self, _user, what, done):
        try:
            return self._progress(what.decode(), done) is not False
        except BaseException as error:  # comes out of the call that is under way
            self._raised = error
            return False

    def check(self, status: int) -> None:
        """Raise what a status means."""
        raised, errors = self._raised, self._errors
        self._raised, self._errors = None, []
        if status == CONSTANTS["RELUME_OK"]:
            return
        if raised is not None:
            raise raised
        if status == CONSTANTS["RELUME_ENOMEM"]:
            raise MemoryError("relume: out of memory")
        error = _EXCEPTIONS.get(status, Error)(
            "; ".join(errors) or lib.relume_status_text(status).decode())
        error.status = status
        raise error


class Handle:
    """An object of the library that one function destroys."""

    def __init__(self, destroy):
        self._pointer, self._destroy = ctypes.c_void_p(), destroy

    @property
    def out(self):
        """Where the library puts the object."""
        return ctypes.byref(self._pointer)

    @property
    def pointer(self) -> ctypes.c_void_p:
        if not self._pointer:
            raise ValueError(f"this {type(self).__name__} is closed")
        return self._pointer

    def close(self) -> None:
        """Give the memory back. Closing twice is fine."""
        if self._pointer:
            self._destroy(ctypes.byref(self._pointer))

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def __del__(self):
        self.close()


_OPEN = ctypes.CFUNCTYPE(ctypes.c_bool, ctypes.c_void_p, ctypes.c_char_p,
                         ctypes.POINTER(structs["relume_reader"]), use_errno=True)


class Context(Handle):
    """What calls share: the number of threads, limits (max_side, max_pixels, max_lights, max_views,
    max_memory, any_format), and `files`: names and bytes that are read in place of the file system,
    as {"coin/capture.json": ..., "coin/0.png": ...}."""

    def __init__(self, *, files: Mapping[str, bytes] | None = None, threads: int = 0, **limits):
        super().__init__(lib.relume_context_destroy)
        self._files, self._limits = files, structs["relume_limits"](**limits)
        self._open = _OPEN(self._find)
        params = structs["relume_context_params"](
            limits=ctypes.addressof(self._limits), threads=threads)
        if files is not None:
            params.files.open = ctypes.cast(self._open, ctypes.c_void_p)
        if lib.relume_context_create(self.out, ctypes.byref(params)):
            raise MemoryError("relume: out of memory")

    def _find(self, _user, path, out):
        data = self._files.get(os.fsdecode(path))
        if data is None:
            ctypes.set_errno(errno.ENOENT)
            return False
        out[0] = lib.relume_memory_reader(ctypes.cast(ctypes.c_char_p(data), ctypes.c_void_p),
                                          len(data))
        return True
