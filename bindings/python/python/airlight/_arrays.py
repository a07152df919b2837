"""Arrays out of whatever has numbers: sequences, scalars, and arrays of other libraries, by DLPack where they have it."""

from typing import Any

import numpy as np
from numpy.typing import NDArray


def floats(field: str, value: Any) -> NDArray[np.float32]:
    """`value` as a float32 array in row-major order."""
    with np.errstate(over="ignore"):
        return np.require(_array(field, value, "fiu", "numbers"), np.float32, ["C", "ALIGNED"])


def indices(field: str, value: Any) -> NDArray[np.uint32]:
    """`value` as a uint32 array in row-major order; what does not fit is an index beyond every table."""
    array = _array(field, value, "iu", "integers")
    beyond = np.iinfo(np.uint32).max
    return np.where((array < 0) | (array > beyond), beyond, array).astype(np.uint32)


def _array(field: str, value: Any, kinds: str, expected: str) -> NDArray[Any]:
    try:
        has_dlpack = hasattr(value, "__dlpack__") and not isinstance(value, np.ndarray)
        array: NDArray[Any] = np.from_dlpack(value) if has_dlpack else np.asarray(value)
    except Exception as error:
        raise ValueError(f"{field}: {error}") from error
    if array.dtype.kind not in kinds:
        raise ValueError(f"{field} has dtype {array.dtype}, expected {expected}")
    return array
