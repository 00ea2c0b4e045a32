"""Makes the text exports of instruments in this folder: 5 columns (x) by 4 rows (y) of n = 4 x + y, the point (2, 1) missing.

    python make.py            (numpy)

Forms as the public readers have them: Kcsv2Bcr (Keyence), SurfaceTopography (Wyko, SPIP, Dektak, holographic microscopes), the MetroPro
Reference Guide OMP-0347 and prysm (Zygo).
"""

import numpy as np

n = np.arange(20).reshape(5, 4)
lines = n.T
cells = [["" if (x, y) == (2, 1) else f"{n[x, y]}" for x in range(5)] for y in range(4)]
with_comma = [[cell and cell + ",0" for cell in line] for line in cells]

open("holographic.txt", "w").write(
    "h=4 w=5\r\npixel size=5e-005 m\r\ndata unit=rad\r\nheight conversion factor (-> m)=1e-006\r\n"
    + "".join(" ".join(f"{v:.6f}" for v in row) + "\r\n" for row in lines)
)
open("keyence.csv", "w", encoding="latin-1", newline="").write(
    '"Gemessenes Datum","2026-01-02 10:00:00"\r\n"Modell","VK-X3000 Series"\r\n"Dateityp","ImageDataCsv"\r\n'
    '"XY-Justierung","50,0","µm"\r\n"Bilddatenausg.","Höhe"\r\n"Horizont.","5"\r\n"Vertikal","4"\r\n"Einheit","µm"\r\n\r\n"Höhe"\r\n'
    + "".join(",".join(f'"{cell}"' for cell in line) + "\r\n" for line in with_comma)
)
open("wyko.asc", "w", newline="").write(
    "Wyko ASCII Data File Format 0\t0\t1\r\nX Size\t5\r\nY Size\t4\r\nBlock Name\tType\tLength\tValue\r\n"
    "Wavelength\t7\t4\t2000\r\nAspect\t7\t4\t0.5\r\nPixel_size\t7\t4\t0.05\r\nMult\t7\t2\t2\r\nRAW_DATA\t3\t80\t\r\n"
    + "".join("\t".join(cells[y][x] or "Bad" for y in range(4)) + "\r\n" for x in range(5))
)
zygo = (
    '0 0 0 0 "Mon Jan 05 10:00:00 2026"\n0 0 0 0 0 0\n7 3 5 4\n""\n""\n""\n0 0.5 2e-06 0 1 0 5e-05 1767607200\n'
    '5 4 0 0 0 0 ""\n0 0 0 0 0 0 0 0 0 0\n1 1 20 2 0 0 0 0 0\n0 ""\n1 0\n""\n#\n'
)
open("zygo.xyz", "w").write(
    "Zygo XYZ Data File - Format 1\n" + zygo + "".join(f"{7 + x} {3 + y} {cells[y][x] or 'No Data'}\n" for y in range(4) for x in range(5)) + "#\n"
)
phases = [32768 * int(cell) if cell else 2147483640 for line in cells for cell in line]
open("zygo.asc", "w").write(
    "Zygo ASCII Data File - Format 2\n"
    + zygo
    + "#\n"
    + "".join(" ".join(str(phase) for phase in phases[at : at + 10]) + " \n" for at in (0, 10))
    + "#\n"
)
open("spip.asc", "w").write(
    "# File Format = ASCII\n# Created by SPIP 6.3\n# x-pixels = 5\n# y-pixels = 4\n# x-length = 250000\n# y-length = 100000\n"
    "# z-unit = um\n# Start of Data:\n" + "".join("\t".join(cell or "NaN" for cell in line) + "\n" for line in cells)
)
# A profile of the heights 0 to 19, a sixth of a micrometre apart, in coordinates with one digit.
open("dektak.csv", "w", newline="", encoding="latin-1").write(
    "Scan Parameters\r\r\nScan Type,Standard Scan\r\nStylus,Radius: 2.5 µm\r\n\r\r\nScan Data\r\r\nLateral um,Raw Micrometer,\r\n"
    + "".join(f"{n / 6:.1f},{n}.00000,,\r\n" for n in range(20))
    + "\r\r\n"
)
