"""Furniture that people modelled: catalogues in Sweet Home 3D's form, and pieces made of their models."""
