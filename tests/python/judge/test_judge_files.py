"""Motions in files: columns by their names, with units and orders that these state; bad files get one sentence."""

import json
import re

import numpy as np
import pytest

import polhode as ph
from polhode._judge.columns import choose, role
from polhode._judge.sources import load

I = (1.0, 2.0, 2.5)
T = np.linspace(0, 6, 120)
W, Q = ph.FreeMotion(I, (1, 0.5, 2)).at(T)
R = ph.Rotation.from_quat(Q)


def write(path, header, *arrays, separator=",", digits=17):
    table = np.column_stack(arrays)
    rows = [separator.join(f"{x:.{digits}g}" for x in row) for row in table.tolist()]
    path.write_text("\n".join([*([header] if header else []), *rows]) + "\n")
    return path


def judged(source, **words):
    return ph.judge(source.t, source.attitude, source.omega, order=source.order, euler=source.euler,
                    degrees=source.degrees, **({"inertia": I, "tolerance": 1e-9} | words))  # fmt: skip


WXYZ = Q[:, [3, 0, 1, 2]]
YPR = R.as_euler("ZYX", degrees=True)
FORMS = {
    "polhode run": ("t,omega_x,omega_y,omega_z,attitude_x,attitude_y,attitude_z,attitude_w", (T, W, Q), ","),
    "scalar first": ("t qw qx qy qz wx wy wz", (T, WXYZ, W), " "),
    "semicolons": ("time;q_x;q_y;q_z;q_w;w_x;w_y;w_z", (T, Q, W), ";"),
    "tabs and units": ("time [ms]\tqx\tqy\tqz\tqw\twx [deg/s]\twy [deg/s]\twz [deg/s]",
                       (1000 * T, Q, np.degrees(W)), "\t"),
    "EuRoC": ("#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],a_RS_S_x [m s^-2]",
              (np.round(T * 1e9), W, 0 * T), ","),
    "EuRoC's truth": ("#timestamp [ns],p_RS_R_x [m],q_RS_w [],q_RS_x [],q_RS_y [],q_RS_z [],b_w_RS_S_x [rad s^-1]",
                      (np.round(T * 1e9), 0 * T, WXYZ, 0 * T), ","),
    "TUM": ("# timestamp tx ty tz qx qy qz qw", (T, 0 * W, Q), " "),
    "TUM without a header": ("", (T, 0 * W, Q), " "),
    "ROS": ("header.stamp,orientation.x,orientation.y,orientation.z,orientation.w,orientation_covariance.0,"
            "angular_velocity.x,angular_velocity.y,angular_velocity.z,angular_velocity_covariance.0",
            (T, Q, 0 * T, W, 0 * T), ","),
    "rosbag": ("%time,field.orientation.x,field.orientation.y,field.orientation.z,field.orientation.w",
               (np.round(T * 1e9) + 0.0, Q), ","),
    "NESC without a place": ("time,eulerAngle_deg_Yaw,eulerAngle_deg_Pitch,eulerAngle_deg_Roll,"
                             "bodyAngularRateWrtEi_deg_s_Roll,bodyAngularRateWrtEi_deg_s_Pitch,"
                             "bodyAngularRateWrtEi_deg_s_Yaw", (T, YPR, np.degrees(W)), ","),
    "p, q, r": ("t,roll [deg],pitch [deg],yaw [deg],p [deg/s],q [deg/s],r [deg/s]",
                (T, YPR[:, ::-1], np.degrees(W)), ","),
    "matrices": (",".join(["t", *(f"R{a}{b}" for a in "123" for b in "123"), "wx", "wy", "wz"]),
                 (T, R.as_matrix().reshape(-1, 9), W), ","),
    "mixed units": ("t,roll [rad],pitch [rad],yaw [rad],rollRate [deg/s],pitchRate [deg/s],yawRate [deg/s]",
                    (T, np.radians(YPR[:, ::-1]), np.degrees(W)), ","),
    "rpm": ("t,qx,qy,qz,qw,gyro_x (rpm),gyro_y (rpm),gyro_z (rpm)", (T, Q, W * 60 / 2 / np.pi), ","),
}  # fmt: skip


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_tables_are_fine_as_their_headers_state(form, tmp_path):
    header, arrays, separator = FORMS[form]
    source = load(write(tmp_path / "run.csv", header, *arrays, separator=separator))
    if form == "rosbag":
        source.t = source.t * 1e-9  # its stamps begin at 0 here, so that they look like seconds
    found = judged(source)
    assert found.fine and not [f for f in found.findings if f.level != "remark"], str(found)
    assert found.deviation.attitude is None or found.deviation.attitude < 1e-8
    assert len(source.t) == 120 and source.lines[0] == 1 + bool(header)


