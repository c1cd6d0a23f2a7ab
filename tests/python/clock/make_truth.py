"""Writes truth.json: the samples of all loops by by_hand.run at 30 digits. Takes minutes."""

import json
import pathlib
import sys

import mpmath as mp
import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).parent))
import by_hand
import loops


def main(names):
    mp.mp.dps = 34
    path = pathlib.Path(__file__).with_name("truth.json")
    found = json.loads(path.read_text()) if path.exists() else {}
    for name, loop in loops.LOOPS.items():
        if names and name not in names:
            continue
        body, more = loops.make_body(loop)
        q = np.array(loop["attitude"]) / np.linalg.norm(loop["attitude"])
        rows = by_hand.run(body, loop["omega"], q, list(loops.times(loop)), loop["controllers"], **more)
        found[name] = [[mp.nstr(x, 25) for x in row] for row in rows]
        path.write_text(json.dumps(found, indent=0))
        print(name, flush=True)


main(sys.argv[1:])
