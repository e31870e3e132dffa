// The plots of one record: a common cursor, a common zoom in time, a line at the clock's time, bands where a mode holds, marks at events.
import uPlot from "uplot";
import {element, whenSeen} from "./element.js";
import {number, prefixed} from "./format.js";
import {kOther} from "./groups.js";
import {bandPlugin, lanesOf, lanesPlugin, laneHeight} from "./modes.js";
import {bandRange, confidencePlugin, eventsPlugin, foreseenRange, foresightPlugin, limitsPlugin} from "./overlays.js";
import {lastRowAt} from "./table.js";
import {color, kSeriesColors, onThemeChange, seriesColor} from "./theme.js";
import {tickTexts} from "./ticks.js";
import {largestOf, shownUnit} from "./units.js";

const kHeight = 158;
const kRounding = 1e-10;  // values that differ by less are drawn as one
const kBesideMost = 8;   // letters of a lane's name that have room beside it
const kLegendMost = 12;  // beyond, a legend says less than the picture

/// Of the quantities that are no part of the scene, positive values over more than four decades are read on a logarithmic axis.
function isWide(arrays) {
  let low = Infinity, high = 0;
  for (const values of arrays) {
    for (const v of values) {
      if (v < 0) return false;
      if (v > 0) {
        low = Math.min(low, v);
        high = Math.max(high, v);
      }
    }
  }
  return high > 1e4 * low;
}

export function axis(extra = {}) {
  return {
    stroke: () => color("muted"), font: "11px system-ui, sans-serif", grid: {stroke: () => color("grid"), width: 1},
    ticks: {stroke: () => color("grid"), width: 1, size: 4}, gap: 4, ...extra,
  };
}

/// A logarithmic axis with lines at powers of ten, at most seven of them.
export function logAxis(extra = {}) {
  const splits = (u, index, low, high) => {
    const first = Math.ceil(Math.log10(low) - 1e-9), last = Math.floor(Math.log10(high) + 1e-9), step = Math.ceil((last - first + 1) / 7);
    return Array.from({length: Math.max(0, Math.floor((last - first) / step) + 1)}, (_, i) => 10 ** (first + i * step));
  };
  return axis({...extra, splits, values: (_, powers) => powers.map((v) => number(v, 4)), filter: (_, powers) => powers});
}

const kLabelSize = 58;

const labels = (factor = 1) => ({size: kLabelSize, values: (_, splits) => tickTexts(splits, factor, 4)});

export class Plots {
  /// `groups` as groups.js makes them; `events` [{t, text}].
  constructor(table, timeName, groups, clock, events) {
    Object.assign(this, {table, clock, events, groups});
    this.time = table.numbers(timeName);
    this.plots = [];
    this.sync = uPlot.sync("record-" + Plots.count++);
    this.lanes = lanesOf(table);
    this.zoom = [clock.start, clock.end];
    this.node = element("div", {class: "plots"});
    for (const group of groups.filter((group) => !group.folded)) this.node.append(this.placeFor(group));
    this.addFold(groups.filter((group) => group.folded));
    clock.listen(() => {
      for (const {plot, group} of this.plots) if (group.foresights) plot.redraw(false);
      this.placeHeads();
    });
    onThemeChange(() => this.plots.forEach(({plot}) => plot.redraw(false)));
  }

  addFold(groups) {
    if (groups.length === 0) return;
    const names = groups.flatMap((group) => group.columns);
    const summary = element("summary", {}, `More curves (${names.length})`);
    this.node.append(element("details", {class: "plots"}, summary, ...groups.map((group) => this.placeFor(group))));
  }

  /// Where a plot will be, once it is seen.
  placeFor(group) {
    const isModes = group.rank === 0;
    const lanes = this.lanes.filter((lane) => group.columns.includes(lane.column));
    const height = isModes ? laneHeight(lanes) + 36 : kHeight;
    const arrays = isModes ? [] : group.columns.map((name) => this.table.numbers(name));
    const logarithmic = group.rank >= kOther && isWide(arrays);
    const scale = prefixed(group.unit, logarithmic ? 1 : largestOf(arrays));
    const unit = scale.unit ? element("span", {class: "unit"}, shownUnit(scale.unit)) : undefined;
    const frame = element("div", {class: "frame", style: `min-height: ${height}px`});
    const names = `${group.title}${scale.unit ? " in " + scale.unit : ""} over time: ${group.columns.slice(0, kLegendMost).join(", ")}`;
    const figure = element("figure", {class: "plot", role: "group", "aria-label": names}, element("figcaption", {}, group.title, unit), frame);
    whenSeen(figure, () => (isModes ? this.makeLanes(group, frame, height, lanes) : this.makeCurves(group, frame, height, arrays, {logarithmic, factor: scale.factor})));
    return figure;
  }

