"""A radar's motion from one Doppler point cloud: RANSAC over pairs, all draws at once, then least squares
on the inliers until they stay the same, with the covariance of the fit."""

import numpy as np


class Ransac:
    def __init__(self, options):
        self.residual = options["inlierResidualMps"]
        self.confidence = options["confidence"]
        self.share = options["inlierRatioThreshold"]
        self.draws = int(np.ceil(np.log1p(-self.confidence) / np.log1p(-(self.share**2))))
        self.random = np.random.default_rng(1)

    def motion(self, frame):
        """2 x detections of azimuth (rad) and range rate (m/s) to velocity, covariance and inliers."""
        azimuth, rate = frame
        a = np.array([np.cos(azimuth), np.sin(azimuth)])
        closing = -rate
        count = closing.size
        first = self.random.integers(0, count, self.draws)
        second = (first + self.random.integers(1, count, self.draws)) % count
        (c1, s1), (c2, s2) = a[:, first], a[:, second]
        d1, d2 = closing[first], closing[second]
        determinant = c1 * s2 - s1 * c2
        keep = np.abs(determinant) >= 0.01
        scale = 1.0 / determinant[keep]
        vx = (d1 * s2 - d2 * s1)[keep] * scale
        vy = (d2 * c1 - d1 * c2)[keep] * scale
        votes = np.abs(closing - np.column_stack((vx, vy)) @ a) < self.residual
        inliers = votes[votes.sum(axis=1).argmax()]
        for _ in range(6):
            x = a[:, inliers]
            inverse = np.linalg.inv(x @ x.T)
            velocity = inverse @ (x @ closing[inliers])
            before, inliers = inliers, np.abs(closing - velocity @ a) < self.residual
            if np.array_equal(before, inliers):
                break
        error = closing[inliers] - velocity @ a[:, inliers]
        covariance = inverse * (error @ error / (error.size - 2))
        return velocity, covariance, inliers
