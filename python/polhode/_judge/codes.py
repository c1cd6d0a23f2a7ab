"""Stable codes of the findings about motions. Causes are fixed words, on which programs may rely."""

from __future__ import annotations

from typing import NamedTuple

LEVELS = ("remark", "warning", "error")


class Code(NamedTuple):
    """A kind of finding: its name, its level, its cause, and what it says in a few words."""

    name: str
    level: str
    cause: str
    title: str
    unit: str = ""


CODES = {
    code.name: code
    for code in (
        Code("PJ001", "error", "finite", "a number that is not finite"),
        Code("PJ002", "error", "unreadable", "samples that cannot be read"),
        Code("PJ003", "error", "time", "times that do not ascend"),
        Code("PJ004", "error", "no rotation", "an attitude that is no rotation"),
        Code("PJ005", "error", "inconsistent", "no convention makes rates and attitudes agree"),
        Code("PJ010", "error", "scalar order", "the quaternion's scalar stands at the other end"),
        Code("PJ011", "error", "conjugate", "the attitude is the reverse rotation"),
        Code("PJ012", "error", "frame of rates", "the rates are in the other axes, of space or body"),
        Code("PJ013", "error", "units of rates", "the rates are in another unit", "factor"),
        Code("PJ014", "error", "units of time", "the times are in another unit", "factor"),
        Code("PJ015", "error", "axis flipped", "axes of the rates point the other way"),
        Code("PJ016", "error", "axes exchanged", "axes of the rates are in another order"),
        Code("PJ017", "error", "Euler sequence", "the angles belong to another sequence, or are in degrees"),
        Code("PJ018", "error", "inertia axes", "the moments are in another order"),
        Code("PJ019", "error", "products of inertia", "products of inertia have the other sign"),
        Code("PJ030", "error", "no gyroscopic term", "Euler's equations lack their gyroscopic term", "rad/s"),
        Code("PJ031", "error", "gyroscopic sign", "the gyroscopic term has the other sign", "rad/s"),
        Code("PJ032", "error", "kinematics", "the attitude is not the integral of the rates", "rad/s"),
        Code("PJ101", "warning", "inertia", "another inertia than given", "log"),
        Code("PJ102", "warning", "damping", "the motion is damped", "1/s"),
        Code("PJ103", "warning", "torque", "a constant torque acts", "N m"),
        Code("PJ104", "warning", "integrator", "the error of an integrator", "rad"),
        Code("PJ105", "warning", "clock", "the clock is fast or slow", "1"),
        Code("PJ106", "warning", "lag", "rates and attitudes belong to different times", "s"),
        Code("PJ107", "warning", "start", "another start than the scene's", "rad/s"),
        Code("PJ108", "warning", "turning frame", "rates or attitudes refer to a frame that turns", "rad/s"),
        Code("PJ109", "warning", "misaligned", "the axes of the rates are tilted", "rad"),
        Code("PJ110", "warning", "bias", "the rates have a constant bias", "rad/s"),
        Code("PJ111", "warning", "rates", "the rates alone are off", "rad/s"),
        Code("PJ112", "warning", "unknown", "no such body moves like this, and no known cause explains it", "rad"),
        Code("PJ120", "warning", "norm", "quaternions are not unit", "1"),
        Code("PJ121", "warning", "dropped", "samples are missing", "samples"),
        Code("PJ122", "warning", "duplicated", "samples come twice", "samples"),
        Code("PJ123", "warning", "interpolated", "attitudes between true samples are interpolated", "s"),
        Code("PJ124", "warning", "outlier", "single samples are off", "samples"),
        Code("PJ201", "remark", "sign flips", "quaternions change sign between samples"),
        Code("PJ202", "remark", "float32", "numbers in single precision"),
        Code("PJ203", "remark", "digits", "numbers with few digits"),
        Code("PJ204", "remark", "noise", "noise, and nothing else"),
        Code("PJ205", "remark", "wraps", "angles jump by whole turns"),
        Code("PJ206", "remark", "cannot tell", "several causes explain the data"),
        Code("PJ207", "remark", "small", "a small deviation without a known cause"),
        Code("PJ208", "remark", "columns", "units and orders that the file states"),
    )
}
BY_CAUSE = {code.cause: code for code in CODES.values()}
CONVENTIONS = {code.cause for code in CODES.values() if "PJ001" <= code.name < "PJ030"}
