"""Motions as files and tables: what is saved repeats them bit by bit, and damaged files are refused."""

import json
import pathlib
import shutil

import ensembles
import numpy as np
import pytest

import polhode as ph

SUFFIXES = ["npz", "zarr"]


def scene(name, times=20):
    whole = ph.Scene.load(name)
    return whole.replace(times=whole.times[:times])


def path_of(tmp_path, suffix):
    if suffix == "zarr":
        pytest.importorskip("zarr")
    return tmp_path / f"saved.{suffix}"


FIRED = ph.Scene(inertia=[[1, 0.1, 0], [0.1, 2, 0], [0, 0, 2.5]], omega=(1, 2, 3), times=[0, 1, 2],
                 attitude=ph.Rotation.from_euler("ZXZ", (0.1, 0.2, 0.3)), t0=0.5,
                 rotors=[ph.Rotor((1, 2, 3), inertia=0.1, speed=2, during=[(0, 1)]), ph.Rotor((0, 1, 3), momentum=0.1)],
                 torques=[ph.torques.During(ph.torques.Constant((0.1, 0, 0)), [(0.7, float("inf"))])])
CASES = [("S5", {}), ("S5", {"certify": "proof"}), ("S1", {"rtol": 1e-8, "method": "dop853"}), ("S10", {}),
         ("S7", {"accuracy": 1e-6, "certify": False}), ("S4", {"method": "rk4", "step": 0.01}), (FIRED, {})]


@pytest.mark.parametrize("suffix", SUFFIXES)
@pytest.mark.parametrize("what, options", CASES, ids=[f"{getattr(w, 'name', w)} {o}" for w, o in CASES])
def test_a_saved_motion_is_the_same_and_repeats(tmp_path, suffix, what, options):
    path = path_of(tmp_path, suffix)
    motion = ph.solve(scene(what) if isinstance(what, str) else what, **options)
    motion.save(path)
    again = ph.load(path)
    assert again.scene == motion.scene and again.plan == motion.plan and repr(again) == repr(motion)
    repeated = ph.solve(again.scene, **again.options)
    for other in (again, repeated):
        for name in ("t", "omega", "attitude", "omega_lower", "attitude_upper"):
            assert np.array_equal(getattr(other, name), getattr(motion, name)), name
        assert (other.status, other.message, other.proved_span) == (motion.status, motion.message, motion.proved_span)
        assert np.array_equal([other.error, other.asked], [motion.error, motion.asked], equal_nan=True)
    assert again.stats == motion.stats and again.drift == motion.drift and again.success == motion.success
    assert again == motion and hash(again) == hash(motion)
    again.__dict__["omega"] = np.nextafter(motion.omega, 9.0)
    assert again != motion


def test_events_and_a_plan_are_saved(tmp_path):
    motion = ph.solve(scene("S5", 100), plan=ph.plan(scene("S5", 100), 1e-7), events=lambda t, omega, q: omega[0])
    motion.save(tmp_path / "a.npz")
    again = ph.load(tmp_path / "a.npz")
    assert len(again.events) > 2 and [hit.t for hit in again.events] == [hit.t for hit in motion.events]
    assert np.array_equal(again.events[1].attitude, motion.events[1].attitude)
    assert np.array_equal(ph.solve(again.scene, **again.options).omega, motion.omega)


@pytest.mark.parametrize("suffix", SUFFIXES)
def test_many_saved_motions_are_the_same_and_repeat(tmp_path, suffix):
    path = path_of(tmp_path, suffix)
    starts = np.random.default_rng(1).normal(size=(5, 3))
    for motions in (ph.solve_many(scene("S5"), omega=starts, rtol=1e-9),
                    ph.solve_many([scene("S5"), scene("S7"), scene("S10")], accuracy=1e-7)):
        motions.save(path)
        again = ph.load(path)
        assert again == motions and hash(again) == hash(motions)
        again.omega[0, 0, 0] = np.nextafter(again.omega[0, 0, 0], 9.0)
        assert again != motions
        again = ph.load(path)
        repeated = ph.solve_many(again.scenes, **again.options)
        for other in (again, repeated):
            for name in ("omega", "attitude", "error", "steps", "success", "lanes", "t_reached"):
                assert np.array_equal(getattr(other, name), getattr(motions, name), equal_nan=name == "error"), name
            assert (other.status, other.message, other.method) == (motions.status, motions.message, motions.method)


def test_a_saved_ensemble_has_the_same_sums(tmp_path):
    run = ph.ensemble(ensembles.write(tmp_path, ensembles.FREE), executor=0, count=5000)
    run.save(tmp_path / "sums.npz")
    again = ph.load(tmp_path / "sums.npz")
    assert again.counts == run.counts and again.done == 5000
    assert np.array_equal(again.summary["angle"].histogram, run.summary["angle"].histogram)
    assert np.array_equal(again.states([4999]).omega, run.states([4999]).omega)
    with pytest.raises(ph.InvalidInput, match="path: must end in .npz"):
        run.save(tmp_path / "sums.zarr")


