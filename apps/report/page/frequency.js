// Quantities over frequency, both axes logarithmic: what a grasped part feels of the robot, |F/v|, with the tactile loop off and on.
import uPlot from "uplot";
import {download, element, whenSeen} from "./element.js";
import {number} from "./format.js";
import {logAxis} from "./plots.js";
import {Table} from "./table.js";
import {kSeriesColors, onThemeChange, seriesColor} from "./theme.js";

const kHeight = 360;

export class FrequencyResponse {
  constructor(part, index) {
    const table = new Table(part), names = table.names.filter((name) => name !== "frequency" && !table.isText(name));
    this.title = "Frequency response";
    this.plots = [];
    const frame = element("div", {class: "frame", style: `min-height: ${kHeight}px`});
    whenSeen(frame, () => {
      const plot = new uPlot({
        width: Math.max(200, frame.clientWidth), height: kHeight, cursor: {drag: {x: true, y: false}},
        legend: {markers: {width: 0, fill: (_, i) => `var(--series-${(i - 1) % kSeriesColors})`}},
        scales: {x: {time: false, distr: 3}, y: {distr: 3}},
        axes: [logAxis({size: 40, label: "frequency, Hz", labelSize: 16, labelFont: "11px system-ui, sans-serif"}), logAxis({size: 58})],
        series: [{label: "frequency", value: (_, v) => (v === null ? "" : number(v, 4))}, ...names.map((name, k) => ({
          label: name.replaceAll("_", " "), stroke: () => seriesColor(k), width: 2, points: {show: false},
          value: (_, v) => (v === null || v === undefined ? "–" : number(v, 4)),
        }))],
      }, [table.numbers("frequency"), ...names.map((name) => Array.from(table.numbers(name), (v) => (v > 0 ? v : null)))], frame);
      new ResizeObserver(() => frame.clientWidth > 0 && plot.setSize({width: frame.clientWidth, height: kHeight})).observe(frame);
      onThemeChange(() => plot.redraw(false));
      this.plots.push(plot);
    });
    const csv = element("button", {type: "button", "aria-label": "Download as CSV", onclick: () => download(part.name, table.csv())}, "CSV");
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title), element("p", {class: "facts"}, `${table.kept} frequencies `, csv),
                        element("figure", {class: "plot", role: "group", "aria-label": "Over frequency: " + names.join(", ")}, frame));
  }
}
