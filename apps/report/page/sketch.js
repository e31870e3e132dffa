// What is planned or believed, not there: lines some pixels wide, however far one looks in. Planar scenes.
import {CircleGeometry, DoubleSide, Group, Mesh, MeshBasicMaterial, Vector3} from "three";
import {Line2} from "three/examples/jsm/lines/Line2.js";
import {LineGeometry} from "three/examples/jsm/lines/LineGeometry.js";
import {LineMaterial} from "three/examples/jsm/lines/LineMaterial.js";
import {bind, bindVector, numbered} from "./binding.js";
import {principalAxes, propagated} from "./covariance.js";
import {place, planarLine, turn} from "./shapes.js";

const kNearest = 0.75, kFarthest = 0.15;  // opacity of the first and the last ghost
const kDeviations = [1, 2];

/// A chain of points as a line some pixels wide.
export function stroke(points, role, theme, {width = 1.5, opacity = 1, order = 5} = {}) {
  const material = new LineMaterial({linewidth: width, transparent: true, opacity, depthTest: false});
  theme.add(() => material.color.set(theme.color(role)));
  const line = new Line2(new LineGeometry().setPositions(points.flatMap((p) => [p.x, p.y, 0])), material);
  line.renderOrder = order;
  line.frustumCulled = false;
  return line;
}

/// The outlines of a body's shapes.
export function outlines(shapes, role, extent, theme, look) {
  const group = new Group();
  for (const shape of shapes ?? []) {
    const drawn = place(shape, stroke(planarLine(shape, extent), role, theme, look));
    drawn.userData.boundless = shape["half-space"] !== undefined;
    group.add(drawn);
  }
  return group;
}

/// A body's outlines where a plan has it next, and after that.
export class Ghosts {
  constructor(json, bodies, table, extent, theme) {
    const {shapes} = bodies.get(json.body).json;
    this.object = new Group();
    this.ghosts = Array.from({length: json.count}, (_, i) => {
      const opacity = kNearest + (kFarthest - kNearest) * (i / Math.max(1, json.count - 1));
      const group = outlines(shapes, "plan", extent, theme, {width: 1.2, opacity});
      this.object.add(group);
      return {group, position: bindVector((json.position ?? []).map((value) => numbered(value, i + 1)), table),
              angle: bind(numbered(json.angle ?? 0, i + 1), table)};
    });
  }

  place(k, f) {
    for (const {group, position, angle} of this.ghosts) {
      group.position.set(...position.map((value) => value(k, f)));
      turn(undefined, angle(k, f), group.quaternion);
    }
  }
}

/// How surely a point of a body is known: ellipses of one and two standard deviations about it.
export class Ellipse {
  constructor(json, bodies, table, theme) {
    this.body = bodies.get(json.body).group;
    this.at = new Vector3(...(json.at ?? []), 0);
    this.covariance = json.covariance.map((value) => bind(value, table));
    this.object = new Group();
    const circle = Array.from({length: 65}, (_, i) => new Vector3(Math.cos((i * Math.PI) / 32), Math.sin((i * Math.PI) / 32), 0));
    const fill = new MeshBasicMaterial({transparent: true, opacity: 0.13, depthTest: false, side: DoubleSide});
    theme.add(() => fill.color.set(theme.color("believed")));
    for (const deviations of kDeviations) {
      const inside = new Mesh(new CircleGeometry(deviations, 48), fill);
      inside.renderOrder = 6;
      const line = stroke(circle, "believed", theme, {width: 1.2, order: 7});
      line.scale.setScalar(deviations);
      this.object.add(inside, line);
    }
  }

  place(k, f) {
    const center = this.body.localToWorld(this.object.position.copy(this.at)), lever = center.clone().sub(this.body.getWorldPosition(new Vector3()));
    const {major, minor, angle} = principalAxes(propagated(this.covariance.map((value) => value(k, f)), lever));
    const least = 1e-6 * (major || 1);  // a scale of 0 has no inverse
    this.axes = [major, minor];
    this.object.scale.set(major || least, Math.max(minor, least), 1);
    turn(undefined, angle, this.object.quaternion);
  }
}
