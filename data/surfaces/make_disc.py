#!/usr/bin/env python3
"""Makes rough_disc.sdf: 4 by 4 mm of a rough disc as an instrument gives them, in SDF. Needs NumPy.

python3 data/surfaces/make_disc.py data/surfaces/rough_disc.sdf
"""

import struct
import sys

import numpy as np

POINTS, PITCH = 200, 20e-6  # of each direction; m
RMS, LENGTH, NOISE = 3e-6, 120e-6, 50e-9  # rms height and correlation length as in cermet.toml; of the instrument; m
TILT = 2e-3, -1e-3  # along x and y
RESOLUTION = 1e-9  # what the number 1 stands for, m

random = np.random.default_rng(2019)
# A random field with the autocorrelation exp(-(r/LENGTH)^2), on a square that is twice as wide: a patch does not close.
wide = 2 * POINTS
q = 2 * np.pi * np.fft.fftfreq(wide, PITCH)
amplitude = np.exp(-(q[:, None] ** 2 + q**2) * LENGTH**2 / 8)
field = np.fft.ifft2(np.fft.fft2(random.standard_normal((wide, wide))) * amplitude).real[:POINTS, :POINTS]
field *= RMS / field.std()
x = np.arange(POINTS) * PITCH
heights = field - field.mean() + NOISE * random.standard_normal(field.shape) + TILT[0] * x + TILT[1] * x[:, None]

counts = np.rint(heights / RESOLUTION).astype("<i2")
assert abs(counts - heights / RESOLUTION).max() < 1
head = struct.pack(
    "<8s10s12s12sHHddddBBB", b"bISO-1.0", b"make_disc", b"251120260000", b"251120260000", POINTS, POINTS, PITCH, PITCH, RESOLUTION, -1.0, 0, 5, 0
)
with open(sys.argv[1], "wb") as file:
    file.write(head + counts.tobytes())
