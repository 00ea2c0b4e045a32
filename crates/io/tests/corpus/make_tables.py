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
open("surfaces/holographic.txt", "w").write(
    "h=4 w=5\r\npixel size=5e-005 m\r\ndata unit=rad\r\nheight conversion factor (-> m)=1e-006\r\n"
    + "".join(" ".join(f"{v:.6f}" for v in row) + "\r\n" for row in lines)
)
points = [(x, y) for x in range(5) for y in range(4) if (x, y) != (2, 1)]
np.random.default_rng(1).shuffle(points)
open("surfaces/list.csv", "w", encoding="utf-8-sig").write(
    "x [um],y [um],z [um]\n" + "".join(f"{50 * x},{25 * y},{n[x, y]}\n" for x, y in points)
)
open("surfaces/list.xyz", "w").write(
    "# unit: um\n" + "".join(f"{50 * x} {25 * y} {n[x, y] if (x, y) != (0, 3) else 'NaN'}\n" for x, y in points)
)

# What instruments write: one point missing where the form can say so, at (2, 1).
cells = [["" if (x, y) == (2, 1) else f"{n[x, y]}" for x in range(5)] for y in range(4)]
with_comma = [[cell and cell + ",0" for cell in line] for line in cells]
open("surfaces/comma.csv", "w").write(
    "# unit: um\n# pitch: 50,0 um; 25,0 um\n" + "".join(";".join(line) + "\n" for line in with_comma)
)
open("surfaces/comma.txt", "w").write(
    "# unit: um\n" + "".join(" ".join(cell or "***" for cell in line) + "\n" for line in with_comma)
)
open("surfaces/utf16.csv", "w", encoding="utf-16").write(
    "unit: µm\npitch: 50 µm\n" + "".join("\t".join(line) + "\n" for line in cells)
)
open("surfaces/keyence.csv", "w", encoding="latin-1", newline="").write(
    '"Gemessenes Datum","2026-01-02 10:00:00"\r\n"Modell","VK-X3000 Series"\r\n"Dateityp","ImageDataCsv"\r\n'
    '"XY-Justierung","50,0","µm"\r\n"Bilddatenausg.","Höhe"\r\n"Horizont.","5"\r\n"Vertikal","4"\r\n"Einheit","µm"\r\n\r\n"Höhe"\r\n'
    + "".join(",".join(f'"{cell}"' for cell in line) + "\r\n" for line in with_comma)
)
open("surfaces/wyko.asc", "w", newline="").write(
    "Wyko ASCII Data File Format 0\t0\t1\r\nX Size\t5\r\nY Size\t4\r\nBlock Name\tType\tLength\tValue\r\n"
    "Wavelength\t7\t4\t2000\r\nAspect\t7\t4\t0.5\r\nPixel_size\t7\t4\t0.05\r\nMult\t7\t2\t2\r\nRAW_DATA\t3\t80\t\r\n"
    + "".join("\t".join(cells[y][x] or "Bad" for y in range(4)) + "\r\n" for x in range(5))
)
zygo = (
    '0 0 0 0 "Mon Jan 05 10:00:00 2026"\n0 0 0 0 0 0\n7 3 5 4\n""\n""\n""\n0 0.5 2e-06 0 1 0 5e-05 1767607200\n'
    '5 4 0 0 0 0 ""\n0 0 0 0 0 0 0 0 0 0\n1 1 20 2 0 0 0 0 0\n0 ""\n1 0\n""\n#\n'
)
open("surfaces/zygo.xyz", "w").write(
    "Zygo XYZ Data File - Format 1\n" + zygo
    + "".join(f"{7 + x} {3 + y} {cells[y][x] or 'No Data'}\n" for y in range(4) for x in range(5)) + "#\n"
)
phases = [32768 * int(cell) if cell else 2147483640 for line in cells for cell in line]
open("surfaces/zygo.asc", "w").write(
    "Zygo ASCII Data File - Format 2\n" + zygo + "#\n"
    + "".join(" ".join(str(phase) for phase in phases[at : at + 10]) + " \n" for at in (0, 10)) + "#\n"
)
open("surfaces/spip.asc", "w").write(
    "# File Format = ASCII\n# Created by SPIP 6.3\n# x-pixels = 5\n# y-pixels = 4\n# x-length = 250000\n# y-length = 100000\n"
    "# z-unit = um\n# Start of Data:\n" + "".join("\t".join(cell or "NaN" for cell in line) + "\n" for line in cells)
)
# Profiles of the heights 0 to 19, a sixth of a micrometre apart, in coordinates with one digit.
open("surfaces/dektak.csv", "w", newline="", encoding="latin-1").write(
    "Scan Parameters\r\r\nScan Type,Standard Scan\r\nStylus,Radius: 2.5 µm\r\n\r\r\nScan Data\r\r\nLateral um,Raw Micrometer,\r\n"
    + "".join(f"{n / 6:.1f},{n}.00000,,\r\n" for n in range(20)) + "\r\r\n"
)
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
