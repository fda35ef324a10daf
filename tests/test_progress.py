import io

from DelaunayMesher.progress import STAGE_WEIGHTS, Progress, TerminalBar


def test_never_backwards():
    progress = Progress()
    last = 0.0
    for stage, fraction in [
        ("plc", 0),
        ("plc", 1),
        ("sizing", 0.5),
        ("plc", 0),
        ("unknown", 1),
        ("write", 1),
    ]:
        now = progress(stage, fraction)
        assert last <= now <= 1
        last = now
    assert last == 1


def test_bar():
    stream = io.StringIO()
    bar = TerminalBar(stream)
    assert all(bar(stage, 0.5) for stage in STAGE_WEIGHTS)
    assert "read" in stream.getvalue()
    bar.clear()
    assert stream.getvalue().endswith("\r")
