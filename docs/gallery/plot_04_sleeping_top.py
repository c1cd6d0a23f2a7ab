"""
The sleeping top
================

An upright top gets a tiny kick. Above a critical spin it stays up. Below, it
falls to a tilt that depends on the spin. Each point is one closed form.
"""

import matplotlib.pyplot as plt
import numpy as np

import polhode as ph

A, C, M = 1.0, 0.5, 2.0
critical = 2 * np.sqrt(A * M) / C
spins = np.linspace(0.0, 1.4, 281) * critical
lowest = [
    ph.HeavyTop((A, A, C), weight_arm=M, omega=(1e-6, 0, spin)).tilt_bounds[1]
    for spin in spins
]

figure, ax = plt.subplots()
ax.plot(spins / critical, np.degrees(lowest))
ax.set(
    xlabel="spin / critical spin",
    ylabel="largest tilt [degrees]",
    yticks=range(0, 181, 45),
)
plt.show()
