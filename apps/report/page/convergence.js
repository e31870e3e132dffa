// A solve, iteration by iteration: residuals and barrier parameter on a logarithmic axis, the objective, and the table.
import uPlot from "uplot";
import {dataTable} from "./data_table.js";
import {download, element, whenSeen} from "./element.js";
import {number} from "./format.js";
import {axis, logAxis} from "./plots.js";
import {Table} from "./table.js";
import {onThemeChange, seriesColor} from "./theme.js";

const kHeight = 230;
const kMeasures = [["primal", 0], ["dual", 1], ["complementarity", 2], ["mu", 3]];
const kColumns = [["index", "iteration"], ["objective", "objective"], ["primal", "primal"], ["dual", "dual"], ["complementarity", "complementarity"],
                  ["mu", "μ"], ["alpha_primal", "α primal"], ["alpha_dual", "α dual"], ["regularization", "regularization"], ["trials", "trials"]];

function chart(frame, series, data, logarithmic) {
  const plot = new uPlot({
    width: Math.max(200, frame.clientWidth), height: kHeight, pxAlign: false, legend: {markers: {width: 0, fill: (u, i) => `var(--series-${u.series[i].color})`}}, cursor: {sync: {key: "iterations"}, drag: {x: true, y: false}},
    scales: {x: {time: false}, y: logarithmic ? {distr: 3} : {}},
    axes: [axis({size: 26}), logarithmic ? logAxis({size: 62}) : axis({size: 62, values: (_, splits) => splits.map((v) => number(v, 6))})],
    series: [{label: "iteration", value: (_, v) => number(v)}, ...series],
    hooks: {ready: [(u) => u.setLegend({idx: data[0].length - 1}, false)]},
  }, data, frame);
  new ResizeObserver(() => frame.clientWidth > 0 && plot.setSize({width: frame.clientWidth, height: kHeight})).observe(frame);
  onThemeChange(() => plot.redraw(false));
  return plot;
}

function line(label, k) {
  return {label, color: k, stroke: () => seriesColor(k), width: 1.6, points: {show: true, size: 4, fill: () => seriesColor(k)}, value: (_, v) => number(v, 4)};
}

export class Convergence {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = `Convergence: ${part.name}`;
    const rows = this.table.has("row") ? [...new Set(this.table.numbers("row"))] : [undefined];
    this.place = element("div");
    const choice = element("select", {"aria-label": "Row", onchange: () => this.show(rows[choice.selectedIndex])},
                           ...rows.map((row) => element("option", {}, `row ${row}`)));
    const csv = element("button", {type: "button", "aria-label": "Download the iterations as CSV",
                                   onclick: () => download(part.name.replace(/\.[^.]*$/, "") + ".csv", this.table.csv())}, "CSV");
    const note = this.table.kept < this.table.rows ? `${this.table.kept} of ${this.table.rows} iterations: the rows that took most` : `${this.table.rows} iterations`;
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title),
                        element("p", {class: "facts"}, note, rows.length > 1 ? choice : "", csv), this.place);
    this.show(rows[0]);
  }

  show(row) {
    const {table} = this, of = table.has("row") ? table.numbers("row") : undefined;
    const chosen = Array.from({length: table.kept}, (_, k) => k).filter((k) => of === undefined || of[k] === row);
    const column = (name) => chosen.map((k) => table.numbers(name)[k]);
    const positive = (name) => column(name).map((v) => (v > 0 ? v : null));
    const measures = kMeasures.filter(([name]) => positive(name).some((v) => v !== null));
    const frame = () => element("div", {class: "frame", style: `min-height: ${kHeight}px`});
    const residuals = frame(), objective = frame();
    this.plots = [];
    this.place.replaceChildren(
        element("div", {class: "two"},
                element("figure", {class: "plot", "aria-label": "Residuals over the iterations"}, element("figcaption", {}, "Residuals and barrier"), residuals),
                element("figure", {class: "plot", "aria-label": "Objective over the iterations"}, element("figcaption", {}, "Objective"), objective)),
        dataTable(kColumns, chosen.map((k) => Object.fromEntries(kColumns.map(([name]) => [name, table.numbers(name)[k]]))), {label: "Iterations"}));
    whenSeen(residuals, () => {
      this.plots.push({plot: chart(residuals, measures.map(([name, k]) => line(name, k)), [column("index"), ...measures.map(([name]) => positive(name))], true)});
      this.plots.push({plot: chart(objective, [line("objective", 4)], [column("index"), column("objective")], false)});
    });
  }
}
