"""Fields hold what arrays and files say, where they say it, and refuse what is no density."""

import numpy as np
import pytest
import xarray as xr
from clouds import ENGINES, write_cloud

import freepath as fp


def uneven(shape=(3, 10, 17), dtype=np.float32):
    """Values that are all different, over more than one brick."""
    return (1 + np.arange(np.prod(shape))).reshape(shape).astype(dtype)


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize(
    "layout",
    {
        "contiguous": lambda a: a,
        "Fortran order": np.asfortranarray,
        "every second": lambda a: np.repeat(a, 2, axis=2)[:, :, ::2],
        "backwards": lambda a: np.ascontiguousarray(a[::-1, :, ::-1])[::-1, :, ::-1],
        "big-endian": lambda a: a.astype(a.dtype.newbyteorder(">")),
    }.items(),
    ids=lambda item: item[0],
)
def test_arrays_of_any_layout_come_back_as_they_were(dtype, layout):
    values = uneven(dtype=dtype)
    given = layout[1](values)
    given.flags.writeable = False
    field = fp.Field.from_array(given)
    assert np.array_equal(field.to_array(), values)
    assert field.to_array().dtype == np.float32
    assert field.shape == values.shape and field.first_voxel == (0, 0, 0)


def test_first_axis_is_x_unless_axes_say_otherwise():
    values = uneven((2, 3, 4))
    for given, axes in [(values, None), (values.transpose(2, 1, 0), "zyx"), (values.swapaxes(0, 1), "yxz")]:
        assert np.array_equal(fp.Field.from_array(given, axes=axes).to_array(), values)


def test_names_of_dimensions_tell_axes():
    values = uneven((2, 3, 4))
    array = xr.DataArray(values.transpose(2, 0, 1), dims=("z", "x", "y"))
    assert np.array_equal(fp.Field.from_array(array).to_array(), values)


def test_a_ray_along_each_axis_meets_the_voxels_of_that_axis():
    """Asymmetric field, nearest voxels: the transmittance of a ray is that of its row."""
    values = uneven((2, 3, 4)) / 10
    size, origin = np.array([0.5, 0.25, 0.125]), np.array([10.0, -3.0, 2.0])
    field = fp.Field.from_array(values, voxel_size=size, origin=origin)
    voxel = np.array([1, 2, 0])
    for axis in range(3):
        start = origin + (voxel + 0.5) * size
        start[axis] = origin[axis] - 1
        row = [values[tuple(i if a == axis else voxel[a] for a in range(3))] for i in range(values.shape[axis])]
        result = fp.transmittance(
            field, start, np.eye(3)[axis], estimator="regular", samples=1, interpolation="nearest"
        )
        assert result.mean == pytest.approx(np.exp(-np.sum(row) * size[axis]), rel=1e-5)


def test_transform_is_that_of_openvdb():
    turn = np.array([[0, 2, 0, 0], [-2, 0, 0, 0], [0, 0, 3, 0], [5, 6, 7, 1.0]])
    field = fp.Field.from_array(np.ones((2, 2, 2)), transform=turn)
    assert np.array_equal(field.transform, turn)
    # Index (0..2, 0..2, 0..2) - 1/2: x of the world is 5 - 2j, y is 6 + 2i, z is 7 + 3k.
    assert np.allclose(fp.Medium(field).bounds, [[2, 5, 5.5], [6, 9, 11.5]])


def test_voxel_size_and_origin_place_the_first_corner():
    medium = fp.Medium(fp.Field.from_array(np.ones((2, 3, 4)), voxel_size=[1, 2, 3], origin=[-1, 0, 1]))
    assert np.allclose(medium.bounds, [[-1, 0, 1], [1, 6, 13]])


def test_zeros_count_as_voxels():
    values = np.zeros((30, 4, 4), np.float32)
    values[12, 1, 1] = 1
    field = fp.Field.from_array(values)
    assert field.shape == (30, 4, 4)
    assert np.allclose(fp.Medium(field).bounds, [[0, 0, 0], [30, 4, 4]])


def test_dlpack_is_read():
    class Tensor:
        def __init__(self, array):
            self.array = array

        def __dlpack__(self, **options):
            return self.array.__dlpack__(**options)

        def __dlpack_device__(self):
            return self.array.__dlpack_device__()

    values = uneven()
    assert np.array_equal(fp.Field.from_array(Tensor(values)).to_array(), values)


