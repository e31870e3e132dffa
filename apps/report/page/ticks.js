// Round numbers along an axis: 1, 2 or 5 times a power of ten apart, and with as many digits as tell neighbours apart.
import {number} from "./format.js";

const kFewest = 3, kMostDigits = 9;

/// At most `most` of them from low to high.
export function ticks(low, high, most) {
  const least = (high - low) / most, power = 10 ** Math.floor(Math.log10(least));
  const step = power * [1, 2, 5, 10].find((factor) => factor * power >= least * (1 - 1e-9));
  const first = Math.ceil(low / step - 1e-9), last = Math.floor(high / step + 1e-9);
  return Array.from({length: Math.max(0, last - first + 1)}, (_, i) => (first + i) * step);
}

/// Their texts, each times a factor.
export function tickTexts(values, factor = 1, fewest = kFewest) {
  const step = Math.abs(values[1] - values[0]) || Infinity, largest = Math.max(...values.map(Math.abs));
  const digits = Math.max(fewest, Math.min(kMostDigits, 1 + Math.ceil(Math.log10(largest / step + 1e-9))));
  return values.map((v) => (v === null ? "" : number(v * factor, digits)));
}
