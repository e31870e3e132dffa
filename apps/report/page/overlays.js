// What is drawn into a plot besides its curves: limits, how sure an estimate is, what a plan has ahead, events.
import {numbered} from "./binding.js";
import {lastRowAt} from "./table.js";
import {color} from "./theme.js";

const kDeviations = 2;  // of a band, to either side

/// The columns of a foresight, in whose name a # stands for 1 .. count.
function foreseen({columns, count}, table) {
  return Array.from({length: count}, (_, i) => table.numbers(numbered(columns, i + 1)));
}

/// Least and most of what a plan has ahead at any time.
export function foreseenRange(foresights, table) {
  let low = Infinity, high = -Infinity;
  for (const foresight of foresights ?? []) {
    for (const values of foreseen(foresight, table)) for (const v of values) [low, high] = [Math.min(low, v), Math.max(high, v)];
  }
  return low <= high ? [low, high] : [];
}

/// Draws within the plot's area, on its canvas.
function inside(u, draw) {
  const {ctx, bbox} = u;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  draw(ctx, (t) => u.valToPos(t, "x", true), (v) => u.valToPos(v, "y", true), bbox);
  ctx.restore();
}

/// Dashed lines at the limits of a group.
export function limitsPlugin(limits) {
  return {hooks: {draw: (u) => inside(u, (ctx, toX, toY, bbox) => {
    ctx.strokeStyle = color("limit");
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([6 * devicePixelRatio, 4 * devicePixelRatio]);
    ctx.beginPath();
    for (const limit of limits ?? []) {
      if (limit === null) continue;
      ctx.moveTo(bbox.left, toY(limit));
      ctx.lineTo(bbox.left + bbox.width, toY(limit));
    }
    ctx.stroke();
  })}};
}

/// The upper (way 1) or the lower (-1) edge of a band at row k.
function edgeOf({mean, variance}, table) {
  const middle = table.numbers(mean), square = table.numbers(variance);
  return (k, way) => middle[k] + way * kDeviations * Math.sqrt(Math.max(0, square[k]));
}

/// Least and most of the bands in the second half: at first they may be far wider than all else.
export function bandRange(bands, table) {
  let low = Infinity, high = -Infinity;
  for (const edge of (bands ?? []).map((band) => edgeOf(band, table))) {
    for (let k = table.kept >> 1; k < table.kept; ++k) [low, high] = [Math.min(low, edge(k, -1)), Math.max(high, edge(k, 1))];
  }
  return low <= high ? [low, high] : [];
}

/// Two standard deviations about a mean, [{mean, variance}], in the colour that `colorOf` gives the mean's column.
export function confidencePlugin(bands, table, time, colorOf) {
  const edges = (bands ?? []).map((band) => ({mean: band.mean, edge: edgeOf(band, table)}));
  return {hooks: {drawClear: (u) => inside(u, (ctx, toX, toY) => {
    ctx.globalAlpha = 0.18;
    for (const {mean, edge} of edges) {
      ctx.fillStyle = colorOf(mean);
      ctx.beginPath();
      for (let k = 0; k < time.length; ++k) ctx.lineTo(toX(time[k]), toY(edge(k, 1)));
      for (let k = time.length - 1; k >= 0; --k) ctx.lineTo(toX(time[k]), toY(edge(k, -1)));
      ctx.fill();
    }
  })}};
}

/// What the plan of the clock's time has ahead, [{columns, count, step}]: a line with a dot for each of its instants.
export function foresightPlugin(foresights, table, time, clock) {
  const plans = (foresights ?? []).map((foresight) => ({step: foresight.step, values: foreseen(foresight, table)}));
  return {hooks: {draw: (u) => inside(u, (ctx, toX, toY) => {
    const k = lastRowAt(time, clock.t);
    ctx.fillStyle = ctx.strokeStyle = color("scene-plan");
    ctx.lineWidth = devicePixelRatio;
    for (const {step, values} of plans) {
      const points = values.map((column, i) => [toX(time[k] + (i + 1) * step), toY(column[k])]);
      ctx.beginPath();
      for (const point of points) ctx.lineTo(...point);
      ctx.stroke();
      for (const point of points) {
        ctx.beginPath();
        ctx.arc(...point, 1.6 * devicePixelRatio, 0, 2 * Math.PI);
        ctx.fill();
      }
    }
  })}};
}

/// Thin lines where events are, [{t}].
export function eventsPlugin(events) {
  return {hooks: {drawClear: (u) => inside(u, (ctx, toX, toY, bbox) => {
    ctx.strokeStyle = color("event");
    ctx.lineWidth = devicePixelRatio;
    ctx.beginPath();
    for (const {t} of events) {
      const x = Math.round(toX(t)) + 0.5;
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
    }
    ctx.stroke();
  })}};
}
