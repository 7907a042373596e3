"""bench/peers on made pictures: noise is measured as it is, and a planted error of 1 % is found."""

import random
import struct
import tempfile
import unittest
from pathlib import Path

from peer_renderers import measures

WIDTH, HEIGHT = 64, 48
NOISE = 0.2


def picture(seed, factor=1.0):
    """A picture of mean `factor` (R, G, B alike in the mean) with independent noise, by way of a file."""
    numbers = random.Random(seed)
    values = [factor * numbers.gauss(1, NOISE) for _ in range(3 * WIDTH * HEIGHT)]
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.pfm"
        # Big-endian, as the positive scale says.
        path.write_bytes(
            f"PF\n{WIDTH} {HEIGHT}\n1.0\n".encode() + struct.pack(f">{len(values)}f", *values)
        )
        return measures.Picture(path)


def pictures(first_seed, factor=1.0):
    return [
        (image.means(), image.block_means())
        for image in (picture(first_seed + i, factor) for i in range(6))
    ]


class Measures(unittest.TestCase):
    def test_variance_is_half_the_mean_square_difference(self):
        variances = measures.variances(picture(1), picture(2))
        # Of 9216 values a variance is good to 1.5 %; luminance weighs three independent channels.
        self.assertAlmostEqual(variances["rgb"] / NOISE**2, 1, delta=0.06)
        weights = sum(weight**2 for weight in measures.LUMINANCE)
        self.assertAlmostEqual(variances["luminance"] / (weights * NOISE**2), 1, delta=0.1)

    def test_same_means_agree_and_one_percent_is_found(self):
        ours = pictures(10)
        same = measures.agreement(ours, pictures(20))
        self.assertLess(max(map(abs, same["z"])), 4)
        self.assertLess(same["blocks"], 0.05)
        off = measures.agreement(ours, pictures(20, 1.01))
        self.assertGreater(max(map(abs, off["z"])), 4)

    def test_a_mirrored_picture_is_found_by_its_blocks(self):
        ours = pictures(10)
        ramp = [
            (means, [mean + 0.01 * i for i, mean in enumerate(blocks)]) for means, blocks in ours
        ]
        mirrored = [(means, blocks[::-1]) for means, blocks in ramp]
        self.assertGreater(measures.agreement(ramp, mirrored)["blocks"], 0.3)

    def test_rounding_of_pixels_without_noise_is_no_difference(self):
        self.assertLess(abs(measures.z_score([0.02] * 6, [0.020000001] * 6)), 1)
        self.assertGreater(abs(measures.z_score([0.02] * 6, [0.0202] * 6)), 4)

    def test_interval_of_ratios_is_that_of_student(self):
        # Logs 0, 1, 2: mean 1, standard deviation 1, so 1 ± 4.303 / sqrt(3).
        center, low, high = measures.ratio_interval([1, 2.718281828, 7.389056099])
        self.assertAlmostEqual(center, 2.71828, places=4)
        self.assertAlmostEqual(low, 0.22665, places=4)
        self.assertAlmostEqual(high, 32.60, places=2)


if __name__ == "__main__":
    unittest.main()
