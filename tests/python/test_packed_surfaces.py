"""Surfaces that netCDF4 and xarray pack, as these two and the program read them."""

import h5py
import netCDF4
import numpy as np
import xarray
from checkout import Folder, program

SHAPE = (7, 5)


def stored(kind):
    """Integers over the whole range of a type, in a fixed order, with its ends and 0.

    None of them is what netCDF4 takes for a place that was never written, which xarray and the program do not do.
    """
    limits = np.iinfo(kind)
    numbers = np.random.default_rng(1).integers(limits.min, limits.max, SHAPE, dtype=kind, endpoint=True)
    numbers.ravel()[:5] = [limits.min, limits.max, 0, 1, limits.max - 1]
    return np.where(numbers == netCDF4.default_fillvals[kind], limits.max - 2, numbers).astype(kind)


class Packed(Folder):
    def setUp(self):
        super().setUp()
        self.file = self.folder / "packed.nc"

    def write(self, numbers, **attributes):
        """With netCDF4: dimensions (x, y), 2 um and 3 um apart."""
        fill = attributes.pop("_FillValue", None)
        with netCDF4.Dataset(self.file, "w") as out:
            out.createDimension("x", SHAPE[0])
            out.createDimension("y", SHAPE[1])
            for name, step in (("x", 2e-6), ("y", 3e-6)):
                axis = out.createVariable(name, "f8", (name,))
                axis[:] = step * np.arange(len(out.dimensions[name]))
                axis.units = "m"
            variable = out.createVariable("z", numbers.dtype, ("x", "y"), fill_value=fill)
            variable.set_auto_maskandscale(False)
            variable.setncatts({"units": "m", **attributes})
            variable[:] = numbers

    def read(self):
        """What the program reads."""
        out = self.folder / "out.h5"
        program("surface", self.file, "--to", out, "--force")
        with h5py.File(out) as file:
            np.testing.assert_allclose(file["height"].attrs["pitch"], [2e-6, 3e-6], rtol=1e-15)
            return file["height"][...]

    def by_netcdf4(self):
        with netCDF4.Dataset(self.file) as file:
            return np.ma.filled(np.ma.asarray(file["z"][:], dtype="f8"), np.nan)

    def by_xarray(self):
        with xarray.open_dataset(self.file, engine="netcdf4") as file:
            return np.asarray(file["z"].values, dtype="f8")

    def compare(self, missing, readers=None):
        found = self.read()
        self.assertEqual(np.isnan(found).sum(), missing)
        for reader in readers or (self.by_netcdf4, self.by_xarray):
            np.testing.assert_allclose(found, reader(), rtol=1e-14, atol=1e-18, err_msg=reader.__name__)

    def test_scale_and_offset(self):
        for kind in ("i1", "i2", "i4", "u1", "u2", "u4"):
            with self.subTest(kind):
                scale = 1e-5 / np.iinfo(kind).max
                self.write(stored(kind), scale_factor=scale, add_offset=2e-6)
                self.compare(0)

    def test_marks(self):
        numbers = stored("i2")
        self.write(numbers, _FillValue=np.int16(0), missing_value=np.int16(32767), scale_factor=1e-10)
        self.compare(2)
        heights = (1e-9 * numbers).astype("f4")
        heights[3, 3] = -999.9
        self.write(heights, missing_value=np.float32(-999.9))
        self.compare(1)

    def test_signs(self):
        for kind, unsigned in (("i1", "true"), ("i2", "true"), ("i4", "true"), ("u1", "false"), ("u2", "false"), ("u4", "false")):
            with self.subTest(kind):
                numbers = stored(kind)
                scale = 1e-5 / np.iinfo(kind).max
                self.write(numbers, _Unsigned=unsigned, scale_factor=scale, add_offset=-1e-6, _FillValue=numbers[0, 1])
                # netCDF4 has no use for "false".
                self.compare(1, [self.by_xarray] if unsigned == "false" else None)
        for kind, unsigned in (("i2", "false"), ("u2", "true")):
            with self.subTest(f"{kind} as it is"):
                self.write(stored(kind), _Unsigned=unsigned, scale_factor=1e-10)
                self.compare(0)

    def test_valid_numbers(self):
        numbers = stored("i2")
        # xarray leaves these to its user.
        for bounds in (
            {"valid_range": np.array([-20000, 15000], "i2")},
            {"valid_min": np.int16(-20000)},
            {"valid_max": np.int16(15000)},
            {"valid_min": np.int16(-20000), "valid_max": np.int16(15000)},
        ):
            with self.subTest(bounds):
                self.write(numbers, scale_factor=1e-10, add_offset=1e-6, **bounds)
                least, largest = bounds.get("valid_range", [bounds.get("valid_min", -40000), bounds.get("valid_max", 40000)])
                outside = (numbers < least) | (numbers > largest)
                self.assertGreater(outside.sum(), 0)
                self.compare(outside.sum(), [self.by_netcdf4])
                with xarray.open_dataset(self.file, engine="netcdf4") as file:
                    np.testing.assert_allclose(self.read(), file["z"].where(~outside).values, rtol=1e-14, atol=1e-18)
        # Of bytes that have no sign, with the range in the type that is stored: 0 to 200. netCDF4 cannot read them without a mark.
        numbers = stored("i1")
        valid = np.array([0, 200 - 256], "i1")
        self.write(numbers, _Unsigned="true", scale_factor=1e-8, valid_range=valid, _FillValue=np.int8(0))
        numbers = numbers.view("u1")
        self.compare(((numbers > 200) | (numbers == 0)).sum(), [self.by_netcdf4])
        # Floating-point heights.
        heights = (1e-9 * stored("i2")).astype("f4")
        self.write(heights, valid_range=np.array([-1e-5, 2e-5], "f4"))
        self.compare(((heights < np.float32(-1e-5)) | (heights > np.float32(2e-5))).sum(), [self.by_netcdf4])

    def test_what_xarray_packs(self):
        heights = 1e-9 * stored("i2").astype("f8")
        heights[2, 2] = np.nan
        axes = {"y": ("y", 2e-6 + 3e-6 * np.arange(5), {"units": "m"}), "x": ("x", 2e-6 * np.arange(7), {"units": "m"})}
        data = xarray.Dataset({"z": (("y", "x"), heights.T, {"units": "m"})}, axes)
        packing = {"dtype": "i2", "scale_factor": 1e-9, "add_offset": 1e-9, "_FillValue": -32768}
        # Coordinates that are packed, too.
        axis = {"dtype": "i2", "scale_factor": 1e-6, "add_offset": 2e-6, "_FillValue": -1}
        data.to_netcdf(self.file, engine="netcdf4", encoding={"z": packing, "y": axis})
        found = self.read()
        self.assertEqual(np.isnan(found).sum(), 1 + (heights == -32767e-9).sum())
        np.testing.assert_allclose(found, self.by_xarray().T, rtol=1e-14, atol=1e-18)
