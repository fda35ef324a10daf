"""Progress of a whole run from the stages' own, and a bar for terminals."""

import sys
import time

# Share of the whole that each stage takes on an ordinary part; only the looks of the bar depend on it.
STAGE_WEIGHTS = {
    "read": 3,
    "plc": 5,
    "sizing": 7,
    "curves": 1,
    "surfaces": 15,
    "boundary": 10,
    "refinement": 35,
    "optimisation": 15,
    "order": 4,
    "write": 5,
}


class Progress:
    """Overall fraction, never running backwards."""

    def __init__(self):
        self.fraction = 0.0

    def __call__(self, stage, fraction):
        """The overall fraction when `stage` is at `fraction`."""
        names = list(STAGE_WEIGHTS)
        if stage in STAGE_WEIGHTS:
            before = sum(STAGE_WEIGHTS[name] for name in names[: names.index(stage)])
            done = (before + STAGE_WEIGHTS[stage] * min(max(fraction, 0.0), 1.0)) / sum(
                STAGE_WEIGHTS.values()
            )
            self.fraction = max(self.fraction, done)
        return self.fraction


class TerminalBar:
    """A report callback that draws a bar on a terminal's stderr."""

    WIDTH = 30
    INTERVAL = 0.1  # seconds between two drawings

    def __init__(self, stream=None):
        self.stream = stream or sys.stderr
        self.progress = Progress()
        self.last = 0.0
        self.drawn = False

    def __call__(self, stage, fraction):
        overall = self.progress(stage, fraction)
        now = time.monotonic()
        if now - self.last >= self.INTERVAL:
            self.last, self.drawn = now, True
            bar = ("#" * int(overall * self.WIDTH)).ljust(self.WIDTH)
            self.stream.write("\r[%s] %3d %%  %-14s" % (bar, overall * 100, stage))
            self.stream.flush()
        return True

    def clear(self):
        """Take the bar away again."""
        if self.drawn:
            self.stream.write("\r" + " " * (self.WIDTH + 25) + "\r")
            self.stream.flush()
