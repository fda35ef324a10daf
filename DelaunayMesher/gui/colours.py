"""Colours: of quality, from red (bad) over yellow to green (good); of sizes, from small to large."""

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


def colour_of(share, stops=QUALITY):
    """(r, g, b) in 0..1 for a share in 0..1."""
    share = min(max(float(share), 0.0), 1.0)
    for (a, first), (b, second) in zip(stops, stops[1:]):
        if share <= b:
            along = (share - a) / (b - a)
            return tuple(x + along * (y - x) for x, y in zip(first, second))
    return stops[-1][1]


def palette(count, stops=QUALITY):
    """`count` colours from 0 to 1."""
    return [colour_of(step / (count - 1.0), stops) for step in range(count)]
