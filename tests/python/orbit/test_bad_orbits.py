"""Bad numbers of orbits, fields and plates: one sentence each, with the argument and the value."""

import re

import numpy as np
import pytest

import polhode as ph

NAN = float("nan")
ORBIT = ph.Orbit(1.0, (1, 0, 0), (0, 1, 0))
PLATE = ph.Plate(1.0, (0, 0, 1), (0, 0, 0.1))
AIR = dict(coefficient=2.2, density=3e-11, height_radius=6.7e6, scale_height=6e4)
T, MAKE = ph.torques, ph.Orbit.from_elements


def table(t=(0.0, 1.0), r=((1, 0, 0), (0, 1, 0)), v=((0, 1, 0), (-1, 0, 0)), **more):
    return ph.Orbit.table(t, r, v, **more)


def gauss(g=((0,), (1e-5, 0)), h=((0,), (0, 1e-5)), radius=1.0, **more):
    return ph.MagneticField.gauss(ORBIT, radius, g, h, **more)


def drag(**change):
    return T.Drag(PLATE, ORBIT, **{**AIR, **change})


CASES = {
    "mu 0": (lambda: ph.Orbit(0.0, (1, 0, 0), (0, 1, 0)), "mu: must be positive and finite, got 0"),
    "mu below 0": (lambda: MAKE(-2.5, a=1.0), "mu: must be positive and finite, got -2.5"),
    "mu NaN": (lambda: ph.Orbit(NAN, (1, 0, 0), (0, 1, 0)), "mu: must be positive and finite, got nan"),
    "r0 0": (lambda: ph.Orbit(1.0, (0, 0, 0), (0, 1, 0)), "r0: must be not the centre, got 0, 0, 0"),
    "r0 NaN": (lambda: ph.Orbit(1.0, (1, NAN, 0), (0, 1, 0)), "r0: must be finite, got nan"),
    "v0 infinite": (lambda: ph.Orbit(1.0, (1, 0, 0), (0, np.inf, 0)), "v0: must be finite, got inf"),
    "t0 NaN": (lambda: ph.Orbit(1.0, (1, 0, 0), (0, 1, 0), NAN), "t0: must be finite, got nan"),
    "e below 0": (lambda: MAKE(1.0, a=1.0, e=-0.25), "e: must be at least 0 and finite, got -0.25"),
    "e NaN": (lambda: MAKE(1.0, a=1.0, e=NAN), "e: must be finite, got nan"),
    "a of a parabola": (lambda: MAKE(1.0, a=2.5, e=1.0), "a: must be left out with e >= 1, got 2.5"),
    "a below 0": (lambda: MAKE(1.0, a=-2.5), "a: must be positive and finite, got -2.5"),
    "q 0": (lambda: MAKE(1.0, periapsis_distance=0.0), "periapsis_distance: must be positive and finite, got 0"),
    "a and q": (lambda: MAKE(1.0, a=1.0, periapsis_distance=1.0),
                "periapsis_distance, a: must be one of them, got both"),
    "neither": (lambda: MAKE(1.0), "periapsis_distance, a: must be one of them, got neither"),
    "anomaly": (lambda: MAKE(1.0, periapsis_distance=1.0, e=2.0, anomaly=2.5),
                "anomaly: must be between the asymptotes of the hyperbola, got 2.5"),
    "inclination NaN": (lambda: MAKE(1.0, a=1.0, inclination=NAN), "inclination: must be finite, got nan"),
    "j2 alone": (lambda: MAKE(1.0, a=1.0, j2=1e-3), "radius: must be positive and finite, got 0"),
    "j2 of a hyperbola": (lambda: MAKE(1.0, periapsis_distance=1.0, e=1.5, j2=0.125, radius=1.0),
                          "j2: must be left out with e >= 1, got 0.125"),
    "table of one": (lambda: table((0.0,), np.eye(3)[:1], np.eye(3)[:1]), "t: must be at least two times, got 1"),
    "table unsorted": (lambda: table((1.0, 0.5)), "t: must be increasing, got 0.5 after 1"),
    "table twice": (lambda: table((1.0, 1.0)), "t: must be increasing, got 1 after 1"),
    "table NaN": (lambda: table(r=((1, 0, 0), (NAN, 1, 0))), "table: must be finite, got row 1"),
    "table of other lengths": (lambda: table(v=np.eye(3)), "one row for each of the 2 times, got 2 and 3"),
    "table mu": (lambda: table(mu=-1.5), "mu: must be positive and finite, got -1.5"),
    "before a table": (lambda: table().at(-0.25), "t: must be within the table, 0 to 1 s, got -0.25"),
    "after a table": (lambda: table().at([0.5, 1.25]), "t: must be within the table, 0 to 1 s, got 1.25"),
    "time NaN": (lambda: ORBIT.at(NAN), "t: must be finite, got nan"),
    "area": (lambda: ph.Plate(-0.25, (0, 0, 1), (0, 0, 0)), "Plate.area: must be at least 0 and finite, got -0.25"),
    "area NaN": (lambda: ph.Plate(NAN, (0, 0, 1), (0, 0, 0)), "Plate.area"),
    "normal": (lambda: ph.Plate(1.0, (0, 0, 0), (0, 0, 0)), "Plate.normal: must be not 0, got (0, 0, 0)"),
    "centre NaN": (lambda: T.Drag(ph.Plate(1.0, (0, 0, 1), (0, NAN, 0)), ORBIT, **AIR),
                   "centre: must be finite"),
    "specular": (lambda: ph.Plate(1.0, (0, 0, 1), (0, 0, 0), 0.75, 0.5), "together at most 1, got 0.75 and 0.5"),
    "diffuse": (lambda: ph.Plate(1.0, (0, 0, 1), (0, 0, 0), 0.0, -0.5), "must be at least 0"),
    "scale_height 0": (lambda: drag(scale_height=0.0), "Drag.scale_height: must be positive and finite, got 0"),
    "scale_height": (lambda: drag(scale_height=-6e4), "Drag.scale_height: must be positive and finite, got -60000"),
    "height_radius": (lambda: drag(height_radius=0.0), "Drag.height_radius: must be positive and finite, got 0"),
    "density": (lambda: drag(density=-1.5), "Drag.density: must be at least 0 and finite, got -1.5"),
    "coefficient": (lambda: drag(coefficient=NAN), "Drag.coefficient: must be at least 0 and finite, got nan"),
    "spin": (lambda: drag(spin=np.inf), "Drag.spin: must be finite, got inf"),
    "sun": (lambda: T.SolarPressure(PLATE, (0, 0, 0), 1.0), "SolarPressure.sun: must be finite and not 0, got 0, 0, 0"),
    "sun NaN": (lambda: T.SolarPressure(PLATE, (NAN, 0, 0), 1.0), "SolarPressure.sun: must be finite, got nan"),
    "pressure": (lambda: T.SolarPressure(PLATE, (1, 0, 0), -2.5), "pressure: must be at least 0 and finite, got -2.5"),
    "shadow alone": (lambda: T.SolarPressure(PLATE, (1, 0, 0), 1.0, shadow=0.5),
                     "given together, got shadow 0.5 alone"),
    "strength NaN": (lambda: ph.MagneticField.dipole(ORBIT, NAN), "strength: must be finite, got nan"),
    "tilt NaN": (lambda: ph.MagneticField.dipole(ORBIT, 1.0, tilt=NAN), "tilt: must be finite, got nan"),
    "radius": (lambda: gauss(radius=-1.5), "radius: must be positive and finite, got -1.5"),
    "shapes": (lambda: gauss(h=((0,), (0, 1e-5), (0, 0, 0))), "h"),
    "row": (lambda: gauss(g=((0,), (1e-5,))), "g"),
    "h[1][0]": (lambda: gauss(h=((0,), (0.5, 1e-5))), "h"),
    "g[0][0]": (lambda: gauss(g=((0.5,), (1e-5, 0))), "g"),
    "g NaN": (lambda: gauss(g=((0,), (NAN, 0))), "g"),
    "phase NaN": (lambda: gauss(phase=NAN), "phase: must be finite, got nan"),
}