def test_files_keep_field_and_transform(tmp_path):
    values = uneven()
    field = fp.Field.from_array(values, voxel_size=0.1, origin=[1, 2, 3], name="smoke")
    field.save(tmp_path / "smoke.vdb")
    again = fp.Field.open(tmp_path / "smoke.vdb")
    assert again.name == "smoke"
    assert np.array_equal(again.to_array(), values)
    assert np.allclose(again.transform, field.transform, rtol=1e-12)
    assert np.array_equal(fp.Field.open(tmp_path / "smoke.vdb", grid="smoke").to_array(), values)
    with pytest.raises(fp.Error, match="fire"):
        fp.Field.open(tmp_path / "smoke.vdb", grid="fire")
    with pytest.raises(fp.Error, match="missing.vdb"):
        fp.Field.open(tmp_path / "missing.vdb")


@pytest.mark.parametrize("kind", ENGINES)
def test_clouds_in_netcdf_are_extinctions_in_meters(kind, tmp_path):
    extinction = write_cloud(tmp_path / "cloud.nc", kind)
    field = fp.Field.open(tmp_path / "cloud.nc")
    assert field.name == "extinction"
    assert np.allclose(field.to_array(), extinction, rtol=1e-6)
    assert np.allclose(np.diag(field.transform), [50, 25, 40, 1])


def with_value(value):
    values = uneven((9, 9, 9))
    values[8, 1, 2] = value
    return values


BAD = {
    "two axes": (np.ones((3, 3)), {}, r"shape is \(3, 3\)"),
    "empty": (np.ones((3, 0, 3)), {}, "empty"),
    "whole numbers": (np.ones((3, 3, 3), int), {}, "dtype is int64"),
    "half": (np.ones((3, 3, 3), np.float16), {}, "dtype is float16"),
    "complex": (np.ones((3, 3, 3), complex), {}, "dtype is complex128"),
    "objects": (np.full((3, 3, 3), None), {}, "dtype is object"),
    "text": ("density", {}, "str is no array"),
    "NaN": (with_value(np.nan), {}, r"voxel \(8, 1, 2\) is NaN.*invalid='zero'"),
    "infinite": (with_value(np.inf), {}, r"voxel \(8, 1, 2\) is infinite"),
    "negative": (with_value(-2), {}, r"voxel \(8, 1, 2\) is negative \(-2\).*negative='clamp'"),
    "too large for float": (with_value(1).astype(float) * 1e40, {}, "out of the range of float"),
    "larger than memory": (np.broadcast_to(np.float32(1), (10**5,) * 3), {}, "memory"),
    "axes": (np.ones((3, 3, 3)), {"axes": "xyy"}, "permutation"),
    "voxel size 0": (np.ones((3, 3, 3)), {"voxel_size": 0}, "positive"),
    "two voxel sizes": (np.ones((3, 3, 3)), {"voxel_size": [1, 2]}, "neither one"),
    "singular": (np.ones((3, 3, 3)), {"transform": np.diag([1, 1, 0, 1.0])}, "invertible"),
    "projective": (np.ones((3, 3, 3)), {"transform": np.ones((4, 4))}, "4x4 matrix"),
    "both places": (np.ones((3, 3, 3)), {"transform": np.eye(4), "voxel_size": 1}, "says again"),
    "word": (np.ones((3, 3, 3)), {"negative": "ignore"}, "there are: error, clamp"),
}


@pytest.mark.parametrize("values, options, message", BAD.values(), ids=BAD.keys())
def test_what_is_no_density_has_one_clear_error(values, options, message):
    with pytest.raises(fp.Error, match=f"(?s){message}"):
        fp.Field.from_array(values, **options)


def test_negative_and_invalid_values_are_mended_with_a_warning_where_that_is_wished():
    with pytest.warns(UserWarning, match="1 negative density was taken as 0"):
        assert fp.Field.from_array(with_value(-2), negative="clamp").to_array()[8, 1, 2] == 0
    with pytest.warns(UserWarning, match="taken as 0"):
        assert fp.Field.from_array(with_value(np.nan), invalid="zero").to_array()[8, 1, 2] == 0


def test_errors_are_value_errors():
    assert issubclass(fp.Error, ValueError) and fp.Error.__module__ == "freepath"
