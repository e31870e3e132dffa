// Two quantities that are estimated together, across one another: the mean, ellipses of one and two standard deviations, and the truth.
//
//     p(phi) = mean + n L (cos phi, sin phi),     L L' = covariance,  n = 1, 2
//
// Twice: a view that holds the whole run, and one that holds its second half, for an estimate gets sharper by orders of magnitude.
import {bind} from "./binding.js";
import {principalAxes} from "./covariance.js";
import {element, whenSeen} from "./element.js";
import {number, prefixed} from "./format.js";
import {lastRowAt} from "./table.js";
import {color, onThemeChange} from "./theme.js";
import {ticks, tickTexts} from "./ticks.js";

const kHeight = 250;
const kMargin = {left: 58, right: 10, top: 8, bottom: 36};
const kDeviations = [2, 1];
const kRoom = 0.08;

/// The range of mean and truth from row `first` on, two deviations and a little room about it.
function rangeFrom(first, axis, rows) {
  let low = Infinity, high = -Infinity;
  for (let k = first; k < rows; ++k) {
    const mean = axis.mean(k), spread = kDeviations[0] * axis.deviation(k), truth = axis.truth?.(k) ?? mean;
    [low, high] = [Math.min(low, mean - spread, truth), Math.max(high, mean + spread, truth)];
  }
  const room = kRoom * (high - low) || 1e-9;
  return {low: low - room, high: high + room};
}

export class EstimateMap {
  constructor(json, table, time, clock) {
    Object.assign(this, {json, time, clock});
    const at = (name) => (name === undefined ? undefined : bind(name, table)), rows = table.kept;
    const covariance = json.covariance.map(at);
    this.covariance = (k) => covariance.map((value) => value(k));
    const axis = ({title, unit, mean, truth}, variance) =>
        ({title, unit, mean: at(mean), truth: at(truth), deviation: (k) => Math.sqrt(Math.max(0, variance(k)))});
    this.axes = [axis(json.across, covariance[0]), axis(json.upward, covariance[2])];
    this.views = [["whole run", 0], ["second half", rows >> 1]].map(([title, first]) => {
      const ranges = this.axes.map((one) => rangeFrom(first, one, rows));
      const scales = this.axes.map(({unit}, i) => prefixed(unit, Math.max(Math.abs(ranges[i].low), Math.abs(ranges[i].high))));
      const label = `${json.title}, ${title}: mean, ellipses of one and two standard deviations, truth`;
      const canvas = element("canvas", {role: "img", style: `height: ${kHeight}px`, "aria-label": label});
      return {title, ranges, scales, canvas};
    });
    this.note = element("span", {class: "note"});
    const key = (style, text) => element("span", {class: "key"}, element("i", {class: style}), text);
    const views = this.views.map(({title, canvas}) => element("div", {}, element("p", {class: "view"}, title), canvas));
    const believed = key("mean-key", "believed: mean, 1 and 2 standard deviations (of normal errors, 39 % and 86 % lie within)");
    this.node = element("figure", {class: "plot estimate", role: "group", "aria-label": json.title},
                        element("figcaption", {}, json.title, this.note), element("div", {class: "views"}, ...views),
                        element("p", {class: "keys"}, believed, ...(this.axes[0].truth ? [key("truth-key", "truth")] : [])));
    whenSeen(this.node, () => {
      for (const view of this.views) new ResizeObserver(() => this.draw(view)).observe(view.canvas);
      clock.listen(() => this.show());
      onThemeChange(() => this.show());
    });
  }

  /// The row of the clock's time.
  row() {
    return lastRowAt(this.time, this.clock.t);
  }

  /// What is drawn now, for the caption and for tests.
  state() {
    const k = this.row();
    return {mean: this.axes.map(({mean}) => mean(k)), deviations: this.axes.map(({deviation}) => deviation(k)), ...principalAxes(this.covariance(k))};
  }

  show() {
    const k = this.row();
    this.note.textContent = this.axes.map(({title, unit, mean, truth, deviation}) => {
      const scale = prefixed(unit, Math.max(Math.abs(mean(k)), deviation(k))), text = (value) => number(value * scale.factor, 3);
      return `${title} ${text(mean(k))} ± ${text(deviation(k))}${truth ? ` (truth ${text(truth(k))})` : ""} ${scale.unit}`;
    }).join(", ");
    for (const view of this.views) this.draw(view);
  }

