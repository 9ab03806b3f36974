"""Furniture made by code, one function a kind.

A piece stands on the origin: x along the wall behind it and centred, y from the wall (y = 0) into the room, z up.
"""
