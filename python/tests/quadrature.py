"""What free paths and transmittances have to be, by SciPy alone."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import RegularGridInterpolator
from scipy.special import roots_legendre


class Grid:
    """The trilinear interpolant of voxels, 0 outside, along rays.

    Args:
        values: of shape (nx, ny, nz).
        voxel_size: three edges.
        origin: corner of the first voxel.
    """

    def __init__(self, values, voxel_size, origin):
        self.size = np.asarray(voxel_size, float)
        self.origin = np.asarray(origin, float)
        self.shape = np.array(values.shape)
        # Zeros around: the interpolant fades beyond the outermost centres.
        padded = np.pad(values.astype(float), 1)
        self.centres = [
            self.origin[a] + (np.arange(-1, self.shape[a] + 1) + 0.5) * self.size[a]
            for a in range(3)
        ]
        self.density = RegularGridInterpolator(
            self.centres, padded, bounds_error=False, fill_value=0.0
        )

    def optical_depth(self, start, direction, ends):
        """Integral of the density from the start to each of the ends, which rise.

        Between planes through centres the density is a cubic of the distance, of which Gauss and
        Legendre's rule of three points is exact.
        """
        start, direction = np.asarray(start, float), np.asarray(direction, float)
        cuts = [np.asarray(ends, float), [0.0]]
        for axis in range(3):
            if direction[axis] != 0:
                cuts.append((self.centres[axis] - start[axis]) / direction[axis])
        cuts = np.unique(np.concatenate(cuts))
        cuts = cuts[(cuts >= 0) & (cuts <= max(ends))]
        nodes, weights = roots_legendre(3)
        half = np.diff(cuts) / 2
        ts = (cuts[:-1] + half)[:, None] + half[:, None] * nodes
        densities = self.density(start + ts[..., None] * direction)
        depth = np.concatenate([[0.0], np.cumsum((densities * weights).sum(1) * half)])
        return depth[np.searchsorted(cuts, ends)]


def z_score(mean, error, expected, count):
    """By how many standard errors a mean of `count` values differs from what it should be.

    Values are of the order of 1. Of what happens less than some times in so many, the error that
    the values themselves tell is none: three of them are granted.
    """
    return (np.asarray(mean) - expected) / np.hypot(error, 3 / count)


def z_of(values, expected):
    """The same of values."""
    values = np.asarray(values, float)
    return z_score(values.mean(), values.std(ddof=1) / np.sqrt(values.size), expected, values.size)
