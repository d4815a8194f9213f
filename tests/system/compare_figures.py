#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Two figures show the same: places and curves within a pixel, all else to the letter.

  compare_figures.py FRESH WRITTEN

Of two curves every corner lies within a pixel of the other curve. Corners are not compared one by one: where two neighbours fall on
one pixel the drawing leaves one of them out, and a last digit decides.
"""
import math
import re
import sys

NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
CURVE = re.compile(r'<path d="M([-\d. L]+)"')
WORDS = re.compile(r">[^<]*<|#[0-9a-f]+")  # labels, and colours
WITHIN = 1.0  # [px]
REACH = 40  # segments to either side of the last nearest one


def points_of(line):
    """Corners of a curve, or None where the line is no curve."""
    curve = CURVE.match(line)
    return [tuple(map(float, corner.split())) for corner in curve[1].split("L")] if curve and "L" in curve[1] else None


def distance_to_segment(point, start, end):
    along = (end[0] - start[0], end[1] - start[1])
    from_start = (point[0] - start[0], point[1] - start[1])
    length = along[0] ** 2 + along[1] ** 2
    part = max(0.0, min(1.0, (along[0] * from_start[0] + along[1] * from_start[1]) / length)) if length else 0.0
    return math.hypot(from_start[0] - part * along[0], from_start[1] - part * along[1])


def nearest_of(point, curve, segments):
    """Distance of a point from the nearest of these segments, and which that is."""
    return min((distance_to_segment(point, curve[k], curve[k + 1]), k) for k in segments)


def farthest_from(curve, points):
    """Largest distance of the points, taken in order, from the curve."""
    last = len(curve) - 1
    nearest = 0
    farthest = (0.0, points[0])
    for point in points:
        distance, nearest = nearest_of(point, curve, range(max(0, nearest - REACH), min(last, nearest + REACH)))
        if distance > WITHIN:  # a curve that crosses itself: the nearest segment was one of another round
            distance, nearest = nearest_of(point, curve, range(last))
        farthest = max(farthest, (distance, point))
    return farthest


def difference(fresh, written):
    """What differs between two lines of a figure, or None."""
    curves = points_of(fresh), points_of(written)
    if all(curves):
        distance, point = max(farthest_from(curves[0], curves[1]), farthest_from(curves[1], curves[0]))
        if distance > WITHIN:
            return f"{distance:.1f} px apart at {point}"
        fresh, written = CURVE.sub("", fresh), CURVE.sub("", written)
    if NUMBER.sub("", fresh) != NUMBER.sub("", written) or WORDS.findall(fresh) != WORDS.findall(written):
        return f"drawn as {fresh!r}, written as {written!r}"
    pairs = zip(NUMBER.findall(fresh), NUMBER.findall(written), strict=True)
    apart = [pair for pair in pairs if abs(float(pair[0]) - float(pair[1])) > WITHIN]
    return f"drawn with {apart[0][0]}, written with {apart[0][1]}" if apart else None


def main():
    figures = [open(name, encoding="utf-8").read().splitlines() for name in sys.argv[1:3]]
    if len(figures[0]) != len(figures[1]):
        sys.exit(f"{sys.argv[1]}: {len(figures[0])} lines drawn, {len(figures[1])} written")
    for number, lines in enumerate(zip(*figures), 1):
        found = difference(*lines)
        if found:
            sys.exit(f"{sys.argv[1]}:{number}: {found}")


main()
