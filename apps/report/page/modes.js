// Modes as colour: a lane for each contact (free, collision, contact) or status, and a tint behind the plots where any contact holds.
import {number} from "./format.js";
import {color} from "./theme.js";

const kModeNames = ["free", "collision", "contact"];
const kModeColors = ["mode-free", "mode-collision", "mode-contact"];
const kStatusColors = {solved: "mode-free", acceptable: "series-4", best_effort: "series-4", fallback: "mode-collision"};
const kMostLanes = 24;
const kLaneHeight = 16;

/// Runs of equal value: [{from, to, value}] in rows.
function runsOf(values) {
  const runs = [];
  for (let k = 0; k < values.length; ++k) {
    if (k === 0 || values[k] !== values[k - 1]) runs.push({from: k, to: k, value: values[k]});
    runs[runs.length - 1].to = k + 1;
  }
  return runs;
}

/// [{column, name, runs, isContact, color(value), text(value)}]; contacts that are never touched come last and are dropped first.
export function lanesOf(table) {
  const lanes = [];
  for (const name of table.names) {
    if (name.startsWith("mode_") && !table.isText(name)) {
      const runs = runsOf(table.numbers(name));
      lanes.push({column: name, name: name.slice(5), runs, isContact: true, color: (v) => kModeColors[v] ?? "series-" + (Math.abs(v) % 8),
                  text: (v) => kModeNames[v] ?? number(v)});
    } else if (name === "status" && table.isText(name)) {
      const {texts, codes} = table.texts(name);
      lanes.push({column: name, name, runs: runsOf(codes), isContact: false, color: (v) => kStatusColors[texts[v]] ?? "mode-collision", text: (v) => texts[v]});
    }
  }
  return lanes.sort((a, b) => (b.runs.length > 1) - (a.runs.length > 1)).slice(0, kMostLanes);
}

export function laneHeight(lanes) {
  return kLaneHeight * lanes.length;
}

/// What each colour of the lanes means: [{color, text}].
export function laneKey(lanes) {
  const seen = new Map();
  for (const lane of lanes) for (const {value} of lane.runs) seen.set(lane.text(value), lane.color(value));
  return [...seen].map(([text, name]) => ({text, color: name}));
}

function span(u, time, run) {
  const {bbox} = u;
  const from = Math.max(bbox.left, u.valToPos(time[run.from], "x", true));
  const to = Math.min(bbox.left + bbox.width, u.valToPos(time[Math.min(run.to, time.length - 1)], "x", true));
  return [from, Math.max(to - from, from < bbox.left + bbox.width && to >= bbox.left ? devicePixelRatio : 0)];
}

/// `names` are written into the lanes, where they have no room beside them.
export function lanesPlugin(lanes, time, names) {
  return {hooks: {drawClear: (u) => {
    const {ctx, bbox} = u, height = bbox.height / lanes.length;
    ctx.save();
    lanes.forEach((lane, i) => {
      for (const run of lane.runs) {
        const [x, width] = span(u, time, run);
        if (width <= 0) continue;
        ctx.fillStyle = color(lane.color(run.value));
        ctx.fillRect(x, bbox.top + (i + 0.15) * height, width, 0.7 * height);
      }
    });
    ctx.fillStyle = color("ink");
    ctx.font = `${10 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textBaseline = "middle";
    names.forEach((name, i) => ctx.fillText(name, bbox.left + 4 * devicePixelRatio, bbox.top + (i + 0.5) * height));
    ctx.restore();
  }}};
}

/// What any contact does, row by row: 1 where one collides, else 2 where one holds, else 0.
function strongest(lanes, rows) {
  const values = new Uint8Array(rows);
  for (const {runs} of lanes) {
    for (const {from, to, value} of runs) {
      for (let k = from; k < to && value !== 0; ++k) values[k] = value === 1 ? 1 : values[k] || value;
    }
  }
  return values;
}

/// A tint behind a plot: collision where any contact collides, contact where any holds.
export function bandPlugin(lanes, time) {
  const runs = runsOf(strongest(lanes.filter((lane) => lane.isContact), time.length)).filter((run) => run.value !== 0);
  return {hooks: {drawClear: (u) => {
    const {ctx, bbox} = u;
    ctx.save();
    ctx.globalAlpha = 0.16;
    for (const run of runs) {
      const [x, width] = span(u, time, run);
      if (width <= 0) continue;
      ctx.fillStyle = color(kModeColors[run.value]);
      ctx.fillRect(x, bbox.top, width, bbox.height);
    }
    ctx.restore();
  }}};
}
