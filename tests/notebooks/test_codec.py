"""The codec's own end; codec.test.mjs holds it against the front end's."""

import numpy as np
import pytest

from boresight_widget import codec

ARRAYS = [np.array([0, 1, 100], dtype) for dtype in ("i1", "u1", "i2", "u2", "i4", "u4", "f4", "f8")]


def through(value):
    return codec.unpack(codec.pack(value))


@pytest.mark.parametrize("array", ARRAYS, ids=lambda array: array.dtype.str)
def test_arrays_keep_kind_and_numbers(array):
    found = through({"a": [array, array[:0]]})["a"]
    assert found[0].dtype == array.dtype and found[1].dtype == array.dtype
    np.testing.assert_array_equal(found[0], array)
    assert found[1].size == 0


@pytest.mark.parametrize(
    ("given", "dtype", "numbers"),
    [
        (np.array([True, False]), "u1", [1, 0]),
        (np.array([-(2**31), 2**31 - 1]), "i4", [-(2**31), 2**31 - 1]),
        (np.array([2**31]), "f8", [2**31]),
        (np.array([2**53], dtype="u8"), "f8", [2**53]),
        (np.array([1.5], dtype="f2"), "f4", [1.5]),
        (np.array([1.5], dtype=">f8"), "f8", [1.5]),
        (np.array([1 + 2j, 3], dtype="c8"), "f4", [1, 2, 3, 0]),
        (np.arange(6).reshape(2, 3).T, "i4", [0, 3, 1, 4, 2, 5]),
        (np.arange(6.0)[::-2], "f8", [5, 3, 1]),
    ],
)
def test_other_arrays_become_those(given, dtype, numbers):
    found = through(given)
    assert found.dtype == np.dtype(dtype)
    np.testing.assert_array_equal(found, numbers)


def test_what_is_no_array_stays_as_it_is():
    value = {"text": "ä", "none": None, "yes": True, "count": 3, "list": [1.5, "x", []], "nested": {"a": {}}}
    assert through(value) == value
    found = through([float("nan"), float("inf"), -np.inf, np.float32(1.5), np.int64(7), np.bool_(True), 1 + 2j])
    assert np.isnan(found[0])
    assert found[1:] == [np.inf, -np.inf, 1.5, 7, True, [1, 2]]
    assert through(b"\x00\xff").tolist() == [0, 255]
    assert through(codec.Records(a=np.array([1, 2]), b=np.array([3.5, 4]))) == [{"a": 1, "b": 3.5}, {"a": 2, "b": 4}]


def test_numbers_of_arrays_are_not_spelt_out():
    size = len(codec.pack({"a": np.linspace(0, 1, 1000)}))
    assert 8000 < size < 8100


@pytest.mark.parametrize(
    ("value", "words"),
    [
        ({1: 2}, "1 is no key"),
        ({"$array": 2}, "does not begin with"),
        (np.array(["a"]), "it takes numbers"),
        (object(), "object cannot be sent"),
    ],
)
def test_what_cannot_be_sent_is_refused(value, words):
    with pytest.raises(TypeError, match=words):
        codec.pack(value)
    with pytest.raises(ValueError, match=r"beyond 2\^53"):
        codec.pack(np.array([2**53 + 1]))