@pytest.mark.parametrize("name", CASES)
def test_bad_numbers_are_refused_in_one_line(name):
    call, words = CASES[name]
    with pytest.raises(ph.InvalidInput, match=re.escape(words)) as caught:
        call()
    assert "\n" not in str(caught.value)


FILE = """
[body]
matrix = [[1.0, 0, 0], [0, 2.0, 0], [0, 0, 2.5]]
[start]
omega = [0.3, -0.2, 0.5]
[times]
values = [0.0, 1.0]
[orbits.main]
mu = 1.0
a = 2.0
[[torques]]
kind = "drag"
plates = [{area = 1.0, normal = [0, 0, 1], centre = [0.1, 0, 0]}]
orbit = "main"
coefficient = 2.2
density = 1e-3
height_radius = 2.0
scale_height = 0.5
[[torques]]
kind = "solar_pressure"
plates = [{area = 1.0, normal = [0, 0, 1], centre = [0.1, 0, 0], specular = 0.5}]
sun = [1.0, 0, 0]
pressure = 1e-3
orbit = "main"
shadow = 1.0
[[torques]]
kind = "dipole"
moment = [0.1, 0, 0]
field = { kind = "dipole", orbit = "main", strength = 1.0, tilt = 0.2 }
during = [[0.25, 0.5]]
"""


