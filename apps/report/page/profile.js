// A performance profile [Dolan and More, 2002]: the share of problems that a solver solves within a factor tau of the best.
//
//     r_ps = m_ps / min_s m_ps        rho_s(tau) = |{p : r_ps <= tau}| / |P|        m: time or iterations, infinite where not solved
import uPlot from "uplot";
import {element, whenSeen} from "./element.js";
import {number} from "./format.js";
import {axis} from "./plots.js";
import {kSeriesColors, onThemeChange, seriesColor} from "./theme.js";

const kHeight = 280;

/// {tau, curves: [[rho, ...], ...]} of measures[solver][problem].
export function performanceProfile(measures) {
  const problems = measures[0].length;
  const best = Array.from({length: problems}, (_, p) => Math.min(...measures.map((m) => m[p])));
  const ratios = measures.map((m) => m.map((value, p) => (Number.isFinite(value) ? Math.max(1, value / best[p]) : Infinity)));
  const finite = ratios.flat().filter(Number.isFinite);
  const tau = [...new Set([1, ...finite, 1.1 * Math.max(1, ...finite)])].sort((a, b) => a - b);
  const curves = ratios.map((list) => {
    const sorted = [...list].sort((a, b) => a - b);
    let n = 0;
    return tau.map((limit) => {
      while (n < sorted.length && sorted[n] <= limit) ++n;
      return n / problems;
    });
  });
  return {tau, curves};
}

/// Draws step curves over log2 tau.
export function profileChart(names, tau, curves, made) {
  const frame = element("div", {class: "frame", style: `min-height: ${kHeight}px`});
  whenSeen(frame, () => {
    const plot = new uPlot({
      width: Math.max(200, frame.clientWidth), height: kHeight, legend: {markers: {width: 0, fill: (_, i) => `var(--series-${(i - 1) % kSeriesColors})`}}, cursor: {drag: {x: true, y: false}},
      scales: {x: {time: false}, y: {range: [0, 1.03]}},
      axes: [axis({size: 40, label: "within this factor of the best", labelSize: 16, labelFont: "11px system-ui, sans-serif",
                   values: (_, splits) => splits.map((v) => number(2 ** v, 3))}),
             axis({size: 48, values: (_, splits) => splits.map((v) => `${Math.round(100 * v)} %`)})],
      series: [{label: "factor", value: (_, v) => (v === null ? "" : number(2 ** v, 4))}, ...names.map((name, k) => ({
        label: name, stroke: () => seriesColor(k), width: 2, points: {show: false}, paths: uPlot.paths.stepped({align: 1}),
        value: (_, v) => (v === null || v === undefined ? "–" : `${(100 * v).toFixed(1)} %`),
      }))],
      hooks: {ready: [(u) => u.setLegend({idx: tau.length - 1}, false)]},
    }, [tau.map(Math.log2), ...curves], frame);
    new ResizeObserver(() => frame.clientWidth > 0 && plot.setSize({width: frame.clientWidth, height: kHeight})).observe(frame);
    onThemeChange(() => plot.redraw(false));
    made(plot);
  });
  return element("figure", {class: "plot", role: "group", "aria-label": "Performance profile: " + names.join(", ")},
                 element("figcaption", {}, "Share of problems solved"), frame);
}
