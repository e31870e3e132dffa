// A Monte Carlo sweep: how often it succeeded, where (a map over two quantities), and how each quantity is spread; of the controller, and of
// each baseline that ran in the same worlds (its columns are NAME.success and so on).
import {dataTable} from "./data_table.js";
import {download, element, whenSeen} from "./element.js";
import {number, prefixed} from "./format.js";
import {histogram} from "./histogram.js";
import {percentile, sorted} from "./statistics.js";
import {successInterval} from "./success_interval.js";
import {drawSuccessMap, makeSuccessMap} from "./success_map.js";
import {Table} from "./table.js";
import {onThemeChange} from "./theme.js";
import {largestOf, unitOf} from "./units.js";

const kController = "mpc";
const kOfTheSolver = ["steps", "iterations", "fallbacks"];  // no matter of comparison
const percent = (share) => `${(100 * share).toFixed(1)} %`;
const readable = (name) => name.replaceAll("_", " ");

export class Sweep {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = "Sweep";
    const {names} = this.table, baselines = names.filter((name) => name.endsWith(".success")).map((name) => name.slice(0, -".success".length));
    const isQuantity = (name) => !name.includes(".") && !["success", "seed", "sample"].includes(name) && !this.table.isText(name);
    this.quantities = names.filter(isQuantity);
    this.contestants = [kController, ...baselines].map((name) => this.figures(name));
    this.varying = this.quantities.filter((name) => new Set(sorted(this.all(name).flatMap((values) => [...values]))).size > 1);
    const [{successes, n, interval}] = this.contestants, save = () => download(part.name, this.table.csv());
    const facts = `${successes} of ${n} succeeded: ${percent(successes / n)}, 95 % interval ${percent(interval[0])} to ${percent(interval[1])}`;
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title),
                        element("p", {class: "facts"}, facts, element("button", {type: "button", "aria-label": "Download as CSV", onclick: save}, "CSV")),
                        ...(baselines.length > 0 ? [this.comparison()] : []), ...this.maps(), ...this.histograms(),
                        ...this.contestants.map((one) => this.failures(one)));
    onThemeChange(() => this.draw());
  }

  /// The values of a quantity as a contestant has it: its own, or what was drawn for all.
  values(quantity, contestant = kController) {
    const own = `${contestant}.${quantity}`;
    return this.table.numbers(this.table.has(own) ? own : quantity);
  }

  /// Of every contestant.
  all(quantity) {
    return this.contestants.map(({name}) => this.values(quantity, name));
  }

  figures(name) {
    const success = this.values("success", name), successes = success.reduce((sum, v) => sum + (v > 0), 0), n = success.length;
    return {name, success, successes, n, interval: successInterval(successes, n)};
  }

  /// One line for each contestant: the quantities that a baseline has of its own are what came of the runs.
  comparison() {
    const baseline = this.contestants[1].name;
    const outcomes = this.varying.filter((name) => this.table.has(`${baseline}.${name}`) && !kOfTheSolver.includes(name));
    const scales = new Map(outcomes.map((name) => [name, prefixed(unitOf(name), largestOf(this.all(name)))]));
    const lines = this.contestants.map(({name, successes, n, interval}) => {
      const line = {name, rate: `${successes} of ${n}`, interval: `${percent(interval[0])} to ${percent(interval[1])}`};
      for (const quantity of outcomes) {
        const sample = sorted(this.values(quantity, name));
        line[quantity] = [0.5, 0.95].map((share) => number(percentile(sample, share) * scales.get(quantity).factor, 3)).join(" / ");
      }
      return line;
    });
    const heading = (name) => readable(name) + (scales.get(name).unit ? `, ${scales.get(name).unit}` : "");
    const columns = [["name", "controller"], ["rate", "succeeded"], ["interval", "95 % interval"], ...outcomes.map((name) => [name, heading(name)])];
    return element("div", {}, dataTable(columns, lines, {label: "Controllers in the same worlds"}),
                   element("p", {class: "keys"}, "In the same worlds; a / b: the median is a, 95 % lie at or below b."));
  }

  maps() {
    const options = () => this.varying.map((name) => element("option", {}, name));
    const select = (label) => element("select", {"aria-label": label, onchange: () => this.draw()}, ...options());
    this.across = select("Across");
    this.upward = select("Upward");
    this.upward.selectedIndex = Math.min(1, this.varying.length - 1);
    const seeds = this.table.numbers("seed");
    for (const one of this.contestants) {
      const rate = `${one.successes} of ${one.n}`;
      one.note = element("span", {class: "note"}, rate);
      one.canvas = makeSuccessMap(`Successes and failures of ${one.name} over two quantities; ${rate} succeeded`, (k) => {
        one.note.textContent = k === undefined || !seeds ? rate : `--seed ${seeds[k]}: ${one.success[k] > 0 ? "succeeded" : "failed"}`;
      });
      whenSeen(one.canvas, () => new ResizeObserver(() => this.draw(one)).observe(one.canvas));
    }
    const key = (role, text) => element("span", {class: "key"}, element("i", {style: `background: var(--${role})`}), text);
    return [element("h3", {}, "Where"), element("p", {class: "facts"}, "across ", this.across, " upward ", this.upward),
            element("div", {class: "maps"}, ...this.contestants.map(({name, note, canvas}) =>
                element("figure", {class: "plot"}, element("figcaption", {}, name, note), canvas))),
            element("p", {class: "keys"}, key("good", "succeeded"), key("bad", "failed"), "tint: rate of success in a cell; a dot tells its seed to the pointer")];
  }

  draw(only) {
    const names = [this.across, this.upward].map((select) => this.varying[select.selectedIndex]);
    if (names.includes(undefined)) return;
    for (const one of only ? [only] : this.contestants) {
      const [x, y] = names.map((name) => ({name, values: this.values(name, one.name), all: this.all(name).flatMap((values) => [...values])}));
      drawSuccessMap(one.canvas, x, y, one.success);
    }
  }

  /// What was drawn stands before the success in a record, what came of it behind.
  histograms() {
    const {names} = this.table, isDrawn = (name) => names.indexOf(name) < names.indexOf("success");
    const constants = this.quantities.filter((name) => !this.varying.includes(name) && Number.isFinite(this.values(name)[0]));
    const failed = (values, success) => Array.from(values).filter((v, k) => !(success[k] > 0));
    const one = (name) => {
      const own = this.contestants.filter((c, i) => i === 0 || (this.table.has(`${c.name}.${name}`) && !kOfTheSolver.includes(name)));
      return histogram(name, unitOf(name), own.map((c) => {
        const values = this.values(name, c.name);
        return {name: c.name, values, failed: failed(values, c.success)};
      }));
    };
    const group = (title, list, ...more) =>
        (list.length === 0 ? [] : [element("h3", {}, title), ...more, element("div", {class: "histograms"}, ...list.map(one))]);
    const sample = (shape, role, text) => element("span", {class: "key"}, element("i", {class: shape, style: `background: var(--${role})`}), text);
    const [{successes, n}] = this.contestants, bad = successes < n ? [sample(undefined, "bad", `failed (${kController})`)] : [];
    const key = element("p", {class: "keys"}, ...this.contestants.map(({name}, i) => sample(i > 0 ? "arrow-key" : undefined, `series-${i}`, name)), ...bad);
    const same = constants.map((name) => `${readable(name)} ${number(this.values(name)[0], 4)}`).join(", ");
    return [...group("What came of it", this.varying.filter((name) => !isDrawn(name)), key), ...group("What was drawn", this.varying.filter(isDrawn)),
            ...(same ? [element("p", {class: "facts"}, `The same in all runs: ${same}.`)] : [])];
  }

  failures({name, success, successes, n}) {
    const {table} = this, rows = Array.from({length: table.kept}, (_, k) => k).filter((k) => !(success[k] > 0));
    // A baseline's own columns in place of the controller's.
    const columns = table.names.filter((column) => (column.includes(".") ? column.startsWith(name + ".") : !table.has(`${name}.${column}`)));
    const details = element("details", {}, element("summary", {}, `Failures of ${name} (${n - successes})`));
    details.addEventListener("toggle", () => {
      const lines = rows.map((k) => Object.fromEntries(columns.map((column) => [column, table.cell(column, k)])));
      if (details.children.length === 1) details.append(dataTable(columns.map((column) => [column, readable(column)]), lines, {label: `Failures of ${name}`}));
    }, {once: true});
    return details;
  }
}
