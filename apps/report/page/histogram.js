// A histogram on a canvas: equal bins by the rule of Freedman and Diaconis, width = 2 IQR / cbrt(n), 20 to 60 of them where there are enough values;
// whole numbers where the values are such.
import {element} from "./element.js";
import {number, prefixed, withUnit} from "./format.js";
import {percentile, sorted} from "./statistics.js";
import {color, onThemeChange, seriesColor} from "./theme.js";
import {largestOf} from "./units.js";

const kMostBins = 60, kEnoughBins = 20, kHeight = 120;

/// {low, high, count} of the bins that hold all values of a sorted sample.
export function bins(sample) {
  const low = sample[0], high = sample[sample.length - 1], width = (2 * (percentile(sample, 0.75) - percentile(sample, 0.25))) / Math.cbrt(sample.length);
  if (!(high > low)) return {low, high, count: 1};
  if (sample.every(Number.isInteger) && high - low < kMostBins) {
    const step = Math.max(1, Math.floor(width)), count = Math.ceil((high - low + 1) / step);
    return {low: low - 0.5, high: low - 0.5 + count * step, count};
  }
  // The rule is for one hump; two far apart make its bins too wide.
  const least = Math.min(kEnoughBins, Math.ceil(Math.sqrt(sample.length)));
  return {low, high, count: Math.min(kMostBins, Math.max(least, width > 0 ? Math.ceil((high - low) / width) : 0))};
}

function countsOf(values, {low, high, count}) {
  const counts = new Array(count).fill(0);
  for (const v of values) ++counts[Math.min(count - 1, Math.floor(((v - low) / (high - low || 1)) * count))];
  return counts;
}

/// sets: [{name, values, failed}], of one quantity on common bins; the first is drawn as bars, those that failed on top of the others in their
/// colour, each further set as a line in its own.
export function histogram(name, unit, sets) {
  const samples = sets.map(({values}) => sorted(values)), all = sorted(samples.flatMap((sample) => [...sample])), grid = bins(all);
  const counts = samples.map((sample) => countsOf(sample, grid)), failures = countsOf(sorted(sets[0].failed), grid);
  const most = Math.max(...counts.flat());
  const scale = prefixed(unit, largestOf([all])), text = (v) => number(v * scale.factor, 3), inUnit = (v) => withUnit(v * scale.factor, scale.unit, 3);
  const note = `median ${text(percentile(samples[0], 0.5))}, 95 % below ${inUnit(percentile(samples[0], 0.95))}`;
  const canvas = element("canvas", {class: "histogram", role: "img", style: `height: ${kHeight}px`,
                                    "aria-label": `Histogram of ${name}: ${inUnit(all[0])} to ${inUnit(all[all.length - 1])}; ${sets[0].name}: ${note}`});
  const draw = () => {
    const ratio = window.devicePixelRatio, width = canvas.clientWidth;
    if (width === 0) return;
    canvas.width = width * ratio;
    canvas.height = kHeight * ratio;
    const context = canvas.getContext("2d"), step = canvas.width / grid.count, tall = (count) => (count / most) * (canvas.height - 2 * ratio);
    const bars = (list, paint) => {
      context.fillStyle = color(paint);
      list.forEach((count, i) => context.fillRect(i * step, canvas.height - tall(count), step - ratio, tall(count)));
    };
    bars(counts[0], "series-0");
    bars(failures, "bad");
    counts.slice(1).forEach((list, k) => {
      context.strokeStyle = seriesColor(k + 1);
      context.lineWidth = 1.6 * ratio;
      context.beginPath();
      list.forEach((count, i) => {
        context.lineTo(i * step, canvas.height - tall(count));
        context.lineTo((i + 1) * step, canvas.height - tall(count));
      });
      context.stroke();
    });
  };
  new ResizeObserver(draw).observe(canvas);
  onThemeChange(draw);
  return element("figure", {class: "plot"}, element("figcaption", {}, name.replaceAll("_", " "), element("span", {class: "note"}, note)), canvas,
                 element("p", {class: "ends"}, element("span", {}, inUnit(all[0])), element("span", {}, inUnit(all[all.length - 1]))));
}
