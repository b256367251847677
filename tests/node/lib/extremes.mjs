// Extreme finite numbers, put into the arguments of otherwise good calls.

const magnitudes = [
  0, 5e-324, 1e-310, 1e-300, 1e-160, 1e-80, 1e-38, 1, 1e10, 1e38, 1e40, 1e80, 1e150, 1e160, 1e300, 1.7e308,
];

/** A finite number of any magnitude and sign. */
const extreme = ({ draw, pick }) => pick(magnitudes) * (draw() < 0.5 ? -1 : 1) * (draw() < 0.5 ? 1 : 0.5 + draw() / 2);

const like = (array, number) => array.map((value, index) => number(value, index));

/** By name, what replaces the numbers of an array. Every result is finite in the array's own type. */
export const spoilers = {
  'one extreme sample': (array, tools) => {
    const at = Math.floor(tools.draw() * array.length);
    return like(array, (value, index) => (index === at ? extreme(tools) : value));
  },
  'one row scaled': (array, tools) => {
    const rows = tools.pick([2, 4, 8]);
    const row = Math.floor(tools.draw() * rows);
    const factor = extreme(tools);
    const length = Math.ceil(array.length / rows);
    return like(array, (value, index) => (Math.floor(index / length) === row ? value * factor : value));
  },
  'all scaled': (array, tools) => {
    const factor = extreme(tools);
    return like(array, (value) => value * factor);
  },
  'mixed scales': (array, tools) => like(array, (value) => value * extreme(tools)),
  'identical rows': (array, tools) => {
    const length = Math.ceil(array.length / tools.pick([2, 4, 8]));
    return like(array, (_, index) => array[index % length]);
  },
  'denormal numbers': (array, tools) => like(array, () => 5e-324 * Math.floor(tools.draw() * 4)),
  'one constant': (array, tools) => {
    const value = extreme(tools);
    return like(array, () => value);
  },
};

/** Replaces what overflowed the type of the array by its largest number. */
function finite(array) {
  const largest = array instanceof Float32Array ? 3.4028234663852886e38 : Number.MAX_VALUE;
  return array.map((value) => (Number.isNaN(value) ? 0 : Math.min(largest, Math.max(-largest, value))));
}

const isNumbers = (value) =>
  value instanceof Float64Array ||
  value instanceof Float32Array ||
  (Array.isArray(value) && value.length > 0 && value.every((item) => typeof item === 'number'));

/** Copies arguments and applies `spoil` to one of their arrays of numbers, or replaces one single number. */
export function withExtremes(args, spoil, tools) {
  const places = [];
  const look = (value, path) => {
    if (isNumbers(value)) places.push({ path, array: true });
    else if (typeof value === 'number') places.push({ path, array: false });
    else if (typeof value === 'object' && value !== null && !ArrayBuffer.isView(value)) {
      // A wrong shape is refused before any number is looked at.
      for (const key of Object.keys(value)
        .filter((key) => key !== 'shape')
        .slice(0, 30))
        look(value[key], [...path, key]);
    }
  };
  look(args, []);
  if (places.length === 0) return undefined;
  // Data before options: most places are single numbers.
  const arrays = places.filter(({ array }) => array);
  const { path, array } = tools.pick(arrays.length > 0 && tools.draw() < 0.7 ? arrays : places);
  const into = (value, depth) => {
    if (depth === path.length) return array ? finite(spoil(value, tools)) : extreme(tools);
    const copy = Array.isArray(value) ? [...value] : { ...value };
    copy[path[depth]] = into(value[path[depth]], depth + 1);
    return copy;
  };
  return into(args, 0);
}
