"""Executed when FreeCAD's window starts (not imported: there is no __file__, and functions here would not
see names defined here).  Nothing heavy happens before a command is used.
"""

from DelaunayMesher.gui import startup

startup.start()
