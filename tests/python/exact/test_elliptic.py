"""Elliptic functions on the pair (m, m1), against mpmath: stored at 40 to 640 digits, and a few computed here."""

import csv
import pathlib

import numpy as np
import pytest
from mpmath import ellipfun, ellipk, mp, mpf

import polhode as ph

TABLE = pathlib.Path(__file__).parents[2] / "reference" / "elliptic.csv"


@pytest.fixture(scope="module")
def table():
    with TABLE.open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def ulps(got, expected):
    return np.abs(got - expected) / np.spacing(np.abs(expected))


def test_jacobi_within_an_ulp_of_mpmath_for_m1_from_1_to_1e_300(table):
    sn, cn, dn = ph.elliptic.jacobi(table["u"], table["m"], table["m1"])
    assert table["m1"].min() < 1e-299 and table["m"].min() < 1e-299
    for got, name in ((sn, "sn"), (cn, "cn"), (dn, "dn")):
        assert ulps(got, table[name]).max() <= 1, name


def test_K_and_nome_within_an_ulp(table):
    assert ulps(ph.elliptic.K(table["m"], table["m1"]), table["K"]).max() <= 1
    assert ulps(ph.elliptic.nome(table["m"], table["m1"]), table["nome"]).max() <= 2


def test_at_the_zeros_themselves():
    """u = the float nearest to K or 2K: what is left of cn and sn is 1e-16 and has digits of its own."""
    with mp.workdps(60):
        for m in (0.25, 0.9, 0.99):
            K = ellipk(mpf(m))
            for u, function, index in ((float(K), "cn", 1), (float(2 * K), "sn", 0)):
                exact = float(ellipfun(function, mpf(u), m=mpf(m)))
                got = ph.elliptic.jacobi(u, m)[index]
                assert abs(got - exact) <= 1e-30 * u


def test_limits():
    u = np.linspace(-20, 20, 41)
    sn, cn, dn = ph.elliptic.jacobi(u, 1.0, 0.0)
    np.testing.assert_allclose(sn, np.tanh(u), rtol=4e-16)
    np.testing.assert_allclose(cn, 1 / np.cosh(u), rtol=1e-15)
    np.testing.assert_array_equal(cn, dn)
    sn, cn, dn = ph.elliptic.jacobi(u, 0.0, 1.0)
    np.testing.assert_allclose(sn, np.sin(u), rtol=4e-16)
    np.testing.assert_allclose(cn, np.cos(u), rtol=4e-16)
    assert (dn == 1).all()
    assert ph.elliptic.K(1.0) == np.inf and ph.elliptic.nome(1.0) == 1 and ph.elliptic.nome(0.0) == 0
    assert ph.elliptic.K(0.0) == np.pi / 2
    assert ph.elliptic.jacobi(1e-200, 0.5)[0] == 1e-200


def test_squares_add_up_across_the_change_of_form():
    m1 = 0.03 * (1 + np.concatenate([-np.logspace(-16, -1, 40), np.logspace(-16, -1, 40)]))
    u = np.linspace(-9, 9, 80)
    sn, cn, dn = ph.elliptic.jacobi(u, 1 - m1, m1)
    np.testing.assert_allclose(sn**2 + cn**2, 1, rtol=4e-16)
    np.testing.assert_allclose((1 - m1) * sn**2 + dn**2, 1, rtol=6e-16)


def test_broadcasts_and_refuses():
    sn, cn, dn = ph.elliptic.jacobi(np.zeros((3, 1)), np.array([0.1, 0.2]))
    assert sn.shape == cn.shape == dn.shape == (3, 2)
    assert ph.elliptic.jacobi([], 0.5)[0].shape == (0,)
    for bad in ((np.nan, 0.5), (np.inf, 0.5), (1.0, 1.5), (1.0, -0.1), (1.0, np.nan), (1.0, 0.5, 0.4), (1e20, 0.5),
                ("x", 0.5),
                ([1, [2]], 0.5), (np.zeros(2), np.full(3, 0.5))):
        with pytest.raises(ph.InvalidInput):
            ph.elliptic.jacobi(*bad)
