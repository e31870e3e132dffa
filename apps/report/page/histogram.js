// A histogram on a canvas: equal bins by the rule of Freedman and Diaconis, width = 2 IQR / cbrt(n), at most 60 of them.
import {element} from "./element.js";
import {number} from "./format.js";
import {color, onThemeChange} from "./theme.js";

const kMostBins = 60, kHeight = 120;

/// {low, high, counts} of the finite values.
export function bins(values) {
  const sorted = Float64Array.from(values).filter(Number.isFinite).sort();
  const low = sorted[0], high = sorted[sorted.length - 1], at = (share) => sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))];
  const width = (2 * (at(0.75) - at(0.25))) / Math.cbrt(sorted.length);
  const count = high > low ? Math.min(kMostBins, Math.max(5, width > 0 ? Math.ceil((high - low) / width) : 10)) : 1;
  const counts = new Array(count).fill(0);
  for (const v of sorted) ++counts[Math.min(count - 1, Math.floor(((v - low) / (high - low || 1)) * count))];
  return {low, high, counts, median: at(0.5), p95: at(0.95)};
}

/// values: all; of them `failed` (a list, may be empty) is drawn in the colour of failure, on top of the rest's bins.
export function histogram(name, values, failed = []) {
  const {low, high, counts, median, p95} = bins(values);
  const failures = new Array(counts.length).fill(0);
  for (const v of failed) ++failures[Math.min(counts.length - 1, Math.floor(((v - low) / (high - low || 1)) * counts.length))];
  const canvas = element("canvas", {class: "histogram", role: "img", style: `height: ${kHeight}px`,
                                    "aria-label": `Histogram of ${name}: ${number(low, 4)} to ${number(high, 4)}, median ${number(median, 4)}`});
  const draw = () => {
    const ratio = window.devicePixelRatio, width = canvas.clientWidth;
    if (width === 0) return;
    canvas.width = width * ratio;
    canvas.height = kHeight * ratio;
    const context = canvas.getContext("2d"), most = Math.max(...counts), step = canvas.width / counts.length;
    counts.forEach((count, i) => {
      const tall = (count / most) * canvas.height, fails = (failures[i] / most) * canvas.height;
      context.fillStyle = color("series-0");
      context.fillRect(i * step, canvas.height - tall, step - ratio, tall);
      context.fillStyle = color("bad");
      context.fillRect(i * step, canvas.height - fails, step - ratio, fails);
    });
  };
  new ResizeObserver(draw).observe(canvas);
  onThemeChange(draw);
  return element("figure", {class: "plot"}, element("figcaption", {}, name, element("span", {class: "note"}, `median ${number(median, 4)}, 95 % below ${number(p95, 4)}`)),
                 canvas, element("p", {class: "ends"}, element("span", {}, number(low, 4)), element("span", {}, number(high, 4))));
}
