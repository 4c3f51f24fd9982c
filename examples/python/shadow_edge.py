"""How three materials blur a shadow edge: dermis beside the profile's own curve, plotted with matplotlib.

    python examples/python/shadow_edge.py shadow_edge.png
"""

# %% A wall that is lit up to a straight edge in its middle; 4 pixels to the millimetre.
import sys

import dermis
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

width, height, px_per_mm = 320, 64, 4
light = np.zeros((height, width, 3), np.float32)
light[:, :width // 2] = 1
depth = np.full((height, width), 100, np.float32)
camera = dermis.Camera.orthographic(px_per_mm, px_per_mm)
x_mm = (np.arange(width) + 0.5 - width / 2) / px_per_mm

# %% Scattered by each material, and what the profile says an edge looks like.
figure, axes = plt.subplots(1, 3, figsize=(12, 3.5), sharey=True)
for axis, name in zip(axes, ("skin", "marble", "wax")):
    plan = dermis.Plan(name, images=["depth"], pixel_mm={0: 1 / px_per_mm}, quality="final")
    row = plan.run(camera, light=light, depth=depth).scattered[height // 2]
    expected = 1 - dermis.Profile(name).edge(x_mm)
    for channel, colour in enumerate(("tab:red", "tab:green", "tab:blue")):
        axis.plot(x_mm, expected[:, channel], color=colour, lw=4, alpha=0.3)
        axis.plot(x_mm, row[:, channel], color=colour, lw=1)
    axis.set(title=name, xlabel="mm from the edge", xlim=(-15, 15))
    print(f"{name}: off by {np.abs(row - expected)[width // 4:-width // 4].max():.4f} at most")
axes[0].set_ylabel("light")

# %% The picture.
figure.tight_layout()
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "shadow_edge.png", dpi=100)
