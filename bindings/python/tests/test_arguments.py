"""Arguments come as numpy users have them, and bad ones are named."""

import re
import types

import airlight
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

LAMP, FOG = airlight.Emitter((0, 1, 3), (0, -1, 0)), airlight.Medium(0.01, 0.1, 0.6)
SCENE = {"origin": (0, 0, 0), "direction": (0, 0, 1), "t_min": 0, "t_max": 4, "emitter": LAMP, "medium": FOG}


def only(array, *attributes):
    """An array of another library, which has these attributes alone."""
    return types.SimpleNamespace(**{attribute: getattr(array, attribute) for attribute in attributes})


def read_only(array):
    array = array.copy()
    array.flags.writeable = False
    return array


# Ways to hand over the float32 array of the same values; halves and small integers are exact in all.
FORMS = {
    "float32": lambda a: a,
    "float64": lambda a: a.astype(np.float64),
    "float16": lambda a: a.astype(np.float16),
    "big endian": lambda a: a.astype(">f4"),
    "strided": lambda a: np.repeat(a, 2, axis=0)[::2],
    "backwards": lambda a: a[::-1].copy()[::-1],
    "unaligned": lambda a: np.frombuffer(b"\0" + a.tobytes(), np.uint8)[1:].view(np.float32).reshape(a.shape),
    "list": lambda a: a.tolist(),
    "longdouble": lambda a: a.astype(np.longdouble),
    "column-major": np.asfortranarray,
    "read-only": read_only,
    "DLPack": lambda a: only(a, "__dlpack__", "__dlpack_device__"),
    "array interface": lambda a: only(a, "__array_interface__"),
    "__array__": lambda a: only(a, "__array__"),
}


@st.composite
def batches(draw):
    """Rays, how each argument is handed over, and how many variates a ray has."""
    n = draw(st.integers(0, 40))
    count = st.sampled_from([n, 1])
    halves = st.integers(-8, 8).map(lambda value: np.float32(value / 2))

    def column(values=halves, shape=()):
        length = (draw(count), *shape)
        flat = draw(st.lists(values, min_size=int(np.prod(length)), max_size=int(np.prod(length))))
        return np.array(flat, np.float32).reshape(length)

    k = draw(st.sampled_from([None, 1, 3]))
    unit = st.sampled_from([0.0, 0.25, 0.5, 1.0])
    arguments = {
        "origin": column(shape=(3,)),
        "direction": np.eye(3, dtype=np.float32)[draw(st.lists(st.integers(0, 2), min_size=n, max_size=n))],
        "t_min": column(st.sampled_from([0.0, 0.5])),
        "t_max": column(st.sampled_from([0.5, 4.0, np.inf])),
        "u": column(unit, () if k is None else (k,)),
    }
    forms = {name: draw(st.sampled_from(sorted(FORMS))) for name in arguments}
    return n, k, arguments, forms


@given(batches())
def test_arguments_may_have_any_form_that_numpy_makes_an_array_of(batch):
    n, k, arguments, forms = batch
    scene = {"emitter": LAMP, "medium": FOG}
    passed = {}
    for name, array in arguments.items():
        # An empty list has forgotten how many columns it had.
        form = "float32" if array.size == 0 and forms[name] == "list" else forms[name]
        passed[name] = FORMS[form](array)
    samples = airlight.sample(**passed, **scene)

    def full(array):
        return np.ascontiguousarray(np.broadcast_to(array, (n, *array.shape[1:])))

    repeated = {name: full(array) for name, array in arguments.items()}
    for name in ("origin", "direction"):
        repeated[name] = tuple(np.ascontiguousarray(column) for column in repeated[name].T)
    expected = airlight.sample(**repeated, **scene)
    assert samples.counts == expected.counts and sum(samples.counts[:3]) == n * (k or 1)
    for values, others in zip(samples[:4], expected[:4], strict=True):
        assert values.dtype == np.float32 and values.shape == ((n,) if k is None else (n, k))
        assert np.array_equal(values, others)


