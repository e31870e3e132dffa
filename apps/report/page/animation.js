// The animation of a record: its scenery at the time of the clock, planar (seen along z) or spatial (seen in perspective, turned by hand).
import {AmbientLight, Box3, Color, DirectionalLight, GridHelper, HemisphereLight, OrthographicCamera, PerspectiveCamera, Quaternion, Scene,
        Vector3, WebGLRenderer} from "three";
import {OrbitControls} from "three/examples/jsm/controls/OrbitControls.js";
import {Arrow, Body, Link, Trail} from "./bodies.js";
import {element} from "./element.js";
import {scaled} from "./format.js";
import {kLensLayer, Lens} from "./lens.js";
import {kY, vector} from "./shapes.js";
import {Ellipse, Ghosts} from "./sketch.js";
import {lastRowAt} from "./table.js";
import {color, onThemeChange} from "./theme.js";

const kFieldOfView = 30;         // degrees, of the spatial camera
const kFitSamples = 40;          // instants that a view is fitted to
const kLongestArrow = 0.55;      // of the scene's size
const kUnits = {force: "N", torque: "N m", velocity: "m/s"};
const kBodyColors = 6;
const kMostColored = 12;         // bodies; a crowd has one colour

/// The colours of the scene's materials, set anew whenever the theme changes.
class Paints {
  constructor() {
    this.setters = [];
  }
  add(set) {
    this.setters.push(set);
    set();
  }
  color(role) {
    return new Color(color(typeof role === "number" ? "body-" + (role % kBodyColors) : role.startsWith("#") ? role : "scene-" + role) || role);
  }
  shade() {
    return new Color(color("scene-shade"));
  }
  refresh() {
    for (const set of this.setters) set();
  }
}

export class Animation {
  /// Throws where the browser has no WebGL or the scenery names what is not there.
  constructor(scenery, table, time) {
    this.scenery = scenery;
    this.table = table;
    this.time = time;
    this.planar = scenery.space === "planar";
    this.scene = new Scene();
    this.paints = new Paints();
    this.build(1);                         // of size 1, to find how large the scene is
    this.extent = scenery.camera?.extent ?? this.measure();
    this.build(this.extent);
    this.scaleArrows();
    this.addTrails();
    this.addLights();

    this.renderer = new WebGLRenderer({antialias: true, alpha: true});
    this.renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    this.canvas = this.renderer.domElement;
    this.makeCamera();
    this.describe();
    onThemeChange(() => {
      this.paints.refresh();
      this.draw();
    });
  }

  /// Puts the picture into its frame and keeps it as large as that.
  mount(frame) {
    frame.append(this.canvas, ...this.lenses.map((lens) => lens.frame));
    new ResizeObserver(() => this.resize()).observe(frame);
    this.resize();
  }

  build(extent) {
    this.scene.clear();
    this.paints.setters = [];
    const {scenery, table, paints, planar} = this;
    this.bodies = new Map();
    this.arrows = new Map();
    const list = scenery.bodies ?? [];
    list.forEach((json, i) => {
      const body = new Body(json, table, planar, extent, list.length > kMostColored ? 0 : i, paints);
      this.bodies.set(json.name, body);
      (this.bodies.get(json.parent)?.group ?? this.scene).add(body.group);
    });
    this.links = (scenery.links ?? []).map((json) => new Link(json, this.bodies, table, planar, extent, paints));
    for (const json of scenery.arrows ?? []) this.arrows.set(json.name, new Arrow(json, this.bodies, this.arrows, table, extent, paints));
    const flat = (list) => (planar ? list ?? [] : []);
    this.ghosts = flat(scenery.ghosts).map((json) => new Ghosts(json, this.bodies, table, extent, paints));
    this.ellipses = flat(scenery.ellipses).map((json) => new Ellipse(json, this.bodies, table, paints));
    this.lenses = flat(scenery.lenses).map((json, i) => new Lens(json, i, this.bodies, extent, paints));
    this.placed = [...this.links, ...this.arrows.values(), ...this.ghosts, ...this.ellipses, ...this.lenses];
    for (const item of this.placed) this.scene.add(item.object);
    this.trails = [];
  }

  placeBodies(k, f = 0) {
    for (const body of this.bodies.values()) body.place(k, f);
    this.scene.updateMatrixWorld(true);
  }

  /// Rows spread evenly over the record.
  samples(count) {
    const last = this.table.kept - 1;
    return Array.from({length: Math.min(count, last + 1)}, (_, i) => Math.round((i * last) / Math.max(1, Math.min(count, last + 1) - 1)));
  }

