// A quantity over all directions: a globe that is turned by hand, and an equal-area map of the whole sphere.
//
// Columns nx, ny, nz hold unit directions, every other column a quantity; force_failed3 is the quantity force in the case that rotor 3 has
// failed, and all cases of a quantity share one scale. A pixel has the value of the nearest direction, and none where that is empty. The map
// is Hammer's:  x = 2 sqrt2 cos(b) sin(l/2) / D,   y = sqrt2 sin(b) / D,   D = sqrt(1 + cos(b) cos(l/2)),   l longitude, b latitude.
import {cssGradient, scaleColor} from "./color_scale.js";
import {download, element, whenSeen} from "./element.js";
import {number, withUnit} from "./format.js";
import {Table} from "./table.js";

const kMostCells = 24;  // of the look-up grid, along each axis

/// What `tenon envelope` calls its quantities: [in words, unit].
const kQuantities = {
  X1: ["X1: upward share of the thrust, this direction up", ""],
  X2: ["X2: weight over N times the largest rotor force", ""],
  force: ["Largest force without a torque", "N"],
  torque: ["Largest torque without a force", "N m"],
  torque_hover: ["Largest torque, carried with body z up", "N m"],
};

const kUndefined = [150, 150, 150];  // the colour where a quantity has no value
const kAxes = [["x", 1, 0, 0], ["−x", -1, 0, 0], ["y", 0, 1, 0], ["−y", 0, -1, 0], ["z", 0, 0, 1], ["−z", 0, 0, -1]];

/// {quantity: {case: column}}, the whole vehicle being case 0.
function byCase(names) {
  const out = new Map();
  for (const name of names) {
    const [, quantity, failed] = /^(.*?)(?:_failed(\d+))?$/.exec(name);
    if (!out.has(quantity)) out.set(quantity, new Map());
    out.get(quantity).set(Number(failed ?? 0), name);
  }
  return out;
}

/// The nearest of many directions, by a grid of cells over the cube around the sphere.
class Directions {
  constructor(x, y, z) {
    Object.assign(this, {x, y, z});
    this.count = Math.min(kMostCells, Math.max(2, Math.floor(Math.sqrt(x.length) / 4)));
    this.cells = new Map();
    for (let k = 0; k < x.length; ++k) {
      const key = this.key(x[k], y[k], z[k]);
      if (!this.cells.has(key)) this.cells.set(key, []);
      this.cells.get(key).push(k);
    }
  }

  index(v) {
    return Math.min(this.count - 1, Math.max(0, Math.floor(((v + 1) / 2) * this.count)));
  }

  key(x, y, z) {
    return (this.index(x) * this.count + this.index(y)) * this.count + this.index(z);
  }

  nearest(x, y, z) {
    const [i, j, l] = [this.index(x), this.index(y), this.index(z)];
    for (let reach = 1; reach < 2 * this.count; reach *= 2) {
      let best = -1, most = -2;
      for (let a = Math.max(0, i - reach); a <= Math.min(this.count - 1, i + reach); ++a) {
        for (let b = Math.max(0, j - reach); b <= Math.min(this.count - 1, j + reach); ++b) {
          for (let c = Math.max(0, l - reach); c <= Math.min(this.count - 1, l + reach); ++c) {
            for (const k of this.cells.get((a * this.count + b) * this.count + c) ?? []) {
              const dot = this.x[k] * x + this.y[k] * y + this.z[k] * z;
              if (dot > most) [best, most] = [k, dot];
            }
          }
        }
      }
      // Whatever lies outside the cells looked at is at least `reach` cells away.
      if (best >= 0 && 2 - 2 * most <= (2 * reach / this.count) ** 2) return best;
    }
    return -1;
  }
}

/// Where a pixel of the map looks, or undefined outside it; x, y in [-1, 1].
function hammer(x, y) {
  if (x * x + y * y > 1) return undefined;
  const X = 2 * Math.SQRT2 * x, Y = Math.SQRT2 * y, w = Math.sqrt(1 - (X / 4) ** 2 - (Y / 2) ** 2);
  const longitude = 2 * Math.atan2(w * X, 2 * (2 * w * w - 1)), latitude = Math.asin(Math.max(-1, Math.min(1, w * Y)));
  return [Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)];
}