def test_columns_of_float32_are_used_where_they_lie():
    position = np.array([[0, 1, 3], [0, 1, 3]], np.float32).T.copy()
    lamps = airlight.Emitters.each(tuple(position))
    scene = SCENE | {"emitter": lamps, "u": 0.5}
    before = airlight.sample(**scene)
    position[2, 1] = 2
    after = airlight.sample(**scene)
    assert before.t[1] == before.t[0] == after.t[0] != after.t[1]


def test_an_object_with_x_y_and_z_is_three_columns():
    x, y, z = np.eye(3)
    vectors = types.SimpleNamespace(x=x, y=y, z=0), types.SimpleNamespace(x=0, y=0, z=z + [1, 1, 0])
    samples = airlight.sample(**SCENE | {"origin": vectors[0], "direction": vectors[1]}, u=0.5)
    expected = airlight.sample(**SCENE | {"origin": [[1, 0, 0], [0, 1, 0], [0, 0, 0]]}, u=0.5)
    assert np.array_equal(samples.t, expected.t)


def test_scalars_in_scalars_out():
    samples = airlight.sample(**SCENE, u=np.float64(0.25))
    for value in (*samples[:4], airlight.radiance(**SCENE), airlight.pdf(**SCENE, t=1)):
        assert isinstance(value, np.float32)
    choice = airlight.choose((0, 0, 0), (0, 0, 1), 0, 4, [LAMP], 1, FOG, 0.5)
    assert (choice.index, choice.probability) == (0, 1) and isinstance(choice.index, np.uint32)
    assert airlight.sample(**SCENE, u=[0.25]).t.shape == (1,)
    assert airlight.sample(**SCENE, u=np.zeros((1, 2))).t.shape == (1, 2)


class OnDevice:
    """An array in the memory of a GPU."""

    def __dlpack_device__(self):
        return (2, 0)

    def __dlpack__(self, **_):
        raise BufferError("cannot export to the CPU")


BAD = {
    "origin": [
        (0, 0),
        (0, 0, 0, 0),
        np.zeros((2, 4)),
        np.zeros(()),
        np.zeros((2, 3, 1)),
        "here",
        np.zeros(3, complex),
        np.zeros(3, bool),
        OnDevice(),
    ],
    "direction": [np.zeros((2, 2)), None, [[0, 0, 1], [0, 1]], (0, "up", 0), (0, OnDevice(), 0)],
    "t_min": [np.zeros((2, 1)), np.zeros(2, "M8[s]"), OnDevice()],
    "t_max": ["far", {}, [object()]],
    "u": [np.zeros((5, 0)), np.zeros((1, 1, 1)), np.zeros(2, object), OnDevice()],
    "strategy": ["", "product-4"],
    "precision": ["exactly", ""],
    "threads": [0, -1],
}


@pytest.mark.parametrize(("name", "value"), [(name, value) for name, values in BAD.items() for value in values])
def test_a_bad_argument_is_named(name, value):
    with pytest.raises(ValueError, match=rf"^{name}\b"):
        airlight.sample(**SCENE | {"u": 0.5, name: value})


def test_a_strategy_without_fast_precision_is_named():
    with pytest.raises(ValueError, match="^precision: .*product-3"):
        airlight.sample(**SCENE, u=0.5, strategy="product-3", precision="fast")


