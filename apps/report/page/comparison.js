// A comparison of solvers: the table, and the performance profile over its problems where there are several.
import {dataTable} from "./data_table.js";
import {download, element} from "./element.js";
import {duration, number} from "./format.js";
import {performanceProfile, profileChart} from "./profile.js";
import {Table} from "./table.js";

const kSolved = new Set(["solved", "acceptable"]);
const kHeadings = {time_s: "time"};

function section(part, index, title, ...children) {
  const table = new Table(part);
  const csv = element("button", {type: "button", "aria-label": "Download as CSV", onclick: () => download(part.name, table.csv())}, "CSV");
  return element("section", {id: "part-" + index, "aria-label": title}, element("h2", {}, title), element("p", {class: "facts"}, part.name, csv), ...children);
}

export class Comparison {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = "Comparison";
    const {table} = this;
    this.rows = Array.from({length: table.kept}, (_, k) => Object.fromEntries(table.names.map((name) => [name, table.cell(name, k)])));
    this.solvers = [...new Set(this.rows.map((row) => row.solver))];
    this.problems = [...new Set(this.rows.map((row) => row.problem))];
    const fastest = new Map();
    for (const row of this.rows) {
      if (kSolved.has(row.status) && row.time_s < (fastest.get(row.problem) ?? Infinity)) fastest.set(row.problem, row.time_s);
    }
    const columns = table.names.map((name) => [name, kHeadings[name] ?? name.replaceAll("_", " "),
                                               name === "time_s" ? (v) => duration(v) : name === "objective" ? (v) => number(v, 9) : undefined]);
    this.place = element("div");
    this.node = section(part, index, this.title, this.summary(), this.place,
                        dataTable(columns, this.rows, {label: "Comparison", mark: (row, key) => key === "time_s" && this.solvers.length > 1 && row.time_s === fastest.get(row.problem) && kSolved.has(row.status)}));
    if (this.problems.length > 1) this.profile("time_s");
  }

  /// Who solved how many.
  summary() {
    const counts = this.solvers.map((solver) => `${solver} ${this.rows.filter((row) => row.solver === solver && kSolved.has(row.status)).length}`);
    return element("p", {class: "facts"}, `solved of ${this.problems.length}: ${counts.join(", ")}`);
  }

  profile(measure) {
    const byKey = new Map(this.rows.map((row) => [JSON.stringify([row.solver, row.problem]), row]));
    const measures = this.solvers.map((solver) => this.problems.map((problem) => {
      const row = byKey.get(JSON.stringify([solver, problem]));
      return row !== undefined && kSolved.has(row.status) ? Math.max(row[measure], Number.MIN_VALUE) : Infinity;
    }));
    const {tau, curves} = performanceProfile(measures);
    const choice = element("select", {"aria-label": "Measure", onchange: () => this.profile(choice.value)},
                           ...["time_s", "iterations"].filter((name) => this.table.has(name)).map((name) =>
                               element("option", {value: name, selected: name === measure}, kHeadings[name] ?? name)));
    this.plots = [];
    this.place.replaceChildren(element("p", {class: "facts"}, "performance profile by ", choice),
                               profileChart(this.solvers, tau, curves, (plot) => this.plots.push({plot})));
  }
}

/// Profiles that were computed already: for each cost the rows ratio and, for each solver, the share solved within it.
export class Profile {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = "Performance profile";
    const {texts: costs, codes} = this.table.texts("cost"), names = this.table.names.filter((name) => name !== "cost" && name !== "ratio");
    const charts = costs.map((cost, i) => {
      const of = (name) => Array.from(this.table.numbers(name)).filter((_, k) => codes[k] === i);
      return element("div", {}, element("h3", {}, `By ${cost}`), profileChart(names, of("ratio"), names.map(of), (plot) => this.plots.push({plot})));
    });
    this.node = section(part, index, this.title, element("div", {class: "two"}, ...charts));
  }
}
