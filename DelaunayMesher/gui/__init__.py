"""The workbench: commands, task panels, view providers, preferences.  Needs FreeCAD's window.

startup -> commands -> task_mesh_object -> mesh_job -> ..document.  No geometry in here, and nothing but
startup, workbench, commands and fem_menu is imported before a command is used.
"""
