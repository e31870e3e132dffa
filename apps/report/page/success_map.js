// Where runs succeeded: each a dot over two quantities, and the rate of success as a tint of the cells between.
import {element} from "./element.js";
import {prefixed} from "./format.js";
import {color} from "./theme.js";
import {ticks, tickTexts} from "./ticks.js";
import {largestOf, unitOf} from "./units.js";

const kMargin = {left: 62, right: 12, top: 8, bottom: 38};
const kMostCells = 12, kInCell = 4;  // along each axis; runs that a cell has, about
const kReach = 10;                // pixels from a dot, within which the pointer is at it

function limits(values) {
  let low = Infinity, high = -Infinity;
  for (const v of values) if (Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
  if (!(high > low)) return [low - 0.5, high + 0.5];
  const room = 0.02 * (high - low);
  return [low - room, high + room];
}

/// `onPoint(k)` is told which run the pointer is at, undefined where at none.
export function makeSuccessMap(label, onPoint) {
  const canvas = element("canvas", {class: "success-map", role: "img", "aria-label": label});
  canvas.addEventListener("pointermove", ({offsetX, offsetY}) => {
    let nearest, least = kReach;
    canvas.places?.forEach(([x, y], k) => {
      const distance = Math.hypot(x - offsetX, y - offsetY);
      if (distance < least) [nearest, least] = [k, distance];
    });
    onPoint(nearest);
  });
  canvas.addEventListener("pointerleave", () => onPoint(undefined));
  return canvas;
}

/// `across` and `upward` are {name, values, all}: of the runs, and of all whose maps share the axes; success[k] > 0 where run k succeeded.
export function drawSuccessMap(canvas, across, upward, success) {
  const ratio = window.devicePixelRatio, width = canvas.clientWidth, height = canvas.clientHeight;
  if (width === 0) return;
  canvas.width = width * ratio;
  canvas.height = height * ratio;
  const context = canvas.getContext("2d");
  context.scale(ratio, ratio);
  const x = across.values, y = upward.values, [x0, x1] = limits(across.all), [y0, y1] = limits(upward.all);
  const inner = {width: width - kMargin.left - kMargin.right, height: height - kMargin.top - kMargin.bottom};
  const shareX = (v) => (v - x0) / (x1 - x0), shareY = (v) => (v - y0) / (y1 - y0);
  const toX = (share) => kMargin.left + share * inner.width, toY = (share) => kMargin.top + (1 - share) * inner.height;

  // Cells: success as colour.
  const cells = Math.max(3, Math.min(kMostCells, Math.floor(Math.sqrt(x.length / kInCell))));
  const good = new Float64Array(cells * cells), all = new Float64Array(cells * cells);
  const cell = (share) => Math.min(cells - 1, Math.max(0, Math.floor(share * cells)));
  for (let k = 0; k < x.length; ++k) {
    if (!Number.isFinite(x[k]) || !Number.isFinite(y[k])) continue;
    const at = cell(shareY(y[k])) * cells + cell(shareX(x[k]));
    ++all[at];
    good[at] += success[k] > 0 ? 1 : 0;
  }
  for (let at = 0; at < all.length; ++at) {
    if (all[at] === 0) continue;
    const column = at % cells, row = Math.floor(at / cells);
    for (const [name, rate] of [["good", good[at] / all[at]], ["bad", 1 - good[at] / all[at]]]) {
      context.globalAlpha = 0.22 * rate;
      context.fillStyle = color(name);
      context.fillRect(toX(column / cells), toY((row + 1) / cells), inner.width / cells, inner.height / cells);
    }
  }
  const many = x.length > 3000, radius = many ? 1.2 : 2.2;
  context.globalAlpha = many ? 0.5 : 0.8;
  canvas.places = Array.from(x, (_, k) => [toX(shareX(x[k])), toY(shareY(y[k]))]);
  for (const wanted of [true, false]) {  // failures on top
    context.fillStyle = color(wanted ? "good" : "bad");
    for (let k = 0; k < x.length; ++k) {
      if (success[k] > 0 !== wanted || !Number.isFinite(x[k]) || !Number.isFinite(y[k])) continue;
      context.beginPath();
      context.arc(...canvas.places[k], wanted ? radius : 1.3 * radius, 0, 2 * Math.PI);
      context.fill();
    }
  }
  context.globalAlpha = 1;
  drawAxes(context, {height, inner, x: {...across, low: x0, high: x1, to: (v) => toX(shareX(v))},
                     y: {...upward, low: y0, high: y1, to: (v) => toY(shareY(v))}});
}

function drawAxes(context, {height, inner, x, y}) {
  context.strokeStyle = color("grid");
  context.strokeRect(kMargin.left, kMargin.top, inner.width, inner.height);
  context.fillStyle = color("muted");
  context.font = "11px system-ui, sans-serif";
  const scale = ({name, all}) => prefixed(unitOf(name), largestOf([all]));
  const title = ({name}, {unit}) => name.replaceAll("_", " ") + (unit ? `, ${unit}` : "");
  const [sx, sy] = [scale(x), scale(y)];
  context.textAlign = "center";
  const along = ticks(x.low, x.high, Math.max(2, Math.floor(inner.width / 60))), up = ticks(y.low, y.high, 6);
  tickTexts(along, sx.factor).forEach((text, i) => context.fillText(text, x.to(along[i]), height - 22));
  context.fillText(title(x, sx), kMargin.left + inner.width / 2, height - 6);
  context.textAlign = "right";
  tickTexts(up, sy.factor).forEach((text, i) => context.fillText(text, kMargin.left - 6, y.to(up[i]) + 4));
  context.save();
  context.translate(12, kMargin.top + inner.height / 2);
  context.rotate(-Math.PI / 2);
  context.textAlign = "center";
  context.fillText(title(y, sy), 0, 0);
  context.restore();
}
