"""Image-based relighting with NumPy arrays: encode pictures under many lights, relight them.

    import relume
    data = relume.encode(pictures, directions)          # [light, y, x, 3] and [light, 3]
    picture = relume.open(data).relight("dir 1 0.5 1")  # [y, x, 3], linear

Errors are `relume.Error` with the library's sentence; warnings go to logging, "relume".
"""

from ._arrays import image_bytes, load_image, save_image
from ._capture import Capture, EncodeReport, bases, encode, light_directions
from ._file import Evaluation, File, Info, open
from ._library import (Cancelled, Context, DamagedError, Error, FormatError, InputError, LimitError,
                       MachineError, NotFoundError, OutputError, UnfitError, UnsupportedError,
                       UsageError)
from ._sweep import SweepRow, sweep

__all__ = [
    "Cancelled", "Capture", "Context", "DamagedError", "EncodeReport", "Error", "Evaluation", "File",
    "FormatError", "Info", "InputError", "LimitError", "MachineError", "NotFoundError",
    "OutputError", "SweepRow", "UnfitError", "UnsupportedError", "UsageError", "bases", "encode",
    "image_bytes", "light_directions", "load_image", "open", "save_image", "sweep",
]
__version__ = "0.1.0"