/// Where a direction stands on the map.
function placeOnMap(x, y, z) {
  const half = Math.atan2(y, x) / 2, flat = Math.hypot(x, y), D = Math.sqrt(1 + flat * Math.cos(half));
  return [(flat * Math.sin(half)) / D, z / D];
}

export class SphereMap {
  constructor(part, index) {
    this.table = new Table(part);
    this.plots = [];
    this.title = "Over all directions";
    this.columns = byCase(this.table.names.filter((name) => !["nx", "ny", "nz"].includes(name) && !this.table.isText(name)));
    const cases = [...new Set([...this.columns.values()].flatMap((column) => [...column.keys()]))].sort((a, b) => a - b);
    this.directions = new Directions(...["nx", "ny", "nz"].map((name) => this.table.numbers(name)));
    this.turnZ = -0.6;
    this.tilt = 0.5;
    const choice = (label, options) => element("select", {"aria-label": label, onchange: () => this.draw()}, ...options);
    this.quantity = choice("Quantity", [...this.columns.keys()].map((name) => element("option", {value: name}, kQuantities[name]?.[0] ?? name)));
    this.failure = choice("Failure", cases.map((k) => element("option", {value: k}, k === 0 ? "no rotor failed" : `rotor ${k} failed`)));
    this.globe = element("canvas", {class: "globe", role: "img", tabindex: "0", "aria-label": "Globe; arrow keys turn it"});
    this.map = element("canvas", {class: "hammer", role: "img", "aria-label": "Equal-area map of all directions"});
    this.readout = element("output", {class: "facts"});
    this.low = element("span");
    this.high = element("span");
    this.none = element("span", {class: "none"}, element("b", {style: `background: rgb(${kUndefined.join(" ")})`}), "cannot be had");
    const csv = element("button", {type: "button", "aria-label": "Download as CSV", onclick: () => download(part.name, this.table.csv())}, "CSV");
    this.node = element("section", {id: "part-" + index, "aria-label": this.title}, element("h2", {}, this.title),
                        element("p", {class: "facts"}, `${this.table.rows} directions `, this.quantity, cases.length > 1 ? this.failure : undefined, csv),
                        element("div", {class: "sphere"}, this.globe, this.map),
                        element("p", {class: "scale"}, this.low, element("i", {style: `background: ${cssGradient()}`}), this.high, this.none), this.readout);
    this.turnByHand();
    whenSeen(this.node, () => {
      this.draw();
      new ResizeObserver(() => this.draw()).observe(this.node);
    });
  }

  turnByHand() {
    const turn = (dx, dy) => {
      this.turnZ += dx;
      this.tilt = Math.max(-Math.PI / 2, Math.min(Math.PI / 2, this.tilt + dy));
      this.drawGlobe();
    };
    this.globe.addEventListener("pointerdown", (event) => this.globe.setPointerCapture(event.pointerId));
    this.globe.addEventListener("pointermove", (event) => {
      if (event.buttons) turn(-event.movementX * 0.008, event.movementY * 0.008);
    });
    const steps = {ArrowLeft: [-0.1, 0], ArrowRight: [0.1, 0], ArrowUp: [0, 0.1], ArrowDown: [0, -0.1]};
    this.globe.addEventListener("keydown", (event) => {
      if (!steps[event.key]) return;
      event.preventDefault();
      event.stopPropagation();
      turn(...steps[event.key]);
    });
    const say = (canvas, where) => canvas.addEventListener("pointermove", (event) => {
      const box = canvas.getBoundingClientRect();
      const k = this.at(where((2 * (event.clientX - box.left)) / box.width - 1, 1 - (2 * (event.clientY - box.top)) / box.height));
      if (k < 0) return;
      const [x, y, z] = [this.directions.x[k], this.directions.y[k], this.directions.z[k]].map((v) => number(v, 3));
      this.readout.textContent = `(${x}, ${y}, ${z}): ${withUnit(this.values[k], this.unit, 5)}`;
    });
    say(this.globe, (x, y) => this.seen(x, y));
    say(this.map, hammer);
  }

