"""Numbers for people: as many digits as the uncertainty carries, true minus signs, units beside them.

The uncertainty is rounded to two significant digits and the value to the same place      [gum]
"""

from __future__ import annotations

import math

THIN = "\u202f"  # narrow no-break space between groups of digits
SPACE = "\u00a0"  # no-break space between a number and its unit
MINUS = "\u2212"
ABSENT = "–"
SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
LEAST_SHARE = 0.01  # %: a smaller share without an interval is rounding of what it was computed from
COMPANION = {  # the second unit a test engineer expects beside the first
    "arcsec": ("arcmin", 1 / 60),
    "N·m/rad": ("N·m/arcmin", math.pi / 10800),
}


def fixed(value: float, decimals: int) -> str:
    """`value` to `decimals` places (negative: to tens, hundreds …), digits grouped from five on, never "−0"."""
    rounded = round(value, decimals)
    text = f"{abs(rounded):.{max(decimals, 0)}f}"
    whole, point, fraction = text.partition(".")
    if len(whole) > 4:
        whole = f"{int(whole):,}".replace(",", THIN)
    sign = MINUS if rounded < 0 and any(c in "123456789" for c in text) else ""
    return sign + whole + point + fraction


def places(half: float) -> int:
    """Decimal places that keep two significant digits of `half` > 0 after rounding; negative for tens and more."""
    return 1 - int(f"{half:.1e}".partition("e")[2])


def plain(value: float, digits: int = 4) -> str:
    """A number without a stated uncertainty, to `digits` significant digits, trailing zeros left off."""
    if not math.isfinite(value):
        return ABSENT
    if value == 0:
        return "0"
    mantissa, _, power = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(power)
    if -5 < exponent < max(digits, 6):
        text = fixed(value, digits - 1 - exponent)
        return text.rstrip("0").rstrip(".") if "." in text else text
    scale = 3 * (exponent // 3)
    shown = float(mantissa) * 10 ** (exponent - scale)  # the smallest numbers have no power of ten to divide by
    return f"{plain(shown, digits)}·10{str(scale).translate(SUPERSCRIPT)}"


def quantity(value: float, half: float, unit: str = "") -> str:
    """`value` ± `half` in `unit`: "93.2 ± 1.4 arcsec", "(3.10 ± 0.12)·10⁻⁶ rad". A half-width that is zero, lost in
    rounding or not a number leaves the value alone.
    """
    if not math.isfinite(value):
        return ABSENT
    if not (math.isfinite(half) and half > max(1e-12 * abs(value), 1e-290)):
        small = unit == "%" and 0.0 < abs(value) < LEAST_SHARE
        return join(f"< {LEAST_SHARE:g}" if small else plain(value), unit)
    size = max(abs(value), half)
    if 1e-3 <= size < 1e6:
        decimals = places(half)
        return join(f"{fixed(value, decimals)} ± {fixed(half, decimals)}", unit)
    scale = 3 * math.floor(math.log10(size) / 3)
    factor = 10.0**-scale
    decimals = places(half * factor)
    power = str(scale).translate(SUPERSCRIPT)
    return join(f"({fixed(value * factor, decimals)} ± {fixed(half * factor, decimals)})·10{power}", unit)


def half_width(value: float, interval: tuple[float, float]) -> float | None:
    """Half of a 95 % interval that lies about `value` to within a tenth of its width; None when it is lopsided."""
    low, high = interval
    half = (high - low) / 2
    if not (math.isfinite(half) and half > 0):
        return math.nan
    return half if abs((low + high) / 2 - value) <= 0.1 * half else None


def estimate(value: float, interval: tuple[float, float], unit: str = "") -> str:
    """A figure with its 95 % interval: ± where the interval is even, "1.2 (0.7 to 3.1) arcsec" where it is not."""
    half = half_width(value, interval)
    if half is not None:
        return quantity(value, half, unit)
    low, high = interval
    decimals = places((high - low) / 2)
    if not (-3 <= decimals <= 6 and max(abs(low), abs(high), abs(value)) < 1e9):
        return join(f"{plain(value)} ({plain(low)} to {plain(high)})", unit)
    return join(f"{fixed(value, decimals)} ({fixed(low, decimals)} to {fixed(high, decimals)})", unit)


def companion(value: float, interval: tuple[float, float], unit: str) -> str:
    """The same figure in the second usual unit ("" where there is none): arcsec also in arcmin."""
    if unit not in COMPANION:
        return ""
    other, factor = COMPANION[unit]
    return estimate(value * factor, (interval[0] * factor, interval[1] * factor), other)


def join(text: str, unit: str) -> str:
    """Number and unit, held on one line; % and ° stand as usual."""
    if unit in ("", "1"):
        return text
    return f"{text}{'' if unit == '°' else SPACE}{unit}"


def duration(seconds: float) -> str:
    """A length of time for people: "0.8 s", "3 min 20 s", "2 h 05 min"."""
    if not math.isfinite(seconds):
        return ABSENT
    if seconds < 120:
        return join(plain(seconds, 3), "s")
    minutes, rest = divmod(round(seconds), 60)
    if minutes < 120:
        return f"{minutes}{SPACE}min {rest:02d}{SPACE}s"
    hours, minutes = divmod(minutes, 60)
    return f"{hours}{SPACE}h {minutes:02d}{SPACE}min"


def counted(count: int, what: str) -> str:
    """ "1 run", "2 runs"; `what` takes an s."""
    return f"{count} {what}{'' if count == 1 else 's'}"
