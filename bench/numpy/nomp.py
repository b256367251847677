"""Newtonized orthogonal matching pursuit of one snapshot, stopped by its false-alarm rate."""

import numpy as np

from peaks import decibels
from result import Result


class Nomp:
    def __init__(self, positions, options):
        nomp = options["nomp"]
        positions = np.asarray(positions, dtype=int)
        # Phases are taken about the middle of the array, where angle and amplitude decouple.
        self.positions = positions - positions.mean()
        self.elements = len(positions)
        span = positions.max() - positions.min() + 1
        self.points = 1 << int(np.ceil(np.log2(nomp["oversampling"] * span)))
        self.bins = positions % self.points
        self.single = nomp["singleRefinements"]
        self.cyclic = nomp["cyclicRefinements"]
        self.most = nomp["maxSources"]
        self.noise = nomp["noisePower"]
        # P(max of K independent |a^H n|^2 / K sigma^2 > t) = false alarm (Mamandipoor, eq. 17).
        self.threshold = -np.log(1.0 - (1.0 - nomp["falseAlarm"]) ** (1.0 / self.elements))
        self.slope = 1j * self.positions
        self.square_sum = np.dot(self.positions, self.positions)

    def estimate(self, y):
        y = y[:, 0]
        phases = np.empty(0)
        amplitudes = np.empty(0, dtype=complex)
        vectors = np.empty((self.elements, 0), dtype=complex)
        residual = y
        scattered = np.zeros(self.points, dtype=complex)
        while len(phases) < self.most:
            scattered[self.bins] = residual
            z = np.fft.fft(scattered)
            power = z.real**2 + z.imag**2
            best = power.argmax()
            if power[best] / self.elements < self.threshold * self.noise:
                break
            phase = 2.0 * np.pi * best / self.points
            vector = np.exp(self.slope * phase)
            amplitude = np.vdot(vector, residual) / self.elements
            for _ in range(self.single):
                phase, amplitude, vector = self.refine(residual, phase, amplitude, vector)
            phases = np.append(phases, phase)
            amplitudes = np.append(amplitudes, amplitude)
            vectors = np.column_stack((vectors, vector))
            residual = y - vectors @ amplitudes
            for _ in range(self.cyclic):
                for i in range(len(phases)):
                    own = residual + vectors[:, i] * amplitudes[i]
                    phases[i], amplitudes[i], vectors[:, i] = self.refine(own, phases[i], amplitudes[i], vectors[:, i])
                    residual = own - vectors[:, i] * amplitudes[i]
            amplitudes = np.linalg.lstsq(vectors, y, rcond=None)[0]
            residual = y - vectors @ amplitudes
        u = np.remainder(phases / np.pi + 1.0, 2.0) - 1.0
        power = amplitudes.real**2 + amplitudes.imag**2
        order = np.argsort(-power)
        return Result(np.degrees(np.arcsin(u[order])), decibels(power[order]))

    def refine(self, y, phase, amplitude, vector):
        """One Newton step of 2 Re(conj(x) a^H y) - |x|^2 |a|^2 in the phase, if it is concave
        there, and the amplitude that goes with the new phase."""
        left = y - vector * amplitude
        weighted = self.positions * vector.conj()
        first = np.dot(weighted, left)
        second = np.dot(self.positions * weighted, left)
        gradient = (amplitude.conj() * -1j * first).real
        curvature = (amplitude.conj() * -second).real - abs(amplitude) ** 2 * self.square_sum
        if curvature < 0.0:
            phase = phase - gradient / curvature
            vector = np.exp(self.slope * phase)
        return phase, np.vdot(vector, y) / self.elements, vector
