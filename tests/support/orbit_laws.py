"""Torques of orbits, magnets, air and light in plain NumPy, from the tables of a scene file. t has any shape."""

import numpy as np


def place(orbit, t):
    """Position and velocity by the anomaly of an ellipse or a hyperbola, which starts at the periapsis at t0."""
    mu, e = orbit["mu"], orbit.get("e", 0.0)
    assert orbit.get("anomaly", 0.0) == 0.0
    a = orbit["a"] if "a" in orbit else orbit["periapsis_distance"] / abs(1 - e)
    n = np.sqrt(mu / a**3)
    mean = n * (np.asarray(t, float) - orbit.get("t0", 0.0))
    if e < 1:
        E = mean + e * np.sin(mean)
        for _ in range(8):
            E = E - (E - e * np.sin(E) - mean) / (1 - e * np.cos(E))
        b, c, s, slope = np.sqrt(1 - e * e), np.cos(E), np.sin(E), n / (1 - e * np.cos(E))
        flat, fast = (a * (c - e), a * b * s), (-a * s * slope, a * b * c * slope)
    else:
        F = np.arcsinh(mean / e)
        for _ in range(12):
            F = F - (e * np.sinh(F) - F - mean) / (e * np.cosh(F) - 1)
        b, c, s, slope = np.sqrt(e * e - 1), np.cosh(F), np.sinh(F), n / (e * np.cosh(F) - 1)
        flat, fast = (a * (e - c), a * b * s), (-a * s * slope, a * b * c * slope)
    angles = [orbit.get(name, 0.0) for name in ("node", "inclination", "periapsis")]
    (cn, ci, cw), (sn, si, sw) = np.cos(angles), np.sin(angles)
    p = np.array([cn * cw - sn * ci * sw, sn * cw + cn * ci * sw, si * sw])
    q = np.array([-cn * sw - sn * ci * cw, -sn * sw + cn * ci * cw, si * cw])
    return [np.multiply.outer(x, p) + np.multiply.outer(y, q) for x, y in (flat, fast)]


def torque(given, orbit, t, R, moments):
    """tau_B of one table [[torques]] where R is R_WB, shape (..., 3, 3)."""
    r, v = place(orbit, t)
    size = np.linalg.norm(r, axis=-1)[..., None]

    def seen(x):
        return np.einsum("...ji,...j->...i", R, np.broadcast_to(x, np.shape(R)[:-1]))

    if given["kind"] == "gravity_gradient":
        u = seen(r / size)
        return 3 * orbit["mu"] / size**3 * np.cross(u, moments * u)
    if given["kind"] == "dipole":
        field = given["field"]
        angle = field["spin"] * np.asarray(t) + field["phase"]
        tilt = field["tilt"]
        m = [np.sin(tilt) * np.cos(angle), np.sin(tilt) * np.sin(angle), np.full_like(angle, np.cos(tilt))]
        m = np.stack(m, -1)
        along = np.sum(m * r, axis=-1)[..., None] / size
        return np.cross(given["moment"], seen(field["strength"] / size**3 * (3 * along * r / size - m)))
    total = np.zeros(np.shape(r))
    if given["kind"] == "drag":
        b = seen(v - np.cross([0, 0, given["spin"]], r))
        rho = given["density"] * np.exp((given["height_radius"] - size) / given["scale_height"])
        for plate in given["plates"]:
            met = np.maximum(b @ np.array(plate["normal"]), 0)[..., None]
            total = total + np.cross(plate["centre"], -given["coefficient"] / 2 * plate["area"] * rho * met * b)
        return total
    sun = np.array(given["sun"]) / np.linalg.norm(given["sun"])
    ahead = r @ sun
    dark = (ahead < 0) & (np.sum(r * r, axis=-1) - ahead**2 < given["shadow"] ** 2)
    s = seen(sun)
    for plate in given["plates"]:
        n, specular = np.array(plate["normal"]), plate["specular"]
        c = np.maximum(s @ n, 0)[..., None]
        force = -given["pressure"] * plate["area"] * c * (
            (1 - specular) * s + 2 * (specular * c + plate["diffuse"] / 3) * n)
        total = total + np.cross(plate["centre"], force)
    return np.where(dark[..., None], 0.0, total)
