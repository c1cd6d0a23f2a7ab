"""
Herpolhode
==========

The ellipsoid of inertia rolls on a plane without slipping. The track of the
point of contact is the herpolhode. It stays in a ring, and never closes in
general.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

free = ph.FreeMotion((0.20, 0.40, 0.52), omega=(2.0, 1.0, 2.0))
track = free.herpolhode(np.linspace(0, 12 * free.period, 6000))

figure, ax = plt.subplots(figsize=(4.5, 4.5))
ax.plot(track[:, 0], track[:, 1], lw=0.8)
ax.set_aspect("equal")
ax.set(xlabel="rad/s", ylabel="rad/s")
plt.show()
