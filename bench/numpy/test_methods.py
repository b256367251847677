"""The NumPy methods on simulated data with known answers."""

import unittest
from typing import ClassVar

import numpy as np

from chain import Chain
from grid import Grid
from methods import METHODS
from ransac import Ransac

TRUTH_DEG = np.array([-20.3, 5.2, 24.1])
OPTIONS = {
    "gridPoints": 1024,
    "maxPeaks": 16,
    "dynamicRangeDb": 9.0,
    "sources": 3,
    "iterations": 15,
    "maxIterations": 200,
    "tolerance": 1e-8,
    "nomp": {
        "oversampling": 4,
        "singleRefinements": 3,
        "cyclicRefinements": 3,
        "maxSources": 16,
        "falseAlarm": 1e-2,
        "noisePower": 0.01,
    },
}
SINGLE = {"single-snapshot-music", "nomp", "iaa", "iaa-dense"}
UNIFORM = np.arange(32)
SPARSE = np.array([0, 3, 4, 5, 7, 8, 13, 14, 18, 21, 22, 23, 25, 26, 31, 32])


def scene(positions, snapshots, snr_db=20.0, seed=1):
    rng = np.random.default_rng(seed)
    a = np.exp(1j * np.pi * np.outer(positions, np.sin(np.radians(TRUTH_DEG))))

    def normal(*shape):
        return (rng.standard_normal(shape) + 1j * rng.standard_normal(shape)) / np.sqrt(2.0)

    if snapshots == 1:
        signal = np.exp(2j * np.pi * rng.random((len(TRUTH_DEG), 1)))
    else:
        signal = normal(len(TRUTH_DEG), snapshots)
    noise = normal(len(positions), snapshots) * 10.0 ** (-snr_db / 20.0)
    return a @ signal + noise


class MethodsFindTheSources(unittest.TestCase):
    def check(self, name, snapshots, tolerance_deg, options=OPTIONS, positions=UNIFORM):
        found = METHODS[name](positions, options).estimate(scene(positions, snapshots))
        self.assertEqual(len(found.azimuth_deg), 3, f"{name}: {found.azimuth_deg}")
        error = np.abs(np.sort(found.azimuth_deg) - TRUTH_DEG).max()
        self.assertLess(error, tolerance_deg, name)
        return found

    # The bound at 20 dB, 32 elements and 64 snapshots is 0.008 deg a source, for one snapshot
    # 0.06: four times that, and more for spectra, whose peaks lean on one another.
    def test_many_snapshots(self):
        for name in ("music", "root-music", "esprit", "maximum-likelihood"):
            self.check(name, 64, 0.035)
        for name in ("bartlett", "capon", "min-norm"):
            self.check(name, 64, 0.06)
        root = self.check("root-music", 64, 0.035)
        music = self.check("music", 64, 0.035)
        np.testing.assert_allclose(np.sort(music.azimuth_deg), np.sort(root.azimuth_deg), atol=2e-3)

    def test_one_snapshot(self):
        for name in ("nomp", "iaa"):
            self.check(name, 1, 0.25)
        self.check("single-snapshot-music", 1, 0.4)
        self.check("bartlett", 1, 0.8)

    def test_sparse_bayesian(self):
        options = {**OPTIONS, "gridPoints": 128, "tolerance": 1e-4, "maxIterations": 500}
        self.check("sparse-bayesian", 16, 0.05, options)

    def test_powers_of_sources(self):
        for name in ("root-music", "esprit", "maximum-likelihood", "capon"):
            found = self.check(name, 64, 0.06)
            # Mean of 64 exponentials has a spread of 0.54 dB; Capon's height is biased downwards.
            limit = 10.0 if name == "capon" else 2.2
            self.assertLess(np.abs(found.power_db).max(), limit, name)

    def test_arrays_with_gaps(self):
        for name in ("capon", "music", "maximum-likelihood"):
            self.check(name, 64, 0.05, positions=SPARSE)
        self.check("nomp", 1, 0.3, positions=SPARSE)

    def test_noise_alone_is_no_source(self):
        rng = np.random.default_rng(5)
        nomp = METHODS["nomp"](UNIFORM, OPTIONS)
        hits = 0
        for _ in range(1000):
            y = (rng.standard_normal((32, 1)) + 1j * rng.standard_normal((32, 1))) * np.sqrt(0.005)
            hits += len(nomp.estimate(y).azimuth_deg) > 0
        # 1 % of 1000 at the critical grid; off-grid maxima raise it a few times at most.
        self.assertLess(hits, 60)


