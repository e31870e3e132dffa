// Lenses: small squares about a point of a body, seen enlarged in the corners of the animation. Planar scenes.
import {OrthographicCamera, Vector3} from "three";
import {element} from "./element.js";
import {scaled} from "./format.js";
import {stroke} from "./sketch.js";

const kShare = 0.3;      // of the picture's shorter side
const kCorners = ["top left", "top right", "bottom left", "bottom right"];
const kInset = 8;        // pixels
export const kLensLayer = 1;  // what the lenses themselves do not show

export class Lens {
  constructor(json, index, bodies, extent, theme) {
    this.json = json;
    this.body = bodies.get(json.body).group;
    this.at = new Vector3(...(json.at ?? []), 0);
    this.corner = kCorners[index % kCorners.length];
    const half = json.extent / 2;
    this.camera = new OrthographicCamera(-half, half, half, -half, 0.1 * extent, 100 * extent);
    this.distance = 10 * extent;
    const corners = [[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]].map(([x, y]) => new Vector3(x * half, y * half, 0));
    this.object = stroke(corners, "lens", theme, {width: 1, order: 8});
    this.object.layers.set(kLensLayer);
    this.frame = element("div", {class: "lens"}, element("span", {}, `${json.name}: ${scaled(json.extent, "m", 3)} wide`));
  }

  /// The square that it shows.
  place() {
    this.body.localToWorld(this.object.position.copy(this.at));
  }

  /// Where it stands in a picture of this size, in pixels from its upper left corner.
  resize(width, height) {
    const size = Math.round(kShare * Math.min(width, 1.25 * height));
    this.box = {left: this.corner.includes("left") ? kInset : width - size - kInset,
                top: this.corner.includes("top") ? kInset : height - size - kInset, size};
    Object.assign(this.frame.style, {left: `${this.box.left}px`, top: `${this.box.top}px`, width: `${size}px`, height: `${size}px`});
  }

  /// Pixels for each m.
  get sharpness() {
    return this.box.size / this.json.extent;
  }

  /// Draws what it shows over the picture that is there.
  draw(renderer, scene, up, height) {
    const {left, top, size} = this.box, middle = this.object.position;
    this.camera.up.copy(up);
    this.camera.position.copy(middle).add(new Vector3(0, 0, this.distance));
    this.camera.lookAt(middle);
    renderer.setScissorTest(true);
    for (const set of ["setViewport", "setScissor"]) renderer[set](left, height - top - size, size, size);
    renderer.render(scene, this.camera);
    renderer.setScissorTest(false);
  }
}
