"""Sidebar, menus and preferences."""
