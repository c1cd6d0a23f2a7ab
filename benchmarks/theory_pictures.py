"""Draws the pictures of the theory: docs/pictures/theory_*.svg, each from the functions that the chapter names.

    python benchmarks/theory_pictures.py      # all of them, or those named: polhodes cone jacobi zero cubic saddle
"""

import pathlib
import sys

import numpy as np

import polhode as ph
from polhode._plot import style

FOLDER = pathlib.Path(__file__).parents[1] / "docs/pictures"
BODY = np.array([1.0, 2.0, 2.5])
BLUE, ORANGE, GREEN, GREY = "#0072b2", "#d55e00", "#258a5c", "#8a8f98"


def polhodes(plt):
    """Three motions of one energy about the three axes, on the ellipsoid of the energy."""
    figure, axes = plt.subplots(1, 3, figsize=(9.0, 3.4))
    for ax, axis, name in zip(axes, np.eye(3), ("least", "middle", "greatest")):
        omega = axis + 0.12 * (1 - axis)
        omega *= np.sqrt(2.0 / (BODY @ omega**2))
        free = ph.FreeMotion(BODY, omega)
        free.plot("polhode", ax=ax)
        ax.set_title(f"thrown about the {name} axis", fontsize=9.5, pad=16)
    figure.subplots_adjust(left=0.01, right=0.99, top=0.84, bottom=0.02, wspace=0.02)
    return figure


def cone(plt):
    """The axis and omega of a symmetric body circle about L, in one plane with it."""
    moments, omega = np.array([1.0, 1.0, 0.5]), np.array([0.8, 0.0, 3.0])
    L = omega * moments
    free = ph.FreeMotion(moments, omega)
    turn = 2 * np.pi / (np.linalg.norm(L) / moments[0])   # one precession [s]
    t = np.linspace(0, turn, 200)
    rates, attitude = free.at(t)
    rotation = ph.Rotation.from_quat(attitude)
    z = L / np.linalg.norm(L)
    x = np.cross((0.0, 1.0, 0.0), z)
    x /= np.linalg.norm(x)
    frame = np.array([x, np.cross(z, x), z])
    axis = rotation.apply((0.0, 0.0, 1.0)) @ frame.T
    spin = rotation.apply(rates) @ frame.T / np.linalg.norm(omega)
    figure = plt.figure(figsize=(4.8, 4.4))
    ax = figure.add_subplot(projection="3d", proj_type="ortho")
    for path, colour in ((axis, BLUE), (spin, ORANGE)):
        ax.plot(*path.T, color=colour, linewidth=1.8)
        for k in range(0, 200, 12):
            ax.plot(*zip((0, 0, 0), path[k]), color=colour, linewidth=0.5, alpha=0.35)
        ax.plot(*zip((0, 0, 0), path[30]), color=colour, linewidth=2.0)
    ax.plot((0, 0), (0, 0), (0, 1.15), color="black", linewidth=2.2)
    ax.text(0.02, 0, 1.18, "L, fixed", color="black")
    ax.text(*(1.04 * axis[30]), "body axis ", color=BLUE, ha="right")
    ax.text(*(0.6 * spin[30]), "  ω", color=ORANGE)
    ax.set(xlim=(-0.45, 0.45), ylim=(-0.45, 0.45), zlim=(0, 1.15), box_aspect=(1, 1, 1.25))
    ax.view_init(18, -60)
    ax.set_axis_off()
    return figure