  at(direction) {
    return direction === undefined ? -1 : this.directions.nearest(...direction);
  }

  /// Where a pixel of the globe looks: the sphere seen from longitude turnZ and latitude tilt.
  seen(x, y) {
    const square = x * x + y * y;
    if (square > 1) return undefined;
    const toward = Math.sqrt(1 - square), c = Math.cos(this.tilt), s = Math.sin(this.tilt);
    const out = toward * c - y * s, up = toward * s + y * c;
    return [out * Math.cos(this.turnZ) - x * Math.sin(this.turnZ), out * Math.sin(this.turnZ) + x * Math.cos(this.turnZ), up];
  }

  /// The inverse of `seen`, for the half that is in sight.
  placeOnGlobe(x, y, z) {
    const c = Math.cos(this.tilt), s = Math.sin(this.tilt);
    const out = x * Math.cos(this.turnZ) + y * Math.sin(this.turnZ), across = -x * Math.sin(this.turnZ) + y * Math.cos(this.turnZ);
    return out * c + z * s > 0 ? [across, z * c - out * s] : undefined;
  }

  /// `place` is the inverse of `where`: x, y in [-1, 1] of a direction, undefined where it is not seen.
  paint(canvas, where, place) {
    const width = (canvas.width = Math.round(canvas.clientWidth)), height = (canvas.height = Math.round(canvas.clientHeight));
    if (width === 0) return;
    const context = canvas.getContext("2d"), image = context.createImageData(width, height);
    for (let row = 0; row < height; ++row) {
      for (let column = 0; column < width; ++column) {
        const k = this.at(where((2 * (column + 0.5)) / width - 1, 1 - (2 * (row + 0.5)) / height));
        if (k < 0) continue;
        const v = this.values[k];
        const shade = Number.isNaN(v) ? kUndefined : scaleColor((v - this.least) / (this.most - this.least || 1));
        image.data.set([...shade, 255], 4 * (row * width + column));
      }
    }
    context.putImageData(image, 0, 0);
    this.paintAxes(context, width, height, place);
  }

  /// Dots where the body's axes pierce the sphere.
  paintAxes(context, width, height, place) {
    context.font = "12px system-ui, sans-serif";
    context.textAlign = "center";
    for (const [name, ...direction] of kAxes) {
      const at = place(...direction);
      if (at === undefined) continue;
      const x = ((at[0] + 1) * width) / 2, y = ((1 - at[1]) * height) / 2;
      context.beginPath();
      context.arc(x, y, 2.5, 0, 2 * Math.PI);
      context.fillStyle = context.strokeStyle = "#fff";
      context.fill();
      context.lineWidth = 3;
      context.strokeStyle = "#0008";
      const below = y < 22 ? 17 : -7, inside = Math.min(width - 10, Math.max(10, x));
      context.strokeText(name, inside, y + below);
      context.fillText(name, inside, y + below);
    }
  }

  drawGlobe() {
    this.paint(this.globe, (x, y) => this.seen(x, y), (x, y, z) => this.placeOnGlobe(x, y, z));
  }

  draw() {
    const cases = this.columns.get(this.quantity.value);
    this.unit = kQuantities[this.quantity.value]?.[1];
    this.values = this.table.numbers(cases.get(Number(this.failure.value)) ?? [...cases.values()][0]);
    [this.least, this.most] = [Infinity, -Infinity];
    for (const column of cases.values()) {
      for (const v of this.table.numbers(column)) {
        if (v < this.least) this.least = v;
        if (v > this.most) this.most = v;
      }
    }
    const isDefined = this.least <= this.most;
    this.low.textContent = isDefined ? withUnit(this.least, this.unit, 4) : "–";
    this.high.textContent = isDefined ? withUnit(this.most, this.unit, 4) : "–";
    this.none.hidden = !this.values.some(Number.isNaN);
    this.drawGlobe();
    this.paint(this.map, hammer, placeOnMap);
  }
}