  makeCurves(group, frame, height, arrays, {logarithmic, factor}) {
    const many = group.columns.length > kLegendMost;
    const held = [...(group.limits ?? []), ...foreseenRange(group.foresights, this.table), ...bandRange(group.bands, this.table)];
    this.add(group, frame, {
      height,
      legend: {show: !many, markers: {width: 0, fill: (_, i) => `var(--series-${(i - 1) % kSeriesColors})`}},
      scales: {x: this.timeScale(), y: logarithmic ? {distr: 3} : this.valueScale(held)},
      axes: [axis({size: 26}), logarithmic ? logAxis({size: kLabelSize}) : axis(labels(factor))],
      series: [{}, ...group.columns.map((name, i) => ({
        label: name, stroke: () => seriesColor(i), width: many ? 0.75 : 1.4, points: {show: false},
        value: (_, v) => number(v === null ? v : v * factor, 5),
      }))],
      plugins: [bandPlugin(group.bands ? [] : this.lanes, this.time),
                confidencePlugin(group.bands, this.table, this.time, (name) => seriesColor(group.columns.indexOf(name))),
                limitsPlugin(group.limits), foresightPlugin(group.foresights, this.table, this.time, this.clock), eventsPlugin(this.events)],
      // A logarithmic axis has no place for 0: the line has a gap there.
    }, logarithmic ? arrays.map((values) => Array.from(values, (v) => (v > 0 ? v : null))) : arrays);
  }

  makeLanes(group, frame, height, lanes) {
    const names = lanes.map(({name}) => name.replaceAll("_", " ")), beside = names.every((name) => name.length <= kBesideMost);
    this.add(group, frame, {
      height,
      legend: {show: false},
      scales: {x: this.timeScale(), y: {range: [0, lanes.length]}},
      axes: [axis({size: 26}), axis({size: kLabelSize, grid: {show: false}, ticks: {show: false}, values: () => (beside ? names : names.map(() => "")),
                                     splits: () => names.map((_, i) => names.length - i - 0.5)})],
      series: [{}, {show: false}],
      plugins: [lanesPlugin(lanes, this.time, beside ? [] : names), eventsPlugin(this.events)],
    }, [new Float64Array(this.time.length)]);
  }

  /// Makes a plot with what all have in common: cursor, zoom, and a click that sets the clock.
  add(group, frame, options, values) {
    const plot = new uPlot({
      ...options, width: Math.max(200, frame.clientWidth), pxAlign: false, padding: [8, 16, 0, 0],
      cursor: {
        sync: {key: this.sync.key, setSeries: false}, drag: {x: true, y: false, setScale: true, dist: 6}, points: {size: 5},
        bind: {click: (u, _, handler) => (event) => {
          handler(event);
          if (u.cursor.left >= 0 && !u.dragged) this.clock.go(u.posToVal(u.cursor.left, "x"));
        }},
      },
      hooks: {setScale: [(u, key) => key === "x" && this.zoomed(u)], setSelect: [(u) => (u.dragged = u.select.width > 0)]},
    }, [this.time, ...values], frame);
    plot.over.addEventListener("mousedown", () => (plot.dragged = false));
    plot.over.addEventListener("mouseleave", () => queueMicrotask(() => this.placeHeads()));
    const head = element("div", {class: "head"});
    plot.over.append(head);
    this.plots.push({plot, head, group});
    new ResizeObserver(() => {
      if (frame.clientWidth > 0 && frame.clientWidth !== plot.width) plot.setSize({width: frame.clientWidth, height: options.height});
      this.placeHeads();
    }).observe(frame);
  }

  timeScale() {
    return {time: false, min: this.zoom[0], max: this.zoom[1]};
  }

  /// A little room around the values and what else is to be seen (numbers; null for none).
  valueScale(others) {
    const held = others.filter((value) => value !== null);
    return {range: (_, low, high) => {
      if (low === null) return [0, 1];
      const least = Math.min(low, ...held), most = Math.max(high, ...held);
      const isFlat = most - least <= kRounding * Math.max(Math.abs(most), Math.abs(least));
      const room = isFlat ? Math.abs(most) * 0.1 || 1 : 0.06 * (most - least);
      return [least - room, most + room];
    }};
  }

  zoomed(source) {
    const {min, max} = source.scales.x;
    if (min === undefined || max === undefined || this.zooming || (min === this.zoom[0] && max === this.zoom[1])) return;
    this.zoom = [min, max];
    this.zooming = true;
    for (const {plot} of this.plots) if (plot !== source) plot.setScale("x", {min, max});
    this.zooming = false;
    queueMicrotask(() => this.placeHeads());
  }

  zoomOut() {
    this.plots[0]?.plot.setScale("x", {min: this.clock.start, max: this.clock.end});
  }

  /// The line at the clock's time, and the values there, as long as no cursor asks for others.
  placeHeads() {
    const [low, high] = this.zoom;
    const share = (this.clock.t - low) / (high - low || 1), idx = lastRowAt(this.time, this.clock.t);
    for (const {plot, head} of this.plots) {
      head.style.left = `${100 * share}%`;
      head.hidden = share < 0 || share > 1;
      if (!(plot.cursor.left >= 0)) plot.setLegend({idx}, false);
    }
  }
}
Plots.count = 0;
