"""Writes what tests and docs use of NASA's check case 2, a brick that tumbles without damping.

Source: D. G. Murri, E. B. Jackson, R. O. Shelton, Check-Cases for Verification of 6-Degree-of-Freedom
Flight Vehicle Simulations, NASA/TM-2015-218675; its tables as published in github.com/nasa/simupy-flight,
NESC_data/Atmospheric_checkcases/Atmos_02_TumblingBrickNoDamping. Every simulator's rows at multiples of 0.5 s are
kept, with the columns of rotation and place, and with all their digits.

    python nesc_reference.py FOLDER     # the folder of the published tables
"""

import csv
import pathlib
import sys

HERE = pathlib.Path(__file__).parent / "nesc"
COLUMNS = ("time", "longitude_deg", "latitude_deg", "eulerAngle_deg_Yaw", "eulerAngle_deg_Pitch", "eulerAngle_deg_Roll",
           "bodyAngularRateWrtEi_deg_s_Roll", "bodyAngularRateWrtEi_deg_s_Pitch", "bodyAngularRateWrtEi_deg_s_Yaw")
STEP = 0.5

if __name__ == "__main__":
    HERE.mkdir(exist_ok=True)
    for path in sorted(pathlib.Path(sys.argv[1]).glob("Atmos_02_sim_*.csv")):
        with open(path, newline="") as file:
            rows = [row for row in csv.DictReader(file)
                    if abs(float(row["time"]) / STEP - round(float(row["time"]) / STEP)) < 1e-6]
        lines = [",".join(row[name] for name in COLUMNS) for row in rows]
        (HERE / path.name[9:]).write_text("\n".join([",".join(COLUMNS), *lines]) + "\n")
