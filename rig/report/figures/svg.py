"""From matplotlib's SVG to one fit for a page: small, text as text, colours by name, ids its own.

Coordinates are rounded to a tenth of a pixel.
"""

from __future__ import annotations

import re
import xml.etree.ElementTree as ET
from functools import lru_cache

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
            case "d" if value[:1] == "M":  # curves: steps are ready
                element.set(key, " ".join(NUMBER.sub(_short, value).split()))
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


@lru_cache(1024)
def _style(style: str, themed: bool) -> str:
    parts = [(k.strip(), v.strip()) for k, _, v in (part.partition(":") for part in style.split(";")) if k.strip()]
    kept = ";".join(f"{k}:{NUMBER.sub(_short_style, v)}" for k, v in parts if k not in DROPPED)
    return COLOUR.sub(lambda found: f"var(--{NAME[found[0]]})", kept) if themed else kept


def _short(found: re.Match[str]) -> str:
    return f"{float(found[0]):.1f}".removesuffix(".0")


def _short_style(found: re.Match[str]) -> str:
    return f"{float(found[0]):.2f}".rstrip("0").rstrip(".")


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
