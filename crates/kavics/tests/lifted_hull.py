"""Dual edges of discs from a convex hull in three dimensions, by SciPy and Qhull.

In, on stdin: a line `x,y,radius` a disc. The discs are lifted to the points (x, y, x² + y² − r²); the lower facets of
their hull are the triangles of the regular triangulation. Out: a line `i,j,length` for each edge between two lower
facets, `length` the distance of their radical centres, and `i,j,` for an edge of the hull of all centres.
"""

import sys

import numpy as np
from scipy.spatial import ConvexHull

discs = np.loadtxt(sys.stdin, delimiter=",", ndmin=2)
xy = discs[:, :2] - discs[:, :2].mean(axis=0)
lifted = np.column_stack([xy, (xy**2).sum(axis=1) - discs[:, 2] ** 2])
hull = ConvexHull(lifted, qhull_options="Qt")
lower = hull.equations[:, 2] < -1e-12
# The plane z = a·x + b·y + c touches the paraboloid's power at the radical centre (a, b)/2.
centre = np.zeros((len(lower), 2))
centre[lower] = -hull.equations[lower, :2] / (2.0 * hull.equations[lower, 2:3])

for facet in np.flatnonzero(lower):
    for k, other in enumerate(hull.neighbors[facet]):
        i, j = sorted(np.delete(hull.simplices[facet], k))
        if not lower[other]:
            print(f"{i},{j},")
        elif facet < other:
            length = np.linalg.norm(centre[facet] - centre[other])
            print(f"{i},{j},{length!r}".replace("np.float64(", "").replace(")", ""))
