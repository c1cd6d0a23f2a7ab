"""What `polhode inertia` says about a folder of robot descriptions: files, findings, what is unread, time.

    python benchmarks/robots.py DIR [--package name=folder ...] [--mujoco] [--json FILE]

DIR holds any number of repositories. Each folder in it is taken as one: its files are searched for packages and meshes.
`--mujoco` compares mass, centre and moments of each body with MuJoCo's own, of files that MuJoCo compiles. `--json`
writes each finding with the numbers and the geometry that it is about, for a judgement by hand.
"""

import argparse
import collections
import json
import pathlib
import time
import warnings

import numpy as np

from polhode.inertia.robots.files import gather
from polhode.inertia.robots.paths import Search
from polhode.inertia.robots.report import check_file, link_to_dict

CLOSE = 1e-4       # of the mass, of the largest moment, of the radius of gyration


def repositories(folder):
    """The folders of a folder that hold robots, or it alone."""
    inside = [part for part in sorted(folder.iterdir()) if part.is_dir()]
    return inside or [folder]


def numbers(link):
    """What a judge has to see beside a finding."""
    geometry = link.geometry()
    return {"box": None if geometry.box is None else geometry.box.tolist(), "volume": geometry.volume,
            "uniform": [(np.asarray(r.com).tolist(), (r.matrix * (link.mass or 1)).tolist())
                        for r in geometry.references],
            "visual": [len(link.visual.parts), link.visual.whole], "collision": [len(link.collision.parts),
                                                                                   link.collision.whole]}


def mujoco_bodies(file):
    """Mass, centre and tensor of each body by MuJoCo; None for a file that it refuses."""
    import mujoco

    try:
        model = mujoco.MjSpec.from_file(str(file)).compile()
    except Exception:   # whatever it says
        return None
    found = {}
    for i in range(1, model.nbody):
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.body_iquat[i])
        turn = turn.reshape(3, 3)
        found[model.body(i).name] = (float(model.body_mass[i]), model.body_ipos[i].copy(),
                                     turn @ np.diag(model.body_inertia[i]) @ turn.T)
    return found


def compare(report, file, tally):
    """Count the bodies that both read, and those that are alike."""
    bodies = mujoco_bodies(file)
    if bodies is None:
        tally["refused by MuJoCo"] += 1
        return
    for each in report.links:
        link = each.link
        if link.matrix is None or link.name not in bodies or not np.isfinite(link.matrix).all():
            continue
        changed = any("MuJoCo" in note for note in (*link.notes, *report.notes))
        if changed or any(finding.level == "error" for finding in each.findings):
            continue   # it changes the numbers, and says so
        mass, centre, matrix = bodies[link.name]
        own = link.pose.rotation @ link.matrix @ link.pose.rotation.T
        if not own.any():
            continue
        radius = np.sqrt(np.abs(matrix).max() / mass) if mass > 0 else 1.0
        apart = max(abs(mass - link.mass) / max(mass, 1e-300), np.abs(own - matrix).max() / np.abs(matrix).max(),
                    np.abs(centre - link.pose.place).max() / max(radius, 1e-300))
        tally["compared"] += 1
        tally["alike"] += bool(apart < CLOSE)
        if apart >= CLOSE:
            tally[f"apart: {'from geoms' if link.from_geoms else 'as written'}"] += 1


def sweep(folder, packages, with_mujoco):
    """Check every file; return the counts and a row for each finding."""
    counts, rows, times, unread, agreement = (collections.Counter() for _ in range(5))
    rows = []
    for root in repositories(folder):
        search = Search.of([root], {root.name.rpartition("+")[2]: root, **packages}, [root])
        for file, _ in gather([root]):
            start = time.process_time()
            report = check_file(file, search)
            seconds = time.process_time() - start
            if "cannot be judged" in report.error or any("cannot be judged" in f.text for link in report.links
                                                          for f in link.findings):
                counts["tracebacks"] += 1
                print(f"TRACEBACK {report.error or file}")
            if report.error:
                kind = "nothing to judge" if report.error.endswith(("is missing", "holds no <body>")) else "not read"
                counts[kind] += 1
                if kind == "not read":
                    print(f"not read: {report.error[:200]}")
                continue
            counts["files"] += 1
            times[str(file)] = seconds
            for each in report.links:
                link = each.link
                counts["links"] += 1
                counts["links judged"] += each.diagnosis is not None
                kinds = {kind for kind, _ in link.unread}
                unread.update(kinds)
                counts["links with unread geometry"] += bool(kinds)
                counts["links with geometry"] += bool(kinds or link.visual.parts or link.collision.parts
                                                      or link.from_geoms)
                row = {"root": root.name, **link_to_dict(each)}
                if link.matrix is not None and link.trouble is None:
                    row |= {"geometry": numbers(link)} if each.findings or len(rows) % 20 == 0 else {}
                rows.append(row)
            if with_mujoco and report.format in ("MJCF", "URDF"):
                compare(report, file, agreement)
    return counts, rows, times, unread, agreement


def show(counts, rows, times, unread, agreement):
    """Print the table."""
    print("\n".join(f"{name:30} {count}" for name, count in counts.items()))
    if counts["links with geometry"]:
        part = counts["links with unread geometry"] / counts["links with geometry"]
        print(f"{'unread':30} {100 * part:.2f} % of the links with geometry: " + ", ".join(
            f"{kind} {count}" for kind, count in unread.most_common()))
    findings = collections.Counter((f["level"], f["code"], f["cause"]) for row in rows for f in row["findings"])
    different = collections.Counter()
    seen = set()
    for row in rows:
        for finding in row["findings"]:
            key = (finding["code"], finding["cause"], row["mass"], str(row["matrix"]), str(row["com"]))
            different[finding["level"], finding["code"], finding["cause"]] += key not in seen
            seen.add(key)
    print(f"{'findings':30} {sum(findings.values())}, {sum(different.values())} of them different")
    for key in sorted(findings):
        print(f"  {key[0]:8} {key[1]} {key[2]:16} {findings[key]:6} {different[key]:6}")
    total = sum(times.values())
    print(f"{'CPU':30} {total:.1f} s, median {1e3 * np.median(list(times.values())):.1f} ms a file, the longest "
          f"{max(times.values()):.2f} s")
    if agreement:
        print("MuJoCo: " + ", ".join(f"{name} {count}" for name, count in agreement.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("dir", type=pathlib.Path)
    parser.add_argument("--package", action="append", default=[])
    parser.add_argument("--mujoco", action="store_true")
    parser.add_argument("--json", type=pathlib.Path)
    options = parser.parse_args()
    warnings.simplefilter("ignore")
    packages = {name: pathlib.Path(folder) for name, _, folder in (text.partition("=") for text in options.package)}
    counts, rows, times, unread, agreement = sweep(options.dir, packages, options.mujoco)
    show(counts, rows, times, unread, agreement)
    if options.json:
        options.json.write_text(json.dumps(rows, default=str))


if __name__ == "__main__":
    main()
