"""Makes the tables, arrays and images of the folder surfaces: 5 columns (x) by 4 rows (y) of n = 4 x + y.

python make_tables.py            (numpy, pillow, tifffile, h5py)
"""

import h5py
import numpy as np
import tifffile
from PIL import Image

n = np.arange(20).reshape(5, 4)  # [x, y], as in HDF5 and .npy
lines = n.T  # [y, x], as in text: the first line at y = 0
picture = n.T[::-1]  # [line, x], as in images: the first line at the top, where y is largest

for name, kind in [("f2", "<f2"), ("f4be", ">f4"), ("f8", "<f8"), ("i1", "|i1"), ("u2be", ">u2"), ("i8", "<i8")]:
    np.save(f"surfaces/{name}.npy", n.astype(kind))
holed = n * 1.0
holed[2, 1] = np.nan
np.save("surfaces/fortran_holed.npy", np.asfortranarray(holed))
np.savez("surfaces/one_of_two.npz", pitch=np.array([1.0, 2.0]), z=holed)
np.savez_compressed("surfaces/two.npz", a=n * 1.0, b=-n * 1.0)

with h5py.File("surfaces/pitch.h5", "w") as file:
    dataset = file.create_dataset("height", data=n * 1e-6)
    dataset.attrs["units"] = "m"
    dataset.attrs["pitch"] = [5e-5, 2.5e-5]

np.savetxt("surfaces/matrix.txt", lines, fmt="%g", header="unit: um\npitch: 50 um, 25 um")
text = "\n".join("\t".join(f"{v:.6f}" for v in row) for row in lines)
open("surfaces/gwyddion.txt", "w").write(f"# Channel: Height\n# Width: 250 µm\n# Height: 100 µm\n# Value units: um\n{text}\n")
points = [(x, y) for x in range(5) for y in range(4) if (x, y) != (2, 1)]
np.random.default_rng(1).shuffle(points)
open("surfaces/list.csv", "w", encoding="utf-8-sig").write("x [um],y [um],z [um]\n" + "".join(f"{50 * x},{25 * y},{n[x, y]}\n" for x, y in points))
open("surfaces/list.xyz", "w").write("# unit: um\n" + "".join(f"{50 * x} {25 * y} {n[x, y] if (x, y) != (0, 3) else 'NaN'}\n" for x, y in points))

# One point missing, at (2, 1).
cells = [["" if (x, y) == (2, 1) else f"{n[x, y]}" for x in range(5)] for y in range(4)]
with_comma = [[cell and cell + ",0" for cell in line] for line in cells]
open("surfaces/comma.csv", "w").write("# unit: um\n# pitch: 50,0 um; 25,0 um\n" + "".join(";".join(line) + "\n" for line in with_comma))
open("surfaces/comma.txt", "w").write("# unit: um\n" + "".join(" ".join(cell or "***" for cell in line) + "\n" for line in with_comma))
open("surfaces/utf16.csv", "w", encoding="utf-16").write("unit: µm\npitch: 50 µm\n" + "".join("\t".join(line) + "\n" for line in cells))
# Profiles of the heights 0 to 19, a sixth of a micrometre apart, in coordinates with one digit.
open("surfaces/rounded.csv", "w").write("Lateral um,Raw Micrometer,\n" + "".join(f"{n / 6:.1f},{n}.00000,,\n" for n in range(20)))
open("surfaces/profile.hfm", "w").write("X;Y;valid\n[mm];[um];[1/0]\n" + "".join(f"{8 + n / 1000};{n};1\n" for n in range(20)))

grey8, grey16 = (10 * picture).astype("u1"), (3000 * picture).astype("u2")
Image.fromarray(grey8).save("surfaces/grey8.png")
Image.fromarray(grey16).save("surfaces/grey16.png")
Image.fromarray((picture % 2 * 255).astype("u1")).convert("1").save("surfaces/grey1.png")
tifffile.imwrite("surfaces/grey8.tif", grey8)
tifffile.imwrite("surfaces/grey16be.tif", grey16, byteorder=">")
tifffile.imwrite("surfaces/white_is_zero.tif", 255 - grey8, photometric="miniswhite")
tifffile.imwrite("surfaces/grey16big.tif", grey16, bigtiff=True)
Image.fromarray(grey16).save("surfaces/grey16lzw.tif", compression="tiff_lzw")
Image.fromarray(grey8).save("surfaces/grey8deflate.tif", compression="tiff_adobe_deflate")
decimal = picture.astype("f4")
decimal[2, 2] = np.nan
tifffile.imwrite("surfaces/decimal.tif", decimal)
