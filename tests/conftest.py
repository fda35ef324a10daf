"""With DM_NO_SKIPS set, as in CI, a test that is left out because something is not installed is a failure."""

import os


def pytest_sessionfinish(session):
    reporter = session.config.pluginmanager.get_plugin("terminalreporter")
    if os.environ.get("DM_NO_SKIPS") and reporter and reporter.stats.get("skipped"):
        reporter.write_line("\nDM_NO_SKIPS: tests were left out", red=True)
        session.exitstatus = 1
