"""From matplotlib's SVG to one fit for a page: small, text as text, colours by name, ids its own.

Coordinates are rounded to a tenth of a pixel and written as steps, which makes noisy curves a quarter of the size.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from functools import cache

import numpy as np

from rig.analysis.result import Array
from rig.report.palette import NAME

SVG = "http://www.w3.org/2000/svg"
HREF = "{http://www.w3.org/1999/xlink}href"
COLOUR = re.compile(r"#[0-9a-f]{6}\b")
NUMBER = re.compile(r"-?\d+\.\d+")
NO_TURN = re.compile(r"^rotate\(-?0 ")
DROPPED = ("font-family",)  # left to the page, or to the root of a file of its own
FONTS = "system-ui, 'Segoe UI', Roboto, 'Helvetica Neue', Arial, sans-serif"


def dress(raw: str, prefix: str, label: str, themed: bool) -> str:
    """`raw` from matplotlib, as an <svg> element. Ids get `prefix`; `label` is what a screen reader says.

    `themed`: colours become var(--name) and the size is left to the page; else the file stands alone, in light colours.
    """
    ET.register_namespace("", SVG)
    root = ET.fromstring(raw)
    referred = {*re.findall(r'href="#([^"]+)', raw), *re.findall(r"url\(#([^)]+)", raw)}
    for child in list(root):
        if child.tag.endswith("metadata") or (child.tag.endswith("defs") and child.find(f"{{{SVG}}}style") is not None):
            root.remove(child)
    for element in root.iter():
        _clean(element, prefix, referred, themed)
    _flatten(root)
    box = root.get("viewBox", "0 0 1 1")
    root.attrib.clear()
    root.attrib.update({"viewBox": box, "role": "img", "aria-label": label, "class": "plot"})
    root.set("stroke-linejoin", "round")
    if not themed:
        _, _, width, height = box.split()
        root.attrib.update({"width": width, "height": height, "font-family": FONTS})
    return ET.tostring(root, encoding="unicode")


def _clean(element: ET.Element, prefix: str, referred: set[str], themed: bool) -> None:
    name = element.attrib.pop("id", None)
    if name in referred:
        element.set("id", f"{prefix}{name}")
    if HREF in element.attrib:
        element.set("href", f"#{prefix}{element.attrib.pop(HREF)[1:]}")
    for key, value in list(element.attrib.items()):
        match key:
            case "d":
                element.set(key, steps(value))
            case "style":
                element.set(key, _style(value, themed))
            case "transform" if NO_TURN.match(value):
                del element.attrib[key]
            case "x" | "y" | "width" | "height" | "transform":
                element.set(key, NUMBER.sub(_short, value))
            case "clip-path":
                element.set(key, value.replace("url(#", f"url(#{prefix}"))
    if element.tag != f"{{{SVG}}}text":
        element.text = None
    element.tail = None


def _style(style: str, themed: bool) -> str:
    parts = [(k.strip(), v.strip()) for k, _, v in (part.partition(":") for part in style.split(";")) if k.strip()]
    kept = ";".join(f"{k}:{NUMBER.sub(_short_style, v)}" for k, v in parts if k not in DROPPED)
    return COLOUR.sub(lambda found: f"var(--{NAME[found[0]]})", kept) if themed else kept


def _short(found: re.Match[str]) -> str:
    return f"{float(found[0]):.1f}".removesuffix(".0")


def _short_style(found: re.Match[str]) -> str:
    return f"{float(found[0]):.2f}".rstrip("0").rstrip(".")


def steps(path: str) -> str:
    """A path of M, L and z in absolute floats as relative steps of tenths; paths with curves stay absolute."""
    if any(c in path for c in "CQ"):
        return " ".join(NUMBER.sub(_short, path).split())
    out, here = list[str](), np.zeros(2)
    for piece in path.split("M")[1:]:
        points = np.fromstring(piece.replace("L", "").replace("z", ""), sep=" ").reshape(-1, 2)
        tenths = np.rint(10.0 * points)
        out.append(_relative(np.diff(tenths, axis=0, prepend=here[None])))
        closed = "z" in piece
        out.extend("z" * closed)
        here = tenths[0 if closed else -1]
    return "".join(out)


def _relative(moved: Array) -> str:
    """One m and what is drawn from there, each step [0.1 px] (n, 2); steps of nothing after the first are left out."""
    kept = moved[np.append([True, True], moved[2:].any(axis=1))[: len(moved)]]
    x, y, *lines = kept.ravel().astype(int).tolist()
    start = f"m{_tenths(x)}{_joined(y)}"
    if not lines:
        return start
    # the l is not said again; after an m the numbers alone would mean a line too
    return f"{start}l{_tenths(lines[0])}{''.join(map(_joined, lines[1:]))}"


@cache
def _tenths(value: int) -> str:
    """Steps are short and few of them differ: each is worked out once."""
    whole, tenth = divmod(abs(value), 10)
    text = (str(whole) if whole or not tenth else "") + (f".{tenth}" if tenth else "")
    return f"-{text}" if value < 0 else text


@cache
def _joined(value: int) -> str:
    """The same behind another number: a minus parts them, else a blank does."""
    text = _tenths(value)
    return text if text[0] == "-" else f" {text}"


def _flatten(parent: ET.Element) -> None:
    """Groups that say nothing are replaced by what they hold."""
    children: list[ET.Element] = []
    for child in list(parent):
        _flatten(child)
        if child.tag == f"{{{SVG}}}g" and not child.attrib:
            children.extend(list(child))
        else:
            children.append(child)
    parent[:] = children