  draw({canvas, ranges: [x, y], scales}) {
    const ratio = window.devicePixelRatio, width = canvas.clientWidth;
    const inner = {width: width - kMargin.left - kMargin.right, height: kHeight - kMargin.top - kMargin.bottom};
    if (width === 0) return;
    canvas.width = width * ratio;
    canvas.height = kHeight * ratio;
    const context = canvas.getContext("2d");
    context.scale(ratio, ratio);
    const toX = (v) => kMargin.left + ((v - x.low) / (x.high - x.low)) * inner.width;
    const toY = (v) => kMargin.top + ((y.high - v) / (y.high - y.low)) * inner.height;
    this.drawAxes(context, inner, {x, y, toX, toY, scales});
    context.beginPath();
    context.rect(kMargin.left, kMargin.top, inner.width, inner.height);
    context.clip();
    this.drawBelief(context, toX, toY);
  }

  drawAxes(context, inner, {x, y, toX, toY, scales}) {
    context.strokeStyle = color("grid");
    context.fillStyle = color("muted");
    context.font = "11px system-ui, sans-serif";
    const [across, upward] = this.axes.map(({title}, i) => title + (scales[i].unit ? `, ${scales[i].unit}` : ""));
    const line = (x0, y0, x1, y1) => {
      context.beginPath();
      context.moveTo(x0, y0);
      context.lineTo(x1, y1);
      context.stroke();
    };
    context.textAlign = "center";
    const along = ticks(x.low, x.high, Math.max(2, Math.floor(inner.width / 55))), up = ticks(y.low, y.high, 6);
    const alongTexts = tickTexts(along, scales[0].factor), upTexts = tickTexts(up, scales[1].factor);
    along.forEach((v, i) => {
      line(toX(v), kMargin.top, toX(v), kMargin.top + inner.height);
      context.fillText(alongTexts[i], toX(v), kMargin.top + inner.height + 14);
    });
    context.fillText(across, kMargin.left + inner.width / 2, kHeight - 5);
    context.textAlign = "right";
    up.forEach((v, i) => {
      line(kMargin.left, toY(v), kMargin.left + inner.width, toY(v));
      context.fillText(upTexts[i], kMargin.left - 6, toY(v) + 4);
    });
    context.save();
    context.translate(11, kMargin.top + inner.height / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText(upward, 0, 0);
    context.restore();
  }

  drawBelief(context, toX, toY) {
    const now = this.row(), [across, upward] = this.axes, [aa, ab, bb] = this.covariance(now);
    context.strokeStyle = context.fillStyle = color("scene-believed");
    context.globalAlpha = 0.45;
    context.beginPath();
    for (let k = 0; k <= now; ++k) context.lineTo(toX(across.mean(k)), toY(upward.mean(k)));
    context.stroke();
    const first = Math.sqrt(Math.max(0, aa)), shared = first > 0 ? ab / first : 0, second = Math.sqrt(Math.max(0, bb - shared * shared));
    for (const n of kDeviations) {
      context.beginPath();
      for (let i = 0; i <= 96; ++i) {
        const c = n * Math.cos((i * Math.PI) / 48), s = n * Math.sin((i * Math.PI) / 48);
        context.lineTo(toX(across.mean(now) + first * c), toY(upward.mean(now) + shared * c + second * s));
      }
      context.globalAlpha = 0.14;
      context.fill();
      context.globalAlpha = 1;
      context.stroke();
    }
    context.beginPath();
    context.arc(toX(across.mean(now)), toY(upward.mean(now)), 2.5, 0, 2 * Math.PI);
    context.fill();
    if (!across.truth || !upward.truth) return;
    const cx = toX(across.truth(now)), cy = toY(upward.truth(now)), arm = 6;
    context.strokeStyle = color("ink");
    context.lineWidth = 1.8;
    context.beginPath();
    for (const way of [1, -1]) {
      context.moveTo(cx - arm, cy - way * arm);
      context.lineTo(cx + arm, cy + way * arm);
    }
    context.stroke();
  }
}
