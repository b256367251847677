// Range and Doppler transforms with the npm package fft.js, as one would write them without
// Boresight: double precision, no CFAR.
import FFT from 'fft.js';

const hann = (count) => {
  const values = Array.from({ length: count }, (_, k) => 0.5 - 0.5 * Math.cos((2 * Math.PI * k) / count));
  const sum = values.reduce((a, b) => a + b, 0);
  return values.map((value) => value / sum);
};

/** Returns a function from a cube to its power map (range x Doppler), everything planned ahead. */
export function rangeDopplerPlan({ loops, channels, samples }) {
  const rangeFft = new FFT(samples);
  const dopplerFft = new FFT(loops);
  const rangeWindow = hann(samples);
  const dopplerWindow = hann(loops);
  const chirp = rangeFft.createComplexArray();
  const ranges = Array.from({ length: loops }, () => rangeFft.createComplexArray());
  const pulses = dopplerFft.createComplexArray();
  const spectrum = dopplerFft.createComplexArray();
  return (data) => {
    const power = new Float32Array(samples * loops);
    for (let channel = 0; channel < channels; channel++) {
      for (let loop = 0; loop < loops; loop++) {
        const start = 2 * samples * (loop * channels + channel);
        for (let k = 0; k < samples; k++) {
          chirp[2 * k] = data[start + 2 * k] * rangeWindow[k];
          chirp[2 * k + 1] = data[start + 2 * k + 1] * rangeWindow[k];
        }
        rangeFft.transform(ranges[loop], chirp);
      }
      for (let bin = 0; bin < samples; bin++) {
        for (let loop = 0; loop < loops; loop++) {
          pulses[2 * loop] = ranges[loop][2 * bin] * dopplerWindow[loop];
          pulses[2 * loop + 1] = ranges[loop][2 * bin + 1] * dopplerWindow[loop];
        }
        dopplerFft.transform(spectrum, pulses);
        for (let k = 0; k < loops; k++) {
          const to = bin * loops + ((k + loops / 2) % loops);
          power[to] += (spectrum[2 * k] ** 2 + spectrum[2 * k + 1] ** 2) / channels;
        }
      }
    }
    return power;
  };
}
