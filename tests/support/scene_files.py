"""Scene files of one body, which tests complete with tables of torques and rotors."""

TIMES = "span = 5.0\nsamples = 11"


def write_scene(path, tables="", moments=(1.0, 2.0, 2.5), omega=(1.0, 2.0, 3.0), times=TIMES, head=""):
    """Write the file, and return its path."""
    path.write_text(f"{head}\n[body]\nmoments = {list(moments)}\n[start]\nomega = {list(omega)}\n{tables}\n"
                    f"[times]\n{times}\n")
    return path
