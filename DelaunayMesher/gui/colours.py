"""Colours: of quality, from bad to good; of sizes, from small to large; of a chosen element.

The user's preferences may replace the ends of a scale, which is then a plain blend of the two.
"""

from .preferences import group

QUALITY = (
    (0.0, (0.75, 0.10, 0.10)),
    (0.35, (0.95, 0.60, 0.10)),
    (0.6, (0.55, 0.75, 0.25)),
    (1.0, (0.10, 0.50, 0.30)),
)
SIZES = (
    (0.0, (0.85, 0.15, 0.15)),
    (0.33, (0.95, 0.75, 0.20)),
    (0.66, (0.30, 0.70, 0.60)),
    (1.0, (0.20, 0.35, 0.75)),
)
# Name of the preference: (r, g, b) in 0..1 without one.
DEFAULTS = {
    "ColourBad": QUALITY[0][1],
    "ColourGood": QUALITY[-1][1],
    "ColourSmall": SIZES[0][1],
    "ColourLarge": SIZES[-1][1],
    "ColourChosen": (0.85, 0.0, 0.45),
}


def packed(colour):
    """FreeCAD's RRGGBBAA of (r, g, b) in 0..1."""
    red, green, blue = (int(round(255 * part)) for part in colour)
    return red << 24 | green << 16 | blue << 8 | 255


def stored_colour(name):
    """(r, g, b) in 0..1 of a preference."""
    value = group().GetUnsigned(name, packed(DEFAULTS[name]))
    if value == packed(DEFAULTS[name]):
        return DEFAULTS[name]
    return tuple((value >> shift & 255) / 255.0 for shift in (24, 16, 8))


def store_colour(name, colour):
    """Keep a preference; the default, which a button rounds, is not written down."""
    if max(abs(a - b) for a, b in zip(colour, DEFAULTS[name])) < 1 / 250.0:
        group().RemUnsigned(name)
    else:
        group().SetUnsigned(name, packed(colour))


def quality_scale():
    """((share, (r, g, b)), ...) from bad to good."""
    return _scale("ColourBad", "ColourGood", QUALITY)


def size_scale():
    """((share, (r, g, b)), ...) from small to large."""
    return _scale("ColourSmall", "ColourLarge", SIZES)


def _scale(low, high, stops):
    ends = stored_colour(low), stored_colour(high)
    return stops if ends == (stops[0][1], stops[-1][1]) else ((0.0, ends[0]), (1.0, ends[1]))


def colour_of(share, stops):
    """(r, g, b) in 0..1 for a share in 0..1."""
    share = min(max(float(share), 0.0), 1.0)
    for (a, first), (b, second) in zip(stops, stops[1:]):
        if share <= b:
            along = (share - a) / (b - a)
            return tuple(x + along * (y - x) for x, y in zip(first, second))
    return stops[-1][1]


def palette(count, stops):
    """`count` colours from 0 to 1."""
    return [colour_of(step / (count - 1.0), stops) for step in range(count)]