def jacobi(plt):
    """sn, cn, dn for three parameters; sn becomes tanh, cn and dn one hump."""
    figure, axes = plt.subplots(1, 3, figsize=(9.0, 2.8), sharey=True)
    for ax, m in zip(axes, (0.2, 0.9, 1 - 1e-6)):
        K = ph.elliptic.K(m, 1e-6 if m > 0.99 else 1 - m)
        u = np.linspace(0, 4 * K, 800)
        for values, name, colour in zip(ph.elliptic.jacobi(u, m, 1e-6 if m > 0.99 else 1 - m), ("sn", "cn", "dn"),
                                        (BLUE, ORANGE, GREEN)):
            ax.plot(u / K, values, color=colour, label=name, linewidth=1.8)
        ax.set(title=f"k² = {'1 - 1e-6' if m > 0.99 else m}, K = {K:.3g}", xlabel="u / K", xticks=range(5))
    axes[0].legend(frameon=False, loc="lower left")
    figure.subplots_adjust(left=0.05, right=0.99, top=0.88, bottom=0.19, wspace=0.08)
    return figure


def series():
    """Of the body of the chapter: K, K', and the function A of complex u, without its exponential."""
    omega = np.array([0.4, 0.0, 1.0])
    L2, T2 = ((omega * BODY) ** 2).sum(), (omega**2 * BODY).sum()
    I1, I2, I3 = BODY
    m = (I2 - I1) * (T2 * I3 - L2) / ((I3 - I2) * (L2 - T2 * I1))
    m1 = (I3 - I1) * (L2 - T2 * I2) / ((I3 - I2) * (L2 - T2 * I1))
    K, other = ph.elliptic.K(m, m1), ph.elliptic.K(m1, m)
    q, a3, delta = ph.elliptic.nome(m, m1), omega[2] * I3 / np.sqrt(L2), 0.0
    for _ in range(50):   # sn(delta, k') = a3, by Newton
        sn, cn, dn = ph.elliptic.jacobi(delta, m1, m)
        delta -= (sn - a3) / (cn * dn)
    rho, j = np.exp(-np.pi * delta / (2 * K)), np.arange(-12, 13)
    G = q ** (j * (j - 1) / 2) * rho**j
    even = j % 2 == 0

    def A(u):
        phi = np.pi * u / (2 * K) - np.pi / 2
        return (G[even] * np.exp(1j * np.multiply.outer(phi, j[even]))).sum(axis=-1)

    return K, other, delta, A


def zero(plt):
    """The size of A in one cell: it vanishes at one of the two points with m_3 = -L."""
    K, other, delta, A = series()
    x, y = np.linspace(-K, K, 161), np.linspace(0, 4 * other, 241)
    size = np.log10(np.abs(A(x[None, :] + 1j * y[:, None])))
    figure, ax = plt.subplots(figsize=(5.6, 4.2))
    shown = ax.contourf(x / K, y / other, np.clip(size, -1.5, None), 24, cmap="cividis")
    ax.plot(0, 3 - delta / other, "o", color="white", markeredgecolor="black", markersize=9)
    ax.annotate("m₃ = -L, and α = 0", (0, 3 - delta / other), (0.18, 3 - delta / other), color="white", va="center")
    ax.plot(0, 1 + delta / other, "x", color="white", markersize=9, markeredgewidth=2)
    ax.annotate("m₃ = -L, and α is finite", (0, 1 + delta / other), (0.12, 1 + delta / other), color="white",
                va="center")
    for at in (1, 3):
        ax.plot(0, at, "s", color="black", markersize=5)
        ax.annotate("pole of dn", (0, at), (-0.12, at), color="black", ha="right", va="center",
                    bbox={"boxstyle": "square,pad=0.1", "facecolor": "white", "edgecolor": "none", "alpha": 0.7})
    ax.set(xlabel="Re u / K", ylabel="Im u / K'", title="log₁₀ |A| in the cell (2K, 4iK')")
    ax.grid(False)
    figure.colorbar(shown, ax=ax, shrink=0.9)
    figure.subplots_adjust(left=0.11, right=0.98, top=0.92, bottom=0.12)
    return figure