def test_stamps_of_ros_keep_their_nanoseconds(tmp_path):
    stamps = 1403636579763555584 + np.round(T * 1e9).astype(np.int64)
    rows = [f"{s},{','.join(repr(x) for x in w.tolist())}" for s, w in zip(stamps, W)]
    (tmp_path / "run.csv").write_text("%time,wx,wy,wz\n" + "\n".join(rows) + "\n")
    source = load(tmp_path / "run.csv")
    np.testing.assert_allclose(source.t, np.round(T * 1e9) * 1e-9, rtol=0, atol=1e-15)
    assert any("ns" in note for note in source.notes) and judged(source).fine


def test_local_angles_of_nesc_are_turned_with_the_earth(tmp_path):
    longitude, latitude = 10 + 0.01 * T, 20 + 0.02 * T
    turned = ph.Rotation.from_rotvec(np.outer(np.radians(longitude) + 7.292115e-5 * T, [0, 0, 1]))
    tilt = ph.Rotation.from_rotvec(np.outer(-np.radians(latitude) - np.pi / 2, [0, 1, 0]))
    local = ((turned * tilt).inv() * R).as_euler("ZYX", degrees=True)
    header = FORMS["NESC without a place"][0] + ",longitude_deg,latitude_deg"
    path = write(tmp_path / "run.csv", header, T, local, np.degrees(W), longitude, latitude)
    source = load(path)
    assert np.max(np.abs(np.abs(np.sum(source.attitude * Q, axis=1)) - 1)) < 1e-12
    assert judged(source).fine and any("Earth" in note for note in source.notes)


def test_arrays_of_other_programs(tmp_path):
    motion = ph.solve(ph.Scene(inertia=I, omega=(1, 0.5, 2), times=T), 1e-12)
    np.savez(tmp_path / "a.npz", t=motion.t, omega=motion.omega, attitude=motion.attitude)
    assert judged(load(tmp_path / "a.npz")).fine
    np.savez(tmp_path / "b.npz", stamp=T, gyr=W, R_WB=R.as_matrix(), other=np.zeros(3))
    assert judged(load(tmp_path / "b.npz", "t=stamp,omega=gyr,attitude=R_WB")).fine
    np.savez(tmp_path / "c.npz", time=T, quat=WXYZ, w=W)
    assert judged(load(tmp_path / "c.npz", order="wxyz")).fine
    names = dict(zip(("qx", "qy", "qz", "qw", "wx", "wy", "wz"), np.hstack([Q, W]).T))
    np.savez(tmp_path / "d.npz", t=T, **names)
    assert judged(load(tmp_path / "d.npz")).fine
    (tmp_path / "e.json").write_text(json.dumps({"t": T.tolist(), "omega": W.tolist(), "scene": "S1"}))
    assert judged(load(tmp_path / "e.json")).fine
    io = pytest.importorskip("scipy.io")
    io.savemat(tmp_path / "f.mat", {"t": T, "omega": W, "quat": Q})
    assert judged(load(tmp_path / "f.mat")).fine


def test_columns_named_by_the_caller(tmp_path):
    bare = write(tmp_path / "a.csv", "", T, WXYZ, W)
    assert judged(load(bare, "t,qw,qx,qy,qz,wx,wy,wz")).fine
    counted = write(tmp_path / "b.csv", "t,q0,q1,q2,q3", T, WXYZ)
    assert judged(load(counted, order="wxyz")).fine
    angles = write(tmp_path / "c.csv", "t,angle_1,angle_2,angle_3", T, R.as_euler("ZXZ"))
    assert judged(load(angles, euler="ZXZ")).fine


BAD = {
    "a row cut short": ("t,wx,wy,wz\n0,1,2,3\n1,1,2\n", "line 3: has 3 cells, the header names 4"),
    "mixed separators": ("t,wx,wy,wz\n0,1,2,3\n1;1;2;3\n",
                         "line 3: has 1 cells, the header names 4; it is separated by semicolons"),
    "another separator in the header": ("t;wx;wy;wz\n0,1,2,3\n1,1,2,3\n",
                                        "line 2: is separated by commas, and the header by semicolons"),
    "a decimal comma": ("t;wx;wy;wz\n0;1,5;2;3\n1;1;2;3\n", "must be numbers, got '1,5'; write decimals with a point"),
    "no number": ("t,wx,wy,wz\n0,1,2,3\n1,1,two,3\n", "line 3: must be numbers, got 'two'"),
    "a column twice": ("t,wx,wx,wy,wz\n0,1,2,3,4\n1,1,2,3,4\n", "column 'wx': must come once"),
    "two columns of one thing": ("t,wx,omega_x,wy,wz\n0,1,2,3,4\n1,1,2,3,4\n",
                                 "'wx' and 'omega_x': both name one thing"),
    "an unknown unit": ("t,wx [furlong],wy [furlong],wz [furlong]\n0,1,2,3\n1,1,2,3\n",
                        "has the unknown unit 'furlong'"),
    "units that differ": ("t,wx [deg/s],wy,wz\n0,1,2,3\n1,1,2,3\n", "column 'wx [deg/s]': must have the unit of its"),
    "no scalar told": ("t,q0,q1,q2,q3\n0,1,2,3,4\n1,1,2,3,4\n", "q0, q1, q2, q3: do not say where the scalar is"),
    "no sequence told": ("t,angle_1,angle_2,angle_3\n0,1,2,3\n1,1,2,3\n", "do not say their sequence"),
    "no time": ("x,wx,wy,wz\n0,1,2,3\n1,1,2,3\n", "the time: must have a column such as 't', got x, wx, wy, wz"),
    "no motion": ("t,x,y,z\n0,1,2,3\n1,1,2,3\n", "the motion: must have columns such as qx"),
    "two rates": ("t,wx,wy\n0,1,2\n1,1,2\n", "the rates: must have three columns such as wx, wy, wz, got 'wx', 'wy'"),
    "no names": ("0,1,2,3\n1,1,2,3\n", "must have a header, or --columns must name its 4 columns"),
    "no rows": ("t,wx,wy,wz\n", "must have rows|must have at least 2 rows"),
    "nothing": ("", "must have rows of numbers, got none"),
    "null characters": ("t,wx\0\n", "must be text, got null characters"),
}  # fmt: skip


