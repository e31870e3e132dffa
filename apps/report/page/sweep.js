// A Monte Carlo sweep: how often it succeeded (with Wilson's interval), where (a map over two parameters), and how each quantity is spread.
//
//     (p + z^2/2n +- z sqrt(p(1-p)/n + z^2/4n^2)) / (1 + z^2/n)        z = 1.96 for 95 %
import {dataTable} from "./data_table.js";
import {download, element, whenSeen} from "./element.js";
import {number} from "./format.js";
import {histogram} from "./histogram.js";
import {Table} from "./table.js";
import {color, onThemeChange} from "./theme.js";

const kMargin = {left: 74, right: 28, top: 10, bottom: 40};
const kCells = 12;  // of the map's rate of success, along each axis

export function wilson(successes, n, z = 1.96) {
  const p = successes / n, middle = p + (z * z) / (2 * n), half = z * Math.sqrt((p * (1 - p)) / n + (z * z) / (4 * n * n));
  return [middle - half, middle + half].map((bound) => bound / (1 + (z * z) / n));
}

function limits(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
  return high > low ? [low, high] : [low - 0.5, high + 0.5];
}

export class Sweep {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = "Sweep";
    this.success = this.table.numbers("success");
    this.quantities = this.table.names.filter((name) => !["success", "seed", "sample"].includes(name) && !this.table.isText(name));
    const n = this.success.length, successes = this.success.reduce((sum, v) => sum + (v > 0), 0), [low, high] = wilson(successes, n);
    const percent = (share) => `${(100 * share).toFixed(1)} %`;
    const chooser = (label, k) => {
      const select = element("select", {"aria-label": label, onchange: () => this.draw()}, ...this.quantities.map((name) => element("option", {}, name)));
      select.selectedIndex = Math.min(k, this.quantities.length - 1);
      return select;
    };
    this.across = chooser("Across", 0);
    this.upward = chooser("Upward", 1);
    this.canvas = element("canvas", {class: "success-map", role: "img", "aria-label": `Successes and failures over two quantities; ${successes} of ${n} succeeded`});
    const csv = element("button", {type: "button", "aria-label": "Download as CSV", onclick: () => download(part.name, this.table.csv())}, "CSV");
    const failed = (name) => Array.from(this.table.numbers(name)).filter((v, k) => !(this.success[k] > 0) && Number.isFinite(v));
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title),
                        element("p", {class: "facts"}, `${successes} of ${n} succeeded: ${percent(successes / n)}, 95 % interval ${percent(low)} to ${percent(high)}`, csv),
                        element("p", {class: "facts"}, "across ", this.across, " upward ", this.upward), this.canvas,
                        element("p", {class: "keys"}, element("span", {class: "key"}, element("i", {style: "background: var(--good)"}), "succeeded"),
                                element("span", {class: "key"}, element("i", {style: "background: var(--bad)"}), "failed"), "tint: rate of success in a cell"),
                        element("div", {class: "histograms"}, ...this.quantities.map((name) => histogram(name, this.table.numbers(name), failed(name)))),
                        element("details", {}, element("summary", {}, `Failures (${n - successes})`), this.failures()));
    whenSeen(this.canvas, () => new ResizeObserver(() => this.draw()).observe(this.canvas));
    onThemeChange(() => this.draw());
  }

  failures() {
    const rows = Array.from({length: this.table.kept}, (_, k) => k).filter((k) => !(this.success[k] > 0));
    return dataTable(this.table.names.map((name) => [name, name.replaceAll("_", " ")]),
                     rows.map((k) => Object.fromEntries(this.table.names.map((name) => [name, this.table.cell(name, k)]))), {label: "Failures"});
  }

  draw() {
    const {canvas} = this, ratio = window.devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0 || this.quantities.length === 0) return;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const names = [this.across, this.upward].map((select) => this.quantities[select.selectedIndex]);
    const [x, y] = names.map((name) => this.table.numbers(name)), [x0, x1] = limits(x), [y0, y1] = limits(y);
    const inner = {width: width - kMargin.left - kMargin.right, height: height - kMargin.top - kMargin.bottom};
    const shareX = (v) => (v - x0) / (x1 - x0), shareY = (v) => (v - y0) / (y1 - y0);
    const toX = (share) => kMargin.left + share * inner.width, toY = (share) => kMargin.top + (1 - share) * inner.height;

    // Cells: success as colour, confidence as strength.
    const good = new Float64Array(kCells * kCells), all = new Float64Array(kCells * kCells);
    const cell = (share) => Math.min(kCells - 1, Math.max(0, Math.floor(share * kCells)));
    for (let k = 0; k < x.length; ++k) {
      if (!Number.isFinite(x[k]) || !Number.isFinite(y[k])) continue;
      const at = cell(shareY(y[k])) * kCells + cell(shareX(x[k]));
      ++all[at];
      good[at] += this.success[k] > 0 ? 1 : 0;
    }
    for (let at = 0; at < all.length; ++at) {
      if (all[at] === 0) continue;
      const column = at % kCells, row = Math.floor(at / kCells);
      const box = [toX(column / kCells), toY((row + 1) / kCells), inner.width / kCells, inner.height / kCells];
      for (const [name, rate] of [["good", good[at] / all[at]], ["bad", 1 - good[at] / all[at]]]) {
        context.globalAlpha = 0.22 * rate;
        context.fillStyle = color(name);
        context.fillRect(...box);
      }
    }
    const radius = x.length > 3000 ? 1.2 : 2.2;
    context.globalAlpha = x.length > 3000 ? 0.5 : 0.8;
    for (const wanted of [true, false]) {  // failures on top
      context.fillStyle = color(wanted ? "good" : "bad");
      for (let k = 0; k < x.length; ++k) {
        if (this.success[k] > 0 !== wanted || !Number.isFinite(x[k]) || !Number.isFinite(y[k])) continue;
        context.beginPath();
        context.arc(toX(shareX(x[k])), toY(shareY(y[k])), wanted ? radius : 1.3 * radius, 0, 2 * Math.PI);
        context.fill();
      }
    }
    context.globalAlpha = 1;
    context.strokeStyle = color("grid");
    context.strokeRect(kMargin.left, kMargin.top, inner.width, inner.height);
    context.fillStyle = color("muted");
    context.font = "11px system-ui, sans-serif";
    context.textAlign = "center";
    for (let i = 0; i <= 4; ++i) context.fillText(number(x0 + ((x1 - x0) * i) / 4, 3), toX(i / 4), height - 22);
    context.fillText(names[0], toX(0.5), height - 6);
    context.textAlign = "right";
    for (let i = 0; i <= 4; ++i) context.fillText(number(y0 + ((y1 - y0) * i) / 4, 3), kMargin.left - 6, toY(i / 4) + 4);
    context.save();
    context.translate(12, toY(0.5));
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(names[1], 0, 0);
    context.restore();
  }
}
