"""Arrays out of whatever has numbers: sequences, scalars, and the arrays of other libraries, by DLPack where they have it."""

import numpy as np


def floats(field, value):
    """`value` as a float32 array in row-major order."""
    return _converted(field, value, "fiu", "numbers", np.float32)


def indices(field, value):
    """`value` as a uint32 array in row-major order; what does not fit is an index beyond every table."""
    array = _converted(field, value, "iu", "integers")
    beyond = np.iinfo(np.uint32).max
    return np.where((array < 0) | (array > beyond), beyond, array).astype(np.uint32)


def _converted(field, value, kinds, expected, dtype=None):
    try:
        has_dlpack = hasattr(value, "__dlpack__") and not isinstance(value, np.ndarray)
        array = np.from_dlpack(value) if has_dlpack else np.asarray(value)
    except Exception as error:
        raise ValueError(f"{field}: {error}") from error
    if array.dtype.kind not in kinds:
        raise ValueError(f"{field} has dtype {array.dtype}, expected {expected}")
    with np.errstate(over="ignore"):
        return np.require(array, dtype, ["C", "ALIGNED"])
