"""Rate and distortion: bases and sizes, judged by lights that they have not seen."""

from __future__ import annotations

import ctypes
import dataclasses
from typing import Iterable, Iterator

from ._abi import structs
from ._capture import Capture, basis_named, parse
from ._file import File
from ._library import Handle, InputError, Log, Progress, UsageError, lib, log


@dataclasses.dataclass(frozen=True)
class SweepRow:
    """One basis and size; the fields of a row of `relume sweep`."""

    basis: str
    coefficients: int
    bits: str
    file_bytes: int
    bits_per_pixel: float
    captured_db: float
    """PSNR of the captured photographs, from the file"""
    unseen_db: float
    """PSNR of lights left out, from coefficients as the file stores them; NaN: not measured"""


class _Heldout(Handle):
    def __init__(self, capture: Capture, leave_out: int, progress: Progress | None):
        super().__init__(lib.relume_heldout_destroy)
        self.log, self.capture = Log(progress), capture
        params = structs["relume_heldout_params"](log=self.log.address, leave_out=leave_out)
        self.log.check(lib.relume_heldout_open(self.out, capture.pointer, ctypes.byref(params)))

    def judge(self, basis: str, coefficients: int, bits: str) -> float:
        quality = structs["relume_heldout_quality"]
        store = structs["relume_heldout_store"](parse(lib.relume_storage_parse, bits, "bits"))
        before, after = quality(), quality()
        how = structs["relume_coder_params"](log=self.log.address, coefficients=coefficients)
        self.log.check(lib.relume_heldout_measure(
            self.pointer, basis_named(basis), ctypes.byref(how), ctypes.byref(store), 1,
            ctypes.byref(before), ctypes.byref(after)))
        return after.psnr_db


def _row(capture: Capture, heldout: _Heldout | None, basis: str, k: int, bits: str) -> SweepRow:
    data, report = capture.encode(basis=basis, coefficients=k, bits=bits)
    with File(data) as file:
        found = file.evaluate(capture, ssim=False, delta_e=False)
    unseen = heldout.judge(basis, k, bits) if heldout else float("nan")
    return SweepRow(basis, report.coefficients, bits, len(data), found.bits_per_pixel,
                    found.psnr_db, unseen)


def sweep(capture: Capture, bases: Iterable[str], coefficients: Iterable[int],
          bits: str | int = "8", leave_out: int = 1,
          progress: Progress | None = None) -> Iterator[SweepRow]:
    """A row for every basis and number of coefficients that the basis has, as they are ready.

    `leave_out`: lights left out at a time; 0: unseen lights are not measured.
    """
    sizes = list(coefficients)
    heldout = _Heldout(capture, leave_out, progress) if leave_out else None
    for basis in bases:
        basis_named(basis)
        for k in sizes:
            try:
                yield _row(capture, heldout, basis, k, str(bits))
            except (UsageError, InputError) as why:
                log.info("%s %d is left out: %s", basis, k, why)
