"""With DM_NO_SKIPS set, as in CI, a test that is left out because something is not installed is a failure.

What cannot be installed everywhere has a reason that begins with 'optional'.
"""

import os


def pytest_sessionfinish(session):
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    skipped = reporter.stats.get("skipped", ()) if reporter else ()
    if os.environ.get("DM_NO_SKIPS") and any("optional" not in str(test.longrepr) for test in skipped):
        reporter.write_line("\nDM_NO_SKIPS: tests were left out", red=True)
        session.exitstatus = 1