@pytest.mark.parametrize("case", BAD)
def test_bad_tables_get_one_sentence(case, tmp_path):
    text, words = BAD[case]
    (tmp_path / "run.csv").write_text(text)
    with pytest.raises(ph.InvalidInput, match="|".join(map(re.escape, words.split("|")))) as refused:
        load(tmp_path / "run.csv")
    assert "run.csv: " in str(refused.value) and "\n" not in str(refused.value) and len(str(refused.value)) < 250


def test_other_bad_files_get_one_sentence(tmp_path):
    for name, content, words in [
        ("a.parquet", b"PAR1", "must be one of .csv"),
        ("a.csv", b"\xff\xfe\xff", "must be text in UTF-8"),
        ("a.npz", b"PK", "is damaged: it is no NPZ"),
        ("a.json", b"[1, 2]", "must be a table of arrays, got list"),
        ("b.json", b'{"t": [0, 1], "omega": [[1, 2, 3], [1, 2]]}', "omega: must be an array of numbers"),
        ("c.json", b'{"omega": [[1, 2, 3]]}', "must have an array of times, 't'; it has omega"),
        ("d.json", b'{"t": [0, 1], "attitude": [[1, 2, 3], [1, 2, 3]]}', "tell their sequence by --euler"),
        ("a.mat", b"nothing", "is damaged: it is no MAT file"),
    ]:
        (tmp_path / name).write_bytes(content)
        with pytest.raises(ph.InvalidInput, match=re.escape(words)):
            load(tmp_path / name)
    (tmp_path / "folder.csv").mkdir()
    with pytest.raises(ph.InvalidInput, match="cannot be read: No such file"):
        load(tmp_path / "missing.csv")
    with pytest.raises(ph.InvalidInput, match="it is a folder"):
        load(tmp_path / "folder.csv")


def test_options_that_contradict_the_columns_are_refused(tmp_path):
    path = write(tmp_path / "run.csv", "t,qx,qy,qz,qw,wx [rad/s],wy [rad/s],wz [rad/s]", T, Q, W)
    with pytest.raises(ph.InvalidInput, match="--order: must be left out, as the columns name the scalar"):
        load(path, order="wxyz")
    with pytest.raises(ph.InvalidInput, match="--degrees: must be left out, as the columns state radians"):
        load(path, degrees=True)
    with pytest.raises(ph.InvalidInput, match="--columns: must name the 8 columns of .*, got 2 names"):
        load(path, "t,wx")


def test_empty_cells_are_found_as_numbers_that_are_not_finite(tmp_path):
    (tmp_path / "run.csv").write_text("t,wx,wy,wz\n0,1,2,3\n1,,2,3\n2,nan,2,3\n")
    found = judged(load(tmp_path / "run.csv"))
    assert found.findings[0].cause == "finite" and found.findings[0].where == (1, 2)


def test_too_many_rows_are_refused_before_numbers_are_read(tmp_path, monkeypatch):
    monkeypatch.setattr("polhode._judge.table.MOST_ROWS", 100)
    with pytest.raises(ph.InvalidInput, match="must have at most 100 lines, got 121; keep one row of 2"):
        load(write(tmp_path / "run.csv", "t,wx,wy,wz", T, W))


@pytest.mark.parametrize("name", ["b_w_RS_S_x", "omega_x_lower", "orientation_covariance.0", "acc_x", "gyro_bias_x",
                                  "angular_velocity_covariance.4", "magnetic_x", "x", "wind_x", "quality",
                                  "theta_dot"])  # fmt: skip
def test_other_columns_are_left_alone(name):
    assert role(name) is None


def test_a_choice_names_places_in_the_order_of_its_channel():
    choice = choose(["qw", "wz", "t", "qx", "wy", "qy", "wx", "qz"], None, None)
    assert (choice.t, choice.omega, choice.attitude, choice.kind) == (2, [6, 4, 1], [3, 5, 7, 0], "quaternion")
