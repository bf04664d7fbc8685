"""Sidebar, pie menu, entries in Blender's own menus, presets and preferences."""
