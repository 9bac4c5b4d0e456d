"""Every key of a mapping file, in words: what `hdrig import --help` prints."""

from __future__ import annotations

from typing import Final

KEYS: Final = (
    ("schema, procedure, description", '"hdrig.import/1"; a kind of run; a text'),
    ("[gear] ratio, serial, output", 'ratio is needed; output "flexspline" or "circular_spline"'),
    ("[declared] J_m, J_l, K, fourier_terms", "what was believed of the gear, in SI"),
    ("[conditions] tau_ext, output_locked, depth_mm, speed_rpm, note", "as in the manifest"),
    ("[encoders] motor_counts_per_rev, load_counts_per_rev", "counts_per_turn of the channels where absent"),
    ("[csv] delimiter, decimal, encoding", "one character; . or ,; utf-8, cp1252, utf-16 …"),
    ("[csv] skip_rows, units_row, names", "lines before the header; true: units below it; names where it is none"),
    ("[accept] period, epoch, speed, ratio, torque, stiffness, file_unit, column", "why this check is waived"),
    ("[channels.NAME] column, or sum = [{column, scale}, …]", "where it comes from"),
    ("  unit, meaning", "unit may be left out where the file states it; a name of your own needs both"),
    ("  sign, scale, zero, offset", "value = sign·scale·(column − zero) + offset, in unit; not all for t and counts"),
    ("  counts_per_turn, modulus or bits", "of angles: counts of a turn; where the counter starts again"),
    ("  duplicates", 'of t: "refuse" or "drop" rows with the time of the row before'),
    ("  holes", 'of t, theta_m, theta_l: "refuse" or "drop" rows without a value there'),
)
"""(keys, what they hold); those indented belong to the table above them."""
