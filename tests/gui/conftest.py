"""Tests in a real FreeCAD window."""


def pytest_configure(config):
    config.addinivalue_line("markers", "gui: opens FreeCAD's window on a display of its own")
