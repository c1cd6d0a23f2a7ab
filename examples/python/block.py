"""The homework's block, M = 12 and 2a x 2b x 2c: moments at the centre, at a face, about diagonals (docs/seed.md)."""

import numpy as np

import polhode as ph

M, a, b, c = 12.0, 0.3, 0.2, 0.1
block = ph.shapes.box(M, (a, b, c))

print("about the centre [kg m^2]:")
print(np.array_str(block.inertia.matrix, precision=4, suppress_small=True))
print("about the centre of the face z = c:")
print(np.array_str(block.about((0, 0, c)).matrix, precision=4, suppress_small=True))
print(f"about the diagonal of the block:        {block.inertia.about_axis((a, b, c)):.6f}")
print(f"about the diagonal of the face z = c:   {block.about((0, 0, c)).about_axis((a, b, 0)):.6f}")

half = ph.shapes.box(M / 2, (a, b, c / 2))
two = half.moved((0, 0, 0, 1), (0, 0, c / 2)) + half.moved((0, 0, 0, 1), (0, 0, -c / 2))
print(f"two halves make the whole again, within {abs(two.inertia.matrix - block.inertia.matrix).max():.0e}")

try:
    ph.InertiaTensor.from_moments((0.2, 0.4, 0.7))
except ph.InvalidInput as refusal:
    print("refused:", refusal)
