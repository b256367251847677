"""Range and Doppler transforms of a cube and two-dimensional cell-averaging CFAR on their power."""

import numpy as np


class Chain:
    def __init__(self, shape, options):
        loops, _, samples = shape
        self.range_window = normalised(hann(samples)).astype(np.float32)
        self.doppler_window = normalised(hann(loops)).astype(np.float32)[:, None, None]
        self.guard = options["guardCells"]
        self.training = options["trainingCells"]
        self.false_alarm = options["falseAlarm"]
        # Training cells of every cell: range clips at its ends, Doppler closes on itself.
        ones = np.ones((samples, loops))
        self.cells = self.ring(ones)
        # For an exponential power in one channel; conservative for the mean over several, which has
        # lighter tails.
        self.factor = self.cells * (self.false_alarm ** (-1.0 / self.cells) - 1.0)

    def run(self, cube):
        """Loops x channels x samples to an array of [range bin, Doppler bin] of the detections."""
        ranges = np.fft.fft(cube * self.range_window, axis=2)
        spectrum = np.fft.fft(ranges * self.doppler_window, axis=0)
        power = (spectrum.real**2 + spectrum.imag**2).mean(axis=1)
        power = np.fft.fftshift(power, axes=0).T
        threshold = self.ring(power) / self.cells * self.factor
        return np.argwhere(power > threshold)

    def ring(self, power):
        """Sum over the training cells around each cell: the outer box less the inner one."""
        (guard_range, guard_doppler), (range_cells, doppler_cells) = self.guard, self.training
        outer = box(power, guard_range + range_cells, guard_doppler + doppler_cells)
        return outer - box(power, guard_range, guard_doppler)


def box(power, rows, columns):
    """Sums over boxes of half sizes rows and columns, by running sums."""
    height = power.shape[0]
    wrapped = np.concatenate((power[:, -columns:], power, power[:, :columns]), axis=1)
    padded = np.zeros((height + 2 * rows + 1, wrapped.shape[1] + 1))
    np.cumsum(wrapped, axis=1, out=padded[rows + 1 : rows + 1 + height, 1:])
    across = padded[:, 2 * columns + 1 :] - padded[:, : -2 * columns - 1]
    down = np.cumsum(across, axis=0)
    return down[2 * rows + 1 :] - down[: -2 * rows - 1]


def hann(count):
    return 0.5 - 0.5 * np.cos(2.0 * np.pi * np.arange(count) / count)


def normalised(window):
    return window / window.sum()