@pytest.mark.parametrize("name", ["origin", "direction", "t_min", "t_max", "u", "emitter", "medium"])
def test_lengths_that_differ_are_named(name):
    three, five = np.ones(3), np.ones(5)
    values = {
        "emitter": airlight.Emitters.each((five, 0, 0)),
        "medium": airlight.Media.table([FOG], [0] * 5),
        "origin": (0, 0, five),
        "direction": np.ones((5, 3)),
    }
    scene = SCENE | {"t_max": three, "u": 0.5, name: values.get(name, five)}
    if name == "t_max":
        scene["t_min"] = three
    with pytest.raises(ValueError, match=rf"{name}.* is of 5 rays.* of 3|of 3 rays, but {name}.* of 5"):
        airlight.sample(**scene)
    with pytest.raises(ValueError, match="^t is of 5 rays, but t_max is of 3"):
        airlight.pdf(**SCENE | {"t_max": three}, t=np.ones((5, 2)))


BAD_OBJECTS = {
    "position": lambda: airlight.Emitter((np.nan, 0, 0)),
    "position is": lambda: airlight.Emitter(np.zeros((2, 3))),
    "normal": lambda: airlight.Emitter((0, 0, 0), (1, 1, 0)),
    "axis": lambda: airlight.Emitter.spot((0, 0, 0), (0, 0, 2), 0.5, 0.6),
    "cos_outer": lambda: airlight.Emitter.spot((0, 0, 0), (0, 0, 1), -0.1, 0.6),
    "cos_inner": lambda: airlight.Emitter.spot((0, 0, 0), (0, 0, 1), 0.5, 0.4),
    "mu_a": lambda: airlight.Medium(-1, 1, 0),
    "mu_s": lambda: airlight.Medium(0, np.inf, 0),
    "mu_a has 2 channels": lambda: airlight.Medium([1, 1], 0, 0),
    "mu_s has 3 channels": lambda: airlight.Medium([0, 1, 2, 3], [1, 1, 1], 0),
    "mu_a has 0 channels": lambda: airlight.Medium([], [], 0),
    "g": lambda: airlight.Medium(0, 1, 1.5),
    "mu_a has 2 channels ": lambda: airlight.Media.each((0.1, 0.2), 1, 0),
    "mu_s has 4 channels": lambda: airlight.Media.each((0.1, 0.2, 0.3), np.ones((5, 4)), 0),
    "table is empty": lambda: airlight.Emitters.table([], [0]),
    "index has dtype float64": lambda: airlight.Media.table([FOG], [0.5]),
    "table is empty ": lambda: airlight.choose((0, 0, 0), (0, 0, 1), 0, 4, [], [], FOG, 0.5),
    "weights": lambda: airlight.choose((0, 0, 0), (0, 0, 1), 0, 4, [LAMP], [1, 2], FOG, 0.5),
    "weights is -1": lambda: airlight.choose((0, 0, 0), (0, 0, 1), 0, 4, [LAMP], -1, FOG, 0.5),
    "u has shape": lambda: airlight.choose((0, 0, 0), (0, 0, 1), 0, 4, [LAMP], 1, FOG, [[0.5]]),
    "nodes": lambda: airlight.radiance(**SCENE, nodes=5),
}


@pytest.mark.parametrize("told", BAD_OBJECTS)
def test_a_bad_value_is_named(told):
    with pytest.raises(ValueError, match="^" + re.escape(told.strip()) + r"\b"):
        BAD_OBJECTS[told]()


@pytest.mark.parametrize("name", ["emitter", "medium"])
def test_objects_of_another_kind_are_named(name):
    with pytest.raises(TypeError, match=f"^{name} is .*int"):
        airlight.sample(**SCENE | {"u": 0.5, name: 3})


def test_memory_that_there_is_not():
    with pytest.raises(MemoryError):
        airlight.sample(**SCENE | {"t_max": np.ones(1 << 20)}, u=np.full((1, 1 << 22), 0.5))


def test_media_of_a_table_have_as_many_channels():
    media = airlight.Media.table([FOG, airlight.Medium(0.1, (0.1, 0.2, 0.3), 0.6)], [0, 1])
    with pytest.raises(ValueError, match=r"^medium: .*\[\d\] has \d channel"):
        airlight.sample(**SCENE | {"medium": media}, u=0.5)