class Transforms(unittest.TestCase):
    def setUp(self):
        self.grid = Grid(SPARSE - 4, 128)
        rng = np.random.default_rng(2)
        self.z = rng.standard_normal((16, 16)) + 1j * rng.standard_normal((16, 16))
        self.a = self.grid.steering()

    def test_correlation_is_the_product_with_the_steering_vectors(self):
        expected = self.a.conj().T @ self.z
        np.testing.assert_allclose(self.grid.correlate(self.z).T, expected, atol=1e-12)
        np.testing.assert_allclose(self.grid.correlate(self.z[:, 3]), expected[:, 3], atol=1e-12)

    def test_quadratic_form_in_either_order(self):
        h = self.z + self.z.conj().T
        expected = np.einsum("kg,kl,lg->g", self.a.conj(), h, self.a).real
        for matrix in (h, np.asfortranarray(h), np.asfortranarray(np.tril(h))):
            np.testing.assert_allclose(self.grid.quadratic(matrix), expected, atol=1e-11)

    def test_refined_points_are_stationary(self):
        form = self.z @ self.z.conj().T
        spectrum = self.grid.quadratic(form)
        top = np.argmax(spectrum)
        u, value = self.grid.refine(self.grid.u[[top]], steps=8)

        def at(u):
            a = self.grid.steering(u)
            return np.einsum("kg,kl,lg->g", a.conj(), form, a).real

        np.testing.assert_allclose(value, at(u), rtol=1e-12)
        self.assertGreaterEqual(value[0], spectrum[top])
        slope = (at(u + 1e-5) - at(u - 1e-5)) / 2e-5
        self.assertLess(abs(slope[0]), 1e-3 * value[0])

    def test_covariance_of_a_spectrum(self):
        power = np.random.default_rng(3).random(128)
        expected = (self.a * power) @ self.a.conj().T
        np.testing.assert_allclose(self.grid.covariance(power), expected, atol=1e-11)


class IaaForms(unittest.TestCase):
    def test_fast_equals_dense(self):
        for positions in (UNIFORM, SPARSE):
            y = scene(positions, 1)
            fast = METHODS["iaa"](positions, OPTIONS).estimate(y).spectrum_db
            dense = METHODS["iaa-dense"](positions, OPTIONS).estimate(y).spectrum_db
            strong = dense > dense.max() - 60.0
            np.testing.assert_allclose(fast[strong], dense[strong], atol=1e-6)


class RangeDoppler(unittest.TestCase):
    OPTIONS: ClassVar = {"guardCells": [2, 2], "trainingCells": [8, 4], "falseAlarm": 1e-5}

    def test_finds_the_targets_and_little_else(self):
        rng = np.random.default_rng(4)
        loops, channels, samples = 128, 8, 256
        cube = rng.standard_normal((loops, channels, samples, 2)).view(np.complex128)[..., 0]
        cells = {(40, 70), (91, 20)}
        n, m = np.arange(samples), np.arange(loops)[:, None, None]
        for r, d in cells:
            tone = np.exp(2j * np.pi * (r * n / samples + (d - 64) * m / loops))
            cube = cube + 0.2 * tone
        found = Chain(cube.shape, self.OPTIONS).run(cube.astype(np.complex64))
        self.assertLessEqual(cells, {tuple(cell) for cell in found})
        far = [c for c in found if min(abs(c[0] - r) + abs(c[1] - d) for r, d in cells) > 3]
        self.assertLess(len(far), 5)

    def test_training_cells_clip_in_range_and_wrap_in_doppler(self):
        cells = Chain((16, 1, 32), {**self.OPTIONS, "trainingCells": [3, 1]}).cells
        self.assertEqual(cells[16, 8], 11 * 7 - 5 * 5)
        self.assertEqual(cells[0, 0], 6 * 7 - 3 * 5)
        self.assertEqual(cells[0, 8], cells[0, 15])


class Motion(unittest.TestCase):
    def test_finds_the_motion_among_what_moves(self):
        options = {"inlierResidualMps": 0.3, "confidence": 0.999, "inlierRatioThreshold": 0.3}
        rng = np.random.default_rng(5)
        azimuth = rng.uniform(-1.0, 1.0, 100)
        rate = -(10.0 * np.cos(azimuth) + 3.0 * np.sin(azimuth)) + 0.1 * rng.standard_normal(100)
        rate[:30] += rng.uniform(2.0, 20.0, 30)
        velocity, covariance, inliers = Ransac(options).motion((azimuth, rate))
        error = velocity - [10.0, 3.0]
        # Three standard deviations in either direction, of 70 detections.
        self.assertLess(error @ np.linalg.inv(covariance) @ error, 12.0)
        self.assertLess(inliers[:30].sum(), 4)


if __name__ == "__main__":
    unittest.main()
