#!/usr/bin/env python3
"""Writes more_golden.json beside itself: scenes with one surface S, and its values from the formulas, not from isoparm.

    python3 make_more_golden.py          (needs mpmath)

A curve is a definition for the scene and a function of 160 digits here; a surface is its formula in the words of the sources,
corrected as docs/errata.md says. Derivatives are central differences with a step of 1e-30, which leaves more than 50 of the 160
digits; 20 are written.
"""
import os

from more_golden import common, quads, triangles

quads.add()
triangles.add()
common.write(os.path.join(os.path.dirname(os.path.abspath(__file__)), "more_golden.json"))
