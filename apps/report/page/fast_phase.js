// Fast phases in their own time: a collision that takes no time of the scene, drawn over the time tau that it has for itself.
//
// The table has the columns t and contact of the collision, tau (s) and whatever was recorded over it.
import uPlot from "uplot";
import {element, whenSeen} from "./element.js";
import {duration, number, prefixed} from "./format.js";
import {axis} from "./plots.js";
import {onThemeChange, seriesColor} from "./theme.js";
import {largestOf, shownUnit, unitOf} from "./units.js";

const kMost = 12;  // pictures

/// The rows of each collision: those that follow one another with the same t and contact, tau rising.
function phasesOf(table) {
  const t = table.numbers("t"), tau = table.numbers("tau"), phases = [];
  for (let k = 0; k < table.kept; ++k) {
    const goesOn = k > 0 && t[k] === t[k - 1] && tau[k] > tau[k - 1] && table.cell("contact", k) === table.cell("contact", k - 1);
    if (goesOn) phases[phases.length - 1].push(k);
    else phases.push([k]);
  }
  return phases;
}

function picture(table, rows, name, k, unitOfTime) {
  const frame = element("div", {class: "frame", style: "min-height: 120px"});
  const {unit, factor} = prefixed(unitOf(name), largestOf([table.numbers(name)]));
  whenSeen(frame, () => {
    const values = table.numbers(name), tau = table.numbers("tau");
    const plot = new uPlot({
      width: Math.max(160, frame.clientWidth), height: 120, pxAlign: false, legend: {show: false}, cursor: {y: false, points: {size: 5}}, scales: {x: {time: false}},
      axes: [axis({size: 24, values: (_, splits) => splits.map((v) => number(v, 3))}), axis({size: 52, values: (_, splits) => splits.map((v) => number(v * factor, 3))})],
      series: [{}, {label: name, stroke: () => seriesColor(k), width: 1.4, points: {show: false}}],
    }, [rows.map((k) => tau[k] / unitOfTime), rows.map((k) => values[k])], frame);
    onThemeChange(() => plot.redraw(false));
  });
  const caption = element("figcaption", {}, name.replaceAll("_", " "), unit ? element("span", {class: "unit"}, shownUnit(unit)) : undefined);
  return element("figure", {class: "plot", "aria-label": `${name} over the collision's own time`}, caption, frame);
}

export function fastPhases(table) {
  const node = element("div", {class: "fast"}, element("h3", {}, "Fast phases, in their own time"));
  const names = table.names.filter((name) => !["t", "contact", "tau"].includes(name));
  const phases = phasesOf(table);
  for (const rows of phases.slice(0, kMost)) {
    const length = table.numbers("tau")[rows[rows.length - 1]];
    const unitOfTime = 1000 ** Math.floor(Math.log10(length || 1) / 3), unit = {1: "s", 1e-3: "ms", 1e-6: "µs", 1e-9: "ns"}[Number(unitOfTime.toPrecision(3))] ?? "";
    node.append(element("div", {class: "phase"}, element("h4", {}, `${number(table.numbers("t")[rows[0]], 7)} s: ${table.cell("contact", rows[0])}, lasting ${duration(length)}; τ in ${unit}`),
                        element("div", {class: "row"}, ...names.map((name, k) => picture(table, rows, name, k, unitOfTime)))));
  }
  if (phases.length > kMost) node.append(element("p", {class: "facts"}, `the first ${kMost} of ${phases.length}`));
  return node;
}
