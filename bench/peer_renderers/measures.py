"""What is measured of pictures of different seeds: noise, agreement of two renderers, intervals."""

import array
import math
import resource
import statistics
import sys

# Weights of R, G, B in the luminance, linear sRGB.
LUMINANCE = (0.2126, 0.7152, 0.0722)
BLOCK = 16  # Edge of the blocks that are compared [pixels].
ROUNDING = 1e-5  # Of a mean of floats, relative.
# Of a two-sided interval of 95 %, for 2 to 10 rounds; more rounds are taken for 10.
STUDENT = [12.706, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262]


def child_cpu_seconds():
    """User and system time of all child processes that have ended."""
    usage = resource.getrusage(resource.RUSAGE_CHILDREN)
    return usage.ru_utime + usage.ru_stime


class Picture:
    """The pixels of a PFM file as floats, R, G, B in turn, row by row from below."""

    def __init__(self, path):
        with open(path, "rb") as file:
            kind = file.readline().strip()
            self.width, self.height = (int(word) for word in file.readline().split())
            little = float(file.readline()) < 0
            self.values = array.array("f", file.read())
        if kind != b"PF" or len(self.values) != 3 * self.width * self.height:
            raise ValueError(f"{path}: not a PFM file of three channels")
        if little != (sys.byteorder == "little"):
            self.values.byteswap()
        if not all(map(math.isfinite, self.values)):
            raise ValueError(f"{path}: has pixels that are not finite")

    def means(self):
        """Mean of each channel."""
        return [statistics.fmean(self.values[channel::3]) for channel in range(3)]

    def block_means(self):
        """Mean of each channel in each block of BLOCK x BLOCK pixels; rests at the edges count too."""
        sums, counts = {}, {}
        for y in range(self.height):
            for x in range(0, self.width, BLOCK):
                row = self.values[
                    3 * (x + self.width * y) : 3 * (min(x + BLOCK, self.width) + self.width * y)
                ]
                for channel in range(3):
                    key = (y // BLOCK, x, channel)
                    sums[key] = sums.get(key, 0.0) + math.fsum(row[channel::3])
                    counts[key] = counts.get(key, 0) + len(row) // 3
        return [sums[key] / counts[key] for key in sums]


def variances(a, b):
    """Variance of one picture, of R, G, B in the mean and of luminance: half the mean square difference."""
    difference = [x - y for x, y in zip(a.values, b.values, strict=True)]
    rgb = statistics.fmean(d * d for d in difference) / 2
    r, g, b = LUMINANCE
    pixels = zip(difference[0::3], difference[1::3], difference[2::3])
    return {
        "rgb": rgb,
        "luminance": statistics.fmean((r * x + g * y + b * z) ** 2 for x, y, z in pixels) / 2,
    }


def luminance(means):
    return sum(weight * mean for weight, mean in zip(LUMINANCE, means))


def z_score(ours, theirs):
    """Difference of the means of two samples, in standard errors, of which rounding is a part.

    A sky that is seen directly has no noise; sums of floats round it in each program's own way.
    """
    means = statistics.fmean(ours), statistics.fmean(theirs)
    squares = [statistics.variance(sample) / len(sample) for sample in (ours, theirs)]
    error = math.sqrt(sum(squares) + sum((ROUNDING * mean) ** 2 for mean in means))
    return (means[1] - means[0]) / error if error > 0 else 0.0


def agreement(ours, theirs):
    """How pictures of two renderers agree: ratios and z of the channels' means, and blocks that do not.

    Each argument is a list of (means, block means), one of each picture. `blocks` is the share of
    block means that are more than 4 standard errors apart.
    """
    means = [
        [[picture[0][channel] for picture in side] for channel in range(3)]
        for side in (ours, theirs)
    ]
    ratios = [statistics.fmean(b) / statistics.fmean(a) for a, b in zip(*means)]
    z = [z_score(a, b) for a, b in zip(*means)]
    blocks = [list(zip(*(picture[1] for picture in side))) for side in (ours, theirs)]
    apart = [abs(z_score(a, b)) > 4 for a, b in zip(*blocks)]
    return {"mean_ratio": ratios, "z": z, "blocks": sum(apart) / len(apart)}


def ratio_interval(ratios):
    """Geometric mean of ratios, one of each round, and its interval of 95 %, taken as log-normal."""
    logs = [math.log(ratio) for ratio in ratios]
    center = statistics.fmean(logs)
    quantile = STUDENT[min(len(logs), len(STUDENT) + 1) - 2]
    half = quantile * statistics.stdev(logs) / math.sqrt(len(logs))
    return [math.exp(center), math.exp(center - half), math.exp(center + half)]