def load(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    return ph.Scene.load(path)


def test_files_have_torques_on_orbits(tmp_path):
    given = load(tmp_path, FILE)
    drag, light, magnet = given.torques
    orbit = MAKE(1.0, a=2.0)
    assert drag == T.Drag(ph.Plate(1.0, (0, 0, 1), (0.1, 0, 0)), orbit, 2.2, 1e-3, 2.0, 0.5)
    shiny = ph.Plate(1.0, (0, 0, 1), (0.1, 0, 0), 0.5)
    assert light == T.SolarPressure(shiny, (1, 0, 0), 1e-3, orbit=orbit, shadow=1.0)
    assert magnet == T.During(T.Dipole((0.1, 0, 0), ph.MagneticField.dipole(orbit, 1.0, 0.2)), [(0.25, 0.5)])
    given.save(tmp_path / "again.toml")
    text = (tmp_path / "again.toml").read_text()
    for words in ('kind = "drag"', 'kind = "solar_pressure"', 'kind = "dipole"', 'orbit = "main"', "[orbits.main]"):
        assert words in text
    assert 'kind = "formula"' not in text and text.count("[orbits.") == 1
    again = ph.Scene.load(tmp_path / "again.toml")
    assert again == given
    for accuracy in (1e-6, 1e-9):
        a, b = ph.solve(given, accuracy=accuracy), ph.solve(again, accuracy=accuracy)
        np.testing.assert_array_equal(a.omega, b.omega)
        np.testing.assert_array_equal(a.attitude, b.attitude)


def test_a_field_of_coefficients_keeps_its_bits(tmp_path):
    rng = np.random.default_rng(4)
    g = [[0.0], *(rng.normal(size=n + 1) for n in (1, 2, 3))]
    h = [[0.0], *(np.append(0.0, rng.normal(size=n)) for n in (1, 2, 3))]
    field = ph.MagneticField.gauss(ph.Orbit(1.0, (1, 0.2, 0), (0, 1.1, 0.3)), 0.9, g, h, spin=0.1, phase=0.3)
    given = ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 1), torques=[T.Dipole((0.1, 0.2, 1 / 3), field)], times=[1.0])
    given.save(tmp_path / "scene.toml")
    again = ph.Scene.load(tmp_path / "scene.toml")
    assert again == given and again.torques[0]._given["field"] == field
    np.testing.assert_array_equal(ph.solve(again, accuracy=1e-9).omega, ph.solve(given, accuracy=1e-9).omega)


def test_other_numbers_of_a_parameter_are_in_the_file(tmp_path):
    drag = T.Drag(PLATE, ORBIT, **AIR).with_parameters(density=5e-11)
    assert drag == T.Drag(PLATE, ORBIT, **{**AIR, "density": 5e-11})
    ph.Scene(inertia=(1, 2, 2.5), omega=(0, 0, 1), torques=[drag], times=[1.0]).save(tmp_path / "scene.toml")
    assert "density = 5e-11" in (tmp_path / "scene.toml").read_text()


@pytest.mark.parametrize(("change", "words"), [
    (('orbit = "main"\ncoefficient', 'orbit = "moon"\ncoefficient'), "must name a table of [orbits], got 'moon'"),
    (('orbit = "main", strength', 'orbit = "moon", strength'), "field.orbit: must be an orbit of the file (main), got"),
    (("area = 1.0", "area = -0.5"), "drag: plates[0]: Plate.area: must be at least 0 and finite, got -0.5"),
    (("specular = 0.5", "specular = 1.5"), "plates[0]: Plate.specular, Plate.diffuse: must be at least 0 and together"),
    (("specular = 0.5", "shiny = 0.5"), "unknown key"),
    (("scale_height = 0.5", "scale_height = -0.5"), "Drag.scale_height: must be positive and finite, got -0.5"),
    (("scale_height = 0.5\n", ""), "scale_height: missing"),
    (("sun = [1.0, 0, 0]", "sun = [0, 0, 0]"), "SolarPressure.sun: must be finite and not 0"),
    (('orbit = "main"\nshadow', "shadow"), "given together, got shadow 1.0 alone"),
    (("shadow = 1.0", "shadow = 2.5"), "shadow: must be at most the least distance of the orbit, 2 m, got 2.5"),
    (("strength = 1.0, tilt", "radius = 1.0, tilt"),
     "MagneticField.dipole: has no keyword 'radius'; it has orbit, strength, tilt, spin, phase"),
    (("moment = [0.1, 0, 0]", "moment = [0.1, 0]"), "moment"),
    (("pressure = 1e-3", "pressure = nan"), "pressure"),
])
def test_bad_files_are_refused(change, words, tmp_path):
    assert change[0] in FILE
    with pytest.raises(ph.InvalidInput, match=re.escape(words)):
        load(tmp_path, FILE.replace(*change, 1))