  /// The box that holds all bodies at all sampled instants; grounds without end do not count.
  boundingBox() {
    const box = new Box3(), part = new Box3();
    const boundless = [];
    this.scene.traverse((node) => node.userData.boundless && boundless.push(node));
    const homes = boundless.map((node) => node.parent);
    boundless.forEach((node) => node.removeFromParent());
    for (const k of this.samples(kFitSamples)) {
      this.placeBodies(k);
      for (const body of this.bodies.values()) {
        part.setFromObject(body.group);
        if (part.isEmpty()) part.expandByPoint(body.group.getWorldPosition(new Vector3()));
        box.union(part);
      }
    }
    boundless.forEach((node, i) => homes[i].add(node));
    if (box.isEmpty()) box.set(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
    return box;
  }

  measure() {
    this.box = this.boundingBox();
    const size = this.box.getSize(new Vector3());
    return Math.max(size.x, size.y, size.z, 1e-6);
  }

  /// Arrows of one kind share a scale: the longest of them all is about half of the scene.
  scaleArrows() {
    const largest = {};
    for (const k of this.samples(400)) {
      this.placeBodies(k);
      for (const arrow of this.arrows.values()) largest[arrow.kind] = Math.max(largest[arrow.kind] ?? 0, arrow.measure(k, 0).length());
    }
    this.largest = largest;
    for (const arrow of this.arrows.values()) arrow.scale ??= (kLongestArrow * this.extent) / (largest[arrow.kind] || 1);
  }

  addTrails() {
    for (const body of this.bodies.values()) {
      if (body.json.trail) this.trails.push(new Trail(body, this.table, (k) => this.placeBodies(k), this.paints));
    }
    for (const trail of this.trails) this.scene.add(trail.object);
  }

  addLights() {
    const sky = new HemisphereLight(0xffffff, 0x8d8d99, 2.1), sun = new DirectionalLight(0xffffff, 1.7);
    this.up = vector(this.scenery.up ?? (this.planar ? [0, 1, 0] : [0, 0, 1])).normalize();
    sky.position.copy(this.up);
    sun.position.set(1.2, -2, 1).addScaledVector(this.up, 3);
    this.scene.add(new AmbientLight(0xffffff, 0.35), sky, sun);
    const hasGround = (this.scenery.bodies ?? []).some((body) => body.shapes?.some((shape) => shape["half-space"]));
    if (!this.planar && !hasGround) this.addGrid();
  }

  /// Lines below the scene, so that the eye knows what is level.
  addGrid() {
    const step = 10 ** Math.floor(Math.log10(this.extent / 2));
    this.grid = new GridHelper(40 * step, 40);
    this.grid.material.transparent = true;
    this.grid.material.depthWrite = false;
    this.grid.quaternion.copy(new Quaternion().setFromUnitVectors(kY, this.up));
    const box = this.box ?? this.boundingBox(), lowest = Math.min(...[box.min, box.max].map((corner) => corner.dot(this.up)));
    const middle = box.getCenter(new Vector3());
    this.grid.position.copy(middle).addScaledVector(this.up, lowest - middle.dot(this.up) - 0.12 * this.extent);
    this.grid.userData.boundless = true;
    // One colour for all lines, the theme's.
    this.grid.geometry.deleteAttribute("color");
    this.grid.material.vertexColors = false;
    this.paints.add(() => {
      this.grid.material.color.set(color("scene-ground-edge"));
      this.grid.material.opacity = 0.3;
    });
    this.scene.add(this.grid);
  }

  makeCamera() {
    this.camera = this.planar ? new OrthographicCamera() : new PerspectiveCamera(kFieldOfView, 1, 0.01 * this.extent, 100 * this.extent);
    this.camera.up.copy(this.up);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableRotate = !this.planar;
    this.controls.enableDamping = false;
    this.controls.enableZoom = false;  // a page that is scrolled past must not zoom; once the picture has the focus it may
    if (this.planar) this.controls.mouseButtons.LEFT = 2;  // pans
    this.controls.addEventListener("change", () => this.draw());
    this.canvas.addEventListener("focus", () => (this.controls.enableZoom = true));
    this.canvas.addEventListener("blur", () => (this.controls.enableZoom = false));
    this.canvas.addEventListener("pointerdown", () => this.canvas.focus({preventScroll: true}));
    this.canvas.addEventListener("dblclick", () => this.fit());
    this.fit();
  }

  followed() {
    return this.bodies.get(this.scenery.camera?.follow);
  }

  /// The view as the scenery asks for it, else one that holds the whole run.
  fit() {
    const asked = this.scenery.camera ?? {};
    this.box ??= this.boundingBox();
    const target = asked.target ? vector(asked.target) : this.box.getCenter(new Vector3());
    const followed = this.followed();
    if (followed) {
      this.placeBodies(0);
      target.copy(followed.group.getWorldPosition(new Vector3()));
    }
    this.target = target.clone();
    this.controls.target.copy(target);
    this.camera.zoom = 1;
    if (this.planar) {
      this.camera.position.copy(target).add(new Vector3(0, 0, 10 * this.extent));
      this.camera.near = 0.1 * this.extent;
      this.camera.far = 100 * this.extent;
      this.camera.layers.enable(kLensLayer);
    } else {
      const away = (0.72 * this.extent) / Math.tan((kFieldOfView * Math.PI) / 360);
      const direction = asked.direction ? vector(asked.direction) : new Vector3(0.9, -1.3, 0).addScaledVector(this.up, 0.65);
      this.camera.position.copy(target).addScaledVector(direction.normalize(), away);
    }
    this.controls.update();
    this.resize();
  }

  /// The whole of the scene's size fits into the picture, whichever side is the shorter.
  resize() {
    const frame = this.canvas.parentElement;
    if (!frame || frame.clientWidth === 0) return;
    const width = frame.clientWidth, height = frame.clientHeight;
    this.renderer.setSize(width, height);
    if (this.planar) {
      const size = this.box.getSize(new Vector3()), {x, y} = this.up, room = 0.08 * this.extent, asked = this.scenery.camera?.extent;
      // How wide and how high the box is, seen with `up` upward.
      const wide = asked ?? Math.abs(y) * size.x + Math.abs(x) * size.y, high = asked ? asked / 2 : Math.abs(x) * size.x + Math.abs(y) * size.y;
      const half = Math.max(high / 2 + room, ((wide / 2 + room) * height) / width);
      Object.assign(this.camera, {left: (-half * width) / height, right: (half * width) / height, top: half, bottom: -half});
    } else {
      this.camera.aspect = width / height;
      this.camera.fov = width >= height ? kFieldOfView : (360 / Math.PI) * Math.atan((Math.tan((kFieldOfView * Math.PI) / 360) * height) / width);
    }
    for (const lens of this.lenses) lens.resize(width, height);
    this.camera.updateProjectionMatrix();
    this.draw();
  }

  /// Draws the instant t of the record.
  show(t) {
    const k = lastRowAt(this.time, t);
    const step = k + 1 < this.time.length ? this.time[k + 1] - this.time[k] : 0;
    const f = step > 0 ? Math.min(1, Math.max(0, (t - this.time[k]) / step)) : 0;
    this.placeBodies(k, f);
    for (const item of this.placed) item.place(k, f);
    for (const trail of this.trails) trail.place(k);
    const followed = this.followed();
    if (followed) {
      const now = followed.group.getWorldPosition(new Vector3()), moved = now.clone().sub(this.target);
      this.target.copy(now);
      this.camera.position.add(moved);
      this.controls.target.add(moved);
    }
    this.draw();
  }

  draw() {
    if (!this.camera) return;
    const {clientWidth: width, clientHeight: height} = this.canvas;
    this.renderer.setViewport(0, 0, width, height);
    this.renderer.render(this.scene, this.camera);
    for (const lens of this.lenses.filter(({box}) => box)) {
      this.setArrowWidth(height / (this.camera.top - this.camera.bottom) / lens.sharpness);
      lens.draw(this.renderer, this.scene, this.up, height);
    }
    if (this.lenses.length > 0) this.setArrowWidth(1);
  }

  setArrowWidth(width) {
    for (const arrow of this.arrows.values()) if (arrow.object.visible) arrow.setWidth(width);
  }

  /// What stands below the picture: what an arrow's length means, what is there and what only planned or believed.
  key() {
    const line = (role, text) => element("span", {class: "key"}, element("i", {class: "arrow-key", style: `background: var(--scene-${role})`}), text);
    const believed = this.planar && (this.scenery.bodies ?? []).some((body) => body.outline);
    return [
      ...Object.entries(this.largest).filter(([, value]) => value > 0)
          .map(([kind, value]) => line(kind, `longest ${kind} ${scaled(value, kUnits[kind] ?? "", 3)}`)),
      ...(this.ghosts.length > 0 ? [line("plan", "planned")] : []),
      ...(believed ? [line("believed", this.ellipses.length > 0 ? "believed, with 1 and 2 standard deviations" : "believed")] : []),
    ];
  }

  describe() {
    const named = [...this.bodies.keys()].slice(0, 8).join(", ") + (this.bodies.size > 8 ? ` and ${this.bodies.size - 8} more` : "");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("tabindex", "0");
    this.canvas.setAttribute("aria-label", `Animation of ${this.scenery.title ?? this.table.name}; bodies: ${named}`);
  }
}
