"""Colours of quality: red for 0 (bad) over yellow to green for 1 (good)."""

STOPS = (
    (0.0, (0.75, 0.10, 0.10)),
    (0.35, (0.95, 0.60, 0.10)),
    (0.6, (0.55, 0.75, 0.25)),
    (1.0, (0.10, 0.50, 0.30)),
)


def colour_of(goodness):
    """(r, g, b) in 0..1 for a goodness in 0..1."""
    goodness = min(max(float(goodness), 0.0), 1.0)
    for (a, first), (b, second) in zip(STOPS, STOPS[1:]):
        if goodness <= b:
            share = (goodness - a) / (b - a)
            return tuple(x + share * (y - x) for x, y in zip(first, second))
    return STOPS[-1][1]


def palette(count=64):
    """`count` colours from bad to good."""
    return [colour_of(step / (count - 1.0)) for step in range(count)]