def test_an_ensemble_is_drawn_and_shown_as_a_table(tmp_path):
    pytest.importorskip("matplotlib")
    run = ph.ensemble(ensembles.write(tmp_path, ensembles.FREE), executor=0, count=500)
    figure = run.plot()
    assert [axes.get_ylabel().split(" [")[0].split(" of the")[0] for axes in figure.axes].count("angle") == 1
    assert len(figure.axes) == len(run.summary) and figure._repr_png_()[:4] == b"\x89PNG"
    (axes,) = run.plot("angle").axes
    median = next(line for line in axes.lines if line.get_label() == "median")
    order = np.argsort(run.times)
    assert np.array_equal(median.get_ydata(), run.summary["angle"].quantile(0.5).value[order])
    for wrong, why in ((("nothing",), "must be one of"), ((), "point")):
        with pytest.raises(ph.InvalidInput, match=why):
            run.plot(*wrong, point=0 if wrong else 7)
    assert "500 of 500" in run._repr_html_() and "<b>Ensemble</b>" in run._repr_html_()


def test_tables_have_all_samples():
    pytest.importorskip("pandas")
    motion = ph.solve(scene("S5"))
    table = motion.to_pandas()
    assert list(table) == ["t", "omega_x", "omega_y", "omega_z", "attitude_x", "attitude_y", "attitude_z", "attitude_w"]
    assert np.array_equal(table["attitude_w"], motion.attitude[:, 3]) and np.array_equal(table["t"], motion.t)
    many = ph.solve_many([scene("S5"), scene("S7")], rtol=1e-6)
    table = many.to_pandas()
    assert len(table) == 40 and np.array_equal(table["omega_y"][table["body"] == 1], many.omega[1, :, 1])
    assert table["t"][20] == scene("S7").times[0] and table["t"][39] == scene("S7").times[19]


def test_datasets_have_units():
    pytest.importorskip("xarray")
    motion = ph.solve(scene("S5"))
    data = motion.to_xarray()
    assert data.omega.dims == ("time", "axis") and data.omega.attrs["units"] == "rad s-1"
    assert np.array_equal(data.sel(axis="y").omega, motion.omega[:, 1]) and data.attrs["Conventions"] == "CF-1.11"
    many = ph.solve_many(scene("S5"), omega=np.eye(3), rtol=1e-6).to_xarray()
    assert many.attitude.dims == ("body", "time", "component") and many.steps.dims == ("body",)


def test_an_ensemble_without_a_store_has_tables_too(tmp_path):
    pytest.importorskip("xarray")
    run = ph.ensemble(ensembles.write(tmp_path, ensembles.FREE), executor=0, count=100)
    table, data = run.to_pandas(), run.dataset
    assert np.array_equal(table["angle_mean"], run.summary["angle"].mean) and len(table) == 6
    assert np.array_equal(data.omega_rms, run.summary["omega"].rms) and data.omega_rms.attrs["units"] == "rad s-1"


def test_what_cannot_be_saved_is_refused(tmp_path):
    with pytest.raises(ph.InvalidInput, match=r"path: must end in \.npz, \.zarr.* or \.?\w+, got 'a.csv'"):
        ph.solve(scene("S5")).save("a.csv")
    assert not list(tmp_path.iterdir())


def test_a_folder_that_is_not_ours_is_not_replaced(tmp_path):
    pytest.importorskip("zarr")
    motion, path = ph.solve(scene("S5")), tmp_path / "a.zarr"
    path.mkdir()
    (path / "mine.txt").write_text("mine")
    with pytest.raises(ph.InvalidInput, match="is there and is not a saved motion"):
        motion.save(path)
    assert (path / "mine.txt").read_text() == "mine" and len(list(tmp_path.iterdir())) == 1
    shutil.rmtree(path)
    motion.save(path)
    motion.save(path)   # one of ours is
    assert ph.load(path).scene == motion.scene


def damage(path):
    """Ways in which a file of ours may be wrong."""
    with np.load(path) as table:
        arrays = {name: table[name] for name in table.files}
    about = json.loads(str(arrays["about"]))
    for changes in ({"kind": "nothing"}, {"kind": ["motion"]}, {"scene": {}}, {"scene": []}, {"plan": None},
                    {"events": [[1]]}, {"scene": about["scene"] | {"torques": [{"kind": "Custom", "state": []}]}},
                    {"scene": about["scene"] | {"torques": [{"kind": "records", "state": []}]}},
                    {"scene": about["scene"] | {"omega": [1, 2]}}, {"scene": about["scene"] | {"physical": None}}):
        yield {**arrays, "about": np.array(json.dumps(about | changes))}
    yield {**arrays, "about": np.array("{")}
    yield {**arrays, "about": np.array("[]")}
    yield {name: array for name, array in arrays.items() if name != "about"}
    yield {name: array for name, array in arrays.items() if name != "t"}


def test_damaged_files_are_refused(tmp_path):
    path = tmp_path / "a.npz"
    ph.solve(scene("S5")).save(path)
    good = path.read_bytes()
    bad = tmp_path / "bad.npz"
    for arrays in damage(path):
        np.savez(bad, **arrays)
        try:
            ph.load(bad)
        except ph.InvalidInput as refused:
            assert "\n" not in str(refused)
    for size in (0, 1, 100, len(good) // 2, len(good) - 1):
        bad.write_bytes(good[:size])
        with pytest.raises(ph.InvalidInput):
            ph.load(bad)
    for wrong in ("nothing.npz", tmp_path, 3, "a\0b"):
        with pytest.raises(ph.InvalidInput):
            ph.load(wrong)
    pathlib.Path(bad).unlink()