def cubic(plt):
    """f(u) of a top and its three roots, beside the tilt in time."""
    tilt = ph.Rotation.from_euler("ZXZ", (0, 0.9, 0))
    top = ph.HeavyTop((1.0, 1.0, 0.5), weight_arm=2.0, omega=(0.9, -0.3, 6.0), attitude=tilt)
    a, b, mu = top.p_psi, top.p_phi, 4.0
    eps = 2 * top.energy - 0.5 * 36.0
    roots = np.sort(np.roots([mu, -eps - a * a, 2 * a * b - mu, eps - b * b]).real)
    figure, (left, right) = plt.subplots(1, 2, figsize=(8.6, 3.2))
    u = np.linspace(-1.05, 1.1, 500)
    f = (eps - mu * u) * (1 - u * u) - (b - a * u) ** 2
    left.plot(u, f, color=BLUE)
    between = (u >= roots[0]) & (u <= roots[1])
    left.fill_between(u[between], 0, f[between], color=BLUE, alpha=0.25)
    left.axhline(0, color=GREY, linewidth=0.8)
    for edge in (-1, 1):
        left.axvline(edge, color=GREY, linewidth=0.8, linestyle=":")
    for root, name in zip(roots[:2], ("u₁", "u₂")):
        left.plot(root, 0, "o", color=ORANGE)
        left.annotate(name, (root, 0), xytext=(0, 7), textcoords="offset points", ha="center", color=ORANGE)
    left.annotate(f"u₃ = {roots[2]:.2f} is further right", (1.08, -11), ha="right", fontsize=8.5, color=GREY)
    left.set(ylim=(-12, 4), xlabel="u = cos θ", title="f(u): motion where f ≥ 0")
    t = np.linspace(0, 4 * top.nutation_period, 600)
    up = ph.Rotation.from_quat(top.at(t)[1]).as_matrix()[:, 2, 2]
    right.plot(t, up, color=BLUE)
    for root in roots[:2]:
        right.axhline(root, color=ORANGE, linewidth=1.0, linestyle="--")
    right.set(xlabel="time [s]", title="cos θ of the top, between the roots")
    figure.subplots_adjust(left=0.06, right=0.98, top=0.9, bottom=0.16, wspace=0.15)
    return figure


def saddle(plt):
    """The plane of omega_1 and omega_3 next to the middle axis: u decays or grows alone, and so does v."""
    I1, I2, I3 = BODY
    scale = np.sqrt(I1 * (I2 - I1) / (I3 * (I3 - I2)))
    figure, ax = plt.subplots(figsize=(5.2, 4.4))
    starts = [(side * size, 0.0, BLUE) for side in (-1, 1) for size in (0.06, 0.2)]
    starts += [(0.0, side * size, ORANGE) for side in (-1, 1) for size in (0.06, 0.2)]
    for a, c, colour in starts:
        free = ph.FreeMotion(BODY, (a, 1.0, c))
        rates, _ = free.at(np.linspace(-6, 6, 800))
        ax.plot(rates[:, 0], rates[:, 2], color=colour, linewidth=1.8)
    reach = 0.5
    w = np.array([-reach, reach])
    ax.plot(w, scale * w, color=GREY, linewidth=1.2, linestyle="--")
    ax.plot(w, -scale * w, color=GREY, linewidth=1.2, linestyle="--")
    ax.text(0.25, 0.25 * scale + 0.06, "u = 0", color=GREY, ha="right")
    ax.text(0.25, -0.25 * scale - 0.06, "v = 0", color=GREY, ha="right", va="top")
    ax.set(xlim=(-reach, reach), ylim=(-reach, reach), xlabel="ω₁ [rad/s]", ylabel="ω₃ [rad/s]",
           title="next to a spin about axis 2 at 1 rad/s")
    figure.subplots_adjust(left=0.14, right=0.97, top=0.91, bottom=0.12)
    return figure


DRAW = {f.__name__: f for f in (polhodes, cone, jacobi, zero, cubic, saddle)}


def main(names):
    with style.used() as plt:
        for name in names or DRAW:
            figure = DRAW[name](plt)
            figure.savefig(FOLDER / f"theory_{name}.svg", metadata={"Date": None})
            plt.close(figure)


if __name__ == "__main__":
    main(sys.argv[1:])
