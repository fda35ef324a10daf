"""Runs when FreeCAD or FreeCADCmd starts; FreeCAD has put this folder on sys.path already, so that scripts
can say ``from DelaunayMesher import document``.  Nothing else is done here: it would slow every start down.
"""
