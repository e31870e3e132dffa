// A Monte Carlo sweep: how often it succeeded, where (a map over two quantities), and how each quantity is spread; of the controller, and of
// each baseline that ran in the same worlds (its columns are NAME.success and so on).
import {dataTable} from "./data_table.js";
import {download, element, whenSeen} from "./element.js";
import {number} from "./format.js";
import {bins, histogram} from "./histogram.js";
import {successInterval} from "./success_interval.js";
import {Table} from "./table.js";
import {color, onThemeChange} from "./theme.js";

const kMargin = {left: 74, right: 28, top: 10, bottom: 40};
const kCells = 12;  // of the map's rate of success, along each axis

const kController = "mpc";
const percent = (share) => `${(100 * share).toFixed(1)} %`;

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
    const {names} = this.table, baselines = names.filter((name) => name.endsWith(".success")).map((name) => name.slice(0, -".success".length));
    const select = (label, options, change) => element("select", {"aria-label": label, onchange: change}, ...options.map((name) => element("option", {}, name)));
    this.quantities = names.filter((name) => !name.includes(".") && !["success", "seed", "sample"].includes(name) && !this.table.isText(name));
    this.contestants = [kController, ...baselines].map((name) => this.figures(name));
    this.contestant = select("Controller", [kController, ...baselines], () => this.show());
    this.across = select("Across", this.quantities, () => this.draw());
    this.upward = select("Upward", this.quantities, () => this.draw());
    this.upward.selectedIndex = Math.min(1, this.quantities.length - 1);
    this.canvas = element("canvas", {class: "success-map", role: "img"});
    this.histograms = element("div", {class: "histograms"});
    this.failed = element("details");
    const csv = element("button", {type: "button", "aria-label": "Download as CSV", onclick: () => download(part.name, this.table.csv())}, "CSV");
    const [mpc] = this.contestants;
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title),
                        element("p", {class: "facts"}, `${mpc.successes} of ${mpc.n} succeeded: ${percent(mpc.successes / mpc.n)}, 95 % interval ${percent(mpc.interval[0])} to ${percent(mpc.interval[1])}`, csv),
                        ...(baselines.length > 0 ? [this.comparison()] : []),
                        element("p", {class: "facts"}, ...(baselines.length > 0 ? ["of ", this.contestant] : []), " across ", this.across, " upward ", this.upward), this.canvas,
                        element("p", {class: "keys"}, element("span", {class: "key"}, element("i", {style: "background: var(--good)"}), "succeeded"),
                                element("span", {class: "key"}, element("i", {style: "background: var(--bad)"}), "failed"), "tint: rate of success in a cell"),
                        this.histograms, this.failed);
    this.show();
    whenSeen(this.canvas, () => new ResizeObserver(() => this.draw()).observe(this.canvas));
    onThemeChange(() => this.draw());
  }

  /// The column of a quantity as a contestant has it: its own, or what was drawn for all.
  column(name, contestant = this.contestant.value) {
    const own = `${contestant}.${name}`;
    return this.table.has(own) ? own : name;
  }

  figures(name) {
    const success = this.table.numbers(this.column("success", name)), successes = success.reduce((sum, v) => sum + (v > 0), 0), n = success.length;
    return {name, success, successes, n, interval: successInterval(successes, n)};
  }

  /// One line for each contestant: the quantities that a baseline has of its own are what came of the runs.
  comparison() {
    const baseline = this.contestants[1].name, outcomes = this.quantities.filter((name) => this.table.has(`${baseline}.${name}`));
    const lines = this.contestants.map(({name, successes, n, interval}) => {
      const line = {name, rate: `${successes} of ${n}`, interval: `${percent(interval[0])} to ${percent(interval[1])}`};
      for (const quantity of outcomes) {
        const {median, p95} = bins(this.table.numbers(this.column(quantity, name)));
        line[quantity] = `${number(median, 3)} / ${number(p95, 3)}`;
      }
      return line;
    });
    return dataTable([["name", "controller"], ["rate", "succeeded"], ["interval", "95 % interval"],
                      ...outcomes.map((name) => [name, name.replaceAll("_", " ") + " (median / 95 % below)"])], lines, {label: "Controllers in the same worlds"});
  }

  /// What depends on whose runs are looked at.
  show() {
    const {success, successes, n} = this.contestants[this.contestant.selectedIndex];
    this.success = success;
    this.canvas.setAttribute("aria-label", `Successes and failures over two quantities; ${successes} of ${n} succeeded`);
    const failed = (values) => Array.from(values).filter((v, k) => !(success[k] > 0) && Number.isFinite(v));
    const spread = this.quantities.map((name) => [name, this.table.numbers(this.column(name))]).filter(([, values]) => values.some(Number.isFinite));
    this.histograms.replaceChildren(...spread.map(([name, values]) => histogram(name, values, failed(values))));
    const rows = Array.from({length: this.table.kept}, (_, k) => k).filter((k) => !(success[k] > 0));
    this.failed.replaceChildren(element("summary", {}, `Failures (${n - successes})`),
                                dataTable(this.table.names.map((name) => [name, name.replaceAll("_", " ")]),
                                          rows.map((k) => Object.fromEntries(this.table.names.map((name) => [name, this.table.cell(name, k)]))), {label: "Failures"}));
    this.draw();
  }

  draw() {
    const {canvas} = this, ratio = window.devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
    if (width === 0 || this.quantities.length === 0) return;
    canvas.width = width * ratio;
    canvas.height = height * ratio;
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const names = [this.across, this.upward].map((select) => this.quantities[select.selectedIndex]);
    const [x, y] = names.map((name) => this.table.numbers(this.column(name))), [x0, x1] = limits(x), [y0, y1] = limits(y);
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
