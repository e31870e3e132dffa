// Bodies of scenery, placed by the columns they are bound to; links and arrows between points of them.
import {BufferGeometry, ConeGeometry, CylinderGeometry, DoubleSide, Float32BufferAttribute, Group, Line, LineBasicMaterial, Mesh,
        MeshBasicMaterial, Quaternion, Vector3} from "three";
import {bind, bindVector} from "./binding.js";
import {outlines} from "./sketch.js";
import {kX, makeShape, pointAlong, ribbon, turn} from "./shapes.js";

const kTrailPoints = 2000;

/// One body: position, and a turn as an angle about an axis or as a quaternion (w, x, y, z), in the axes of its parent.
export class Body {
  constructor(json, table, planar, extent, role, theme) {
    this.json = json;
    this.group = new Group();
    this.position = bindVector(json.position, table);
    this.angle = json.angle === undefined ? undefined : bind(json.angle, table);
    this.quaternion = json.quaternion?.map((value) => bind(value, table));
    if (json.outline && planar) this.group.add(outlines(json.shapes, json.color ?? "believed", extent, theme));
    else for (const shape of json.shapes ?? []) this.group.add(makeShape(shape, planar, extent, json.color ?? role, theme));
  }

  place(k, f) {
    const {group} = this;
    group.position.set(...this.position.map((value) => value(k, f)));
    if (this.quaternion) {
      const [w, x, y, z] = this.quaternion.map((value) => value(k, f));
      group.quaternion.set(x, y, z, w).normalize();
    } else if (this.angle) {
      turn(this.json.axis, this.angle(k, f), group.quaternion);
    }
  }
}

/// A point of a body, or of the world where no body is named.
class Anchor {
  constructor(json, bodies, table) {
    this.body = json?.body === undefined ? undefined : bodies.get(json.body);
    this.at = bindVector(json?.at, table);
  }

  world(k, f, out) {
    out.set(...this.at.map((value) => value(k, f)));
    return this.body ? this.body.group.localToWorld(out) : out;
  }
}

const kCoils = 9;

function springRibbon(width) {
  const points = [new Vector3(0, 0, 0), new Vector3(0.1, 0, 0)];
  for (let i = 0; i < 2 * kCoils; ++i) points.push(new Vector3(0.1 + 0.8 * (i + 0.5) / (2 * kCoils), (i % 2 ? -1 : 1) * 3.5 * width, 0));
  points.push(new Vector3(0.9, 0, 0), new Vector3(1, 0, 0));
  return ribbon(points, width);
}

/// A rod, a rope or a spring between two points; it is as long as they are apart.
export class Link {
  constructor(json, bodies, table, planar, extent, theme) {
    this.from = new Anchor(json.from, bodies, table);
    this.to = new Anchor(json.to, bodies, table);
    const width = json.width ?? (json.kind === "rod" ? 0.009 : 0.006) * extent;
    const material = new MeshBasicMaterial({side: DoubleSide});
    theme.add(() => material.color.set(theme.color(json.color ?? "link")));
    this.alongX = planar || json.kind === "spring";
    const geometry = json.kind === "spring" ? springRibbon(0.7 * width)
                     : planar ? ribbon([new Vector3(0, 0, 0), new Vector3(1, 0, 0)], width)
                              : new CylinderGeometry(width / 2, width / 2, 1, 10).translate(0, 0.5, 0);
    this.object = new Mesh(geometry, material);
    this.object.frustumCulled = false;
  }

  place(k, f) {
    const a = this.from.world(k, f, this.object.position), b = this.to.world(k, f, new Vector3());
    const along = b.sub(a), length = along.length();
    if (this.alongX) {
      this.object.scale.set(length, 1, 1);
      if (length > 0) this.object.quaternion.setFromUnitVectors(kX, along.divideScalar(length));
    } else {
      this.object.scale.set(1, length, 1);
      pointAlong(this.object, along);
    }
  }
}

/// A vector drawn at a point: a force, a torque, a velocity; or the sum of other arrows.
export class Arrow {
  constructor(json, bodies, arrows, table, extent, theme) {
    this.json = json;
    this.kind = json.kind ?? "force";
    this.anchor = new Anchor(json, bodies, table);
    this.frame = json.frame === undefined ? this.anchor.body : bodies.get(json.frame);  // none: the world's axes
    this.parts = json.sum?.map((name) => arrows.get(name));
    this.components = bindVector(json.vector, table);
    this.scale = json.scale;  // m of picture per unit
    this.object = new Group();
    const material = new MeshBasicMaterial({transparent: true, depthTest: false});
    theme.add(() => material.color.set(theme.color(json.color ?? (json.sum ? "resultant" : this.kind))));
    this.radius = (json.sum ? 0.011 : 0.007) * extent;
    this.shaft = new Mesh(new CylinderGeometry(this.radius, this.radius, 1, 12).translate(0, 0.5, 0), material);
    this.head = new Mesh(new ConeGeometry(2.8 * this.radius, 7 * this.radius, 16).translate(0, -3.5 * this.radius, 0), material);
    this.object.add(this.shaft, this.head);
    this.object.renderOrder = this.shaft.renderOrder = this.head.renderOrder = 10;
    this.value = new Vector3();
  }

  /// The vector itself, in world axes; the bodies are placed already.
  measure(k, f) {
    if (this.parts) {
      this.value.set(0, 0, 0);
      for (const part of this.parts) this.value.add(part.measure(k, f));
      return this.value;
    }
    this.value.set(...this.components.map((value) => value(k, f)));
    return this.frame ? this.value.applyQuaternion(this.frame.group.getWorldQuaternion(new Quaternion())) : this.value;
  }

  place(k, f) {
    this.length = this.measure(k, f).length() * this.scale;
    this.object.visible = this.length > 2 * this.radius;
    if (!this.object.visible) return;
    this.anchor.world(k, f, this.object.position);
    pointAlong(this.object, this.value);
    this.setWidth(1);
  }

  /// How thick it is drawn: in a lens it is no thicker than beside it.
  setWidth(width) {
    const radius = width * this.radius, head = width * Math.min(1, this.length / (14 * radius));
    this.shaft.scale.set(width, Math.max(1e-9, this.length - 7 * this.radius * head), width);
    this.head.position.y = this.length;
    this.head.scale.setScalar(head);
  }
}

/// The path of a body's origin: all of it faint, what is behind in full colour.
export class Trail {
  constructor(body, table, place, theme) {
    const count = Math.min(kTrailPoints, table.kept);
    this.rows = Array.from({length: count}, (_, i) => Math.round((i * (table.kept - 1)) / Math.max(1, count - 1)));
    const positions = [];
    for (const k of this.rows) {
      place(k);
      const p = body.group.getWorldPosition(new Vector3());
      positions.push(p.x, p.y, p.z);
    }
    const geometry = () => new BufferGeometry().setAttribute("position", new Float32BufferAttribute(positions, 3));
    const line = (opacity) => new Line(geometry(), new LineBasicMaterial({transparent: true, opacity}));
    this.whole = line(0.25);
    this.past = line(0.9);
    theme.add(() => [this.whole, this.past].forEach((l) => l.material.color.set(theme.color("trail"))));
    this.object = new Group();
    this.object.add(this.whole, this.past);
  }

  place(k) {
    let n = 0;
    while (n < this.rows.length && this.rows[n] <= k) ++n;
    this.past.geometry.setDrawRange(0, n);
  }
}

