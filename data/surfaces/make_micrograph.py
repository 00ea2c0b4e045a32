"""Makes micrograph.png: what a light microscope may show of a low-metallic pin. Not a photograph.

    python make_micrograph.py            (numpy, pillow)

Prints the area fraction that is fibre by construction.
"""

import numpy as np
from PIL import Image

WIDTH, HEIGHT, PIXEL = 352, 192, 25e-6  # 8.8 mm by 4.8 mm
FIBRE, RESIN, FILLER = 190.0, 75.0, 105.0
random = np.random.default_rng(6)
x, y = np.meshgrid(np.arange(WIDTH) + 0.5, np.arange(HEIGHT) + 0.5)


def capsule(length, width):
    """Points within a straight fibre with round ends, at a random place and angle; lengths in pixels."""
    angle = np.pi * random.random()
    dx, dy = x - WIDTH * random.random(), y - HEIGHT * random.random()
    along = np.maximum(np.abs(dx * np.cos(angle) + dy * np.sin(angle)) - (length - width) / 2, 0)
    across = dy * np.cos(angle) - dx * np.sin(angle)
    return np.hypot(along, across) <= width / 2


filler = np.any([capsule(6 + 10 * random.random(), 5) for _ in range(150)], axis=0)
fibre = np.zeros((HEIGHT, WIDTH), bool)
while fibre.mean() < 0.25:
    fibre |= capsule((500e-6 + 500e-6 * random.random()) / PIXEL, 150e-6 / PIXEL)

grey = np.where(fibre, FIBRE, np.where(filler, FILLER, RESIN))
grey += 15.0 * (x / WIDTH - 0.5)  # uneven light
grey += 14.0 * random.standard_normal(grey.shape)  # noise of the camera
dust = random.random(grey.shape) < 4e-4
grey[dust] = 235.0
grey[~dust & (random.random(grey.shape) < 4e-4)] = 25.0
Image.fromarray((np.clip(grey / 8, 0, 31).round() * 8).astype("u1")).save("micrograph.png", optimize=True)
print(f"fibre fraction {fibre.mean():.4f}")
