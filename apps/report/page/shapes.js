// Shapes of scenery as meshes, in the axes of their body. Planar ones are flat and lie at z = 0.
import {
  BoxGeometry, BufferGeometry, CapsuleGeometry, CircleGeometry, CylinderGeometry, DoubleSide, EdgesGeometry, Float32BufferAttribute, Group,
  Line, LineBasicMaterial, LineLoop, LineSegments, Mesh, MeshBasicMaterial, MeshLambertMaterial, PlaneGeometry, Quaternion, Shape, ShapeGeometry,
  SphereGeometry, Vector3,
} from "three";

export const kX = new Vector3(1, 0, 0), kY = new Vector3(0, 1, 0);
const kZ = new Vector3(0, 0, 1);

export function vector(values) {
  return new Vector3(values?.[0] ?? 0, values?.[1] ?? 0, values?.[2] ?? 0);
}

/// Turns an object that points along y so that it points along `direction`.
export function pointAlong(object, direction) {
  if (direction.lengthSq() > 0) object.quaternion.setFromUnitVectors(kY, direction.clone().normalize());
}

function polyline(points, closed, material) {
  const geometry = new BufferGeometry().setFromPoints(points);
  return closed ? new LineLoop(geometry, material) : new Line(geometry, material);
}

/// A flat band of a given width along a chain of points in the plane z = 0.
export function ribbon(points, width) {
  const positions = [];
  for (let i = 0; i + 1 < points.length; ++i) {
    const along = points[i + 1].clone().sub(points[i]);
    const side = new Vector3(-along.y, along.x, 0).normalize().multiplyScalar(width / 2);
    const [a, b, c, d] = [points[i].clone().sub(side), points[i + 1].clone().sub(side), points[i + 1].clone().add(side), points[i].clone().add(side)];
    for (const p of [a, b, c, a, c, d]) positions.push(p.x, p.y, p.z);
  }
  const geometry = new BufferGeometry();
  geometry.setAttribute("position", new Float32BufferAttribute(positions, 3));
  return geometry;
}

function stadium(from, to, radius) {
  const along = to.clone().sub(from), angle = Math.atan2(along.y, along.x);
  const outline = new Shape();
  outline.absarc(to.x, to.y, radius, angle - Math.PI / 2, angle + Math.PI / 2);
  outline.absarc(from.x, from.y, radius, angle + Math.PI / 2, angle + 1.5 * Math.PI);
  return outline;
}

function outlineOf(points) {
  const outline = new Shape();
  points.forEach((p, i) => (i === 0 ? outline.moveTo(p[0], p[1]) : outline.lineTo(p[0], p[1])));
  outline.closePath();
  return outline;
}

/// The outline of a planar shape that has an inside.
function planarOutline(shape) {
  if (shape.disc) return new Shape().absarc(0, 0, shape.disc.radius, 0, 2 * Math.PI);
  if (shape.sphere) return new Shape().absarc(0, 0, shape.sphere.radius, 0, 2 * Math.PI);
  if (shape.capsule) return stadium(vector(shape.capsule.from), vector(shape.capsule.to), shape.capsule.radius);
  if (shape.polygon) return outlineOf(shape.polygon.points);
  const [w, h] = shape.box.size.map((size) => size / 2);
  return outlineOf([[-w, -h], [w, -h], [w, h], [-w, h]]);
}

/// The line around a planar shape, in its own axes; that of a ground is its surface.
export function planarLine(shape, extent) {
  if (shape.line) return shape.line.points.map(vector);
  if (shape["half-space"]) {
    const {normal, point} = shape["half-space"], along = vector(normal).normalize();
    return [-20, 20].map((far) => new Vector3(along.y, -along.x, 0).multiplyScalar(far * extent).add(vector(point)));
  }
  const points = planarOutline(shape).getPoints(32).map((p) => new Vector3(p.x, p.y, 0));
  return [...points, points[0]];
}

/// What a shape is drawn with; the colours are those of the theme and are set again when that changes.
class Paint {
  constructor(theme, role, planar) {
    const Material = planar ? MeshBasicMaterial : MeshLambertMaterial;
    this.fill = new Material({side: DoubleSide, vertexColors: planar, transparent: planar || role === "ground", depthWrite: !planar && role !== "ground"});
    this.edge = new LineBasicMaterial({transparent: true});
    theme.add(() => {
      this.fill.color.set(theme.color(role));
      this.fill.opacity = role === "ground" ? (planar ? 0.6 : 0.35) : planar ? 0.7 : 1;
      this.edge.color.set(theme.color(role === "ground" ? "ground-edge" : role));
      this.edge.opacity = role === "ground" && !planar ? 0.3 : 1;
      if (!planar && role !== "ground") this.edge.color.lerp(theme.shade(), 0.45);
    });
  }
}

/// Gives each vertex a brightness and an opacity, (x, y) -> [brightness, opacity].
function shaded(geometry, shade) {
  const positions = geometry.getAttribute("position"), colors = [];
  for (let i = 0; i < positions.count; ++i) {
    const [brightness, opacity] = shade(positions.getX(i), positions.getY(i));
    colors.push(brightness, brightness, brightness, opacity);
  }
  return geometry.setAttribute("color", new Float32BufferAttribute(colors, 4));
}

/// Darker toward the lower right of the shape itself, so that it looks like a thing and its turning shows.
function withDepth(geometry) {
  geometry.computeBoundingBox();
  const {min, max} = geometry.boundingBox, size = max.x - min.x + max.y - min.y || 1;
  return shaded(geometry, (x, y) => [1 - 0.3 * ((x - min.x + max.y - y) / size), 1]);
}

/// All below a line: a band that fades, and what is below it.
function planarGround({normal, point}, paint, extent) {
  const far = 20 * extent, fade = 0.4 * extent, group = new Group();
  const band = (from, to, opacity) => {
    const geometry = new PlaneGeometry(2 * far, from - to).translate(0, (from + to) / 2, 0);
    return new Mesh(shaded(geometry, (x, y) => [1, opacity(y)]), paint.fill);
  };
  group.add(band(0, -fade, (y) => 1 + (0.75 * y) / fade), band(-fade, -far, () => 0.25),
            polyline([new Vector3(-far, 0, 0), new Vector3(far, 0, 0)], false, paint.edge));
  group.quaternion.setFromUnitVectors(kY, vector(normal).normalize());
  group.position.copy(vector(point));
  group.userData.boundless = true;
  return group;
}

function planarShape(shape, paint, extent) {
  if (shape["half-space"]) return planarGround(shape["half-space"], paint, extent);
  const group = new Group();
  if (shape.line) {
    group.add(new Mesh(withDepth(ribbon(shape.line.points.map(vector), shape.line.width ?? 0.006 * extent)), paint.fill));
    return group;
  }
  const outline = planarOutline(shape);
  group.add(new Mesh(withDepth(new ShapeGeometry(outline, 32)), paint.fill));
  group.add(polyline(outline.getPoints(32).map((p) => new Vector3(p.x, p.y, 0)), true, paint.edge));
  // A radius shows how a disc turns.
  if (shape.disc) group.add(polyline([new Vector3(), new Vector3(shape.disc.radius, 0, 0)], false, paint.edge));
  return group;
}

function withEdges(geometry, paint) {
  const group = new Group();
  group.add(new Mesh(geometry, paint.fill), new LineSegments(new EdgesGeometry(geometry, 30), paint.edge));
  return group;
}

/// Along y from one point to another.
function between(object, from, to) {
  object.position.copy(from).add(to).multiplyScalar(0.5);
  pointAlong(object, to.clone().sub(from));
  return object;
}

/// A half-space: a large plate with lines, its outside along the normal.
function plate({normal, point}, paint, extent) {
  const size = 4 * extent, group = new Group(), lines = [];
  for (let i = 0; i <= 20; ++i) {
    const at = (i / 20 - 0.5) * size;
    lines.push(new Vector3(at, -size / 2, 0), new Vector3(at, size / 2, 0), new Vector3(-size / 2, at, 0), new Vector3(size / 2, at, 0));
  }
  group.add(new Mesh(new PlaneGeometry(size, size), paint.fill), new LineSegments(new BufferGeometry().setFromPoints(lines), paint.edge));
  group.quaternion.setFromUnitVectors(kZ, vector(normal).normalize());
  group.position.copy(vector(point));
  group.userData.boundless = true;
  return group;
}

function spatialShape(shape, paint, extent) {
  if (shape.sphere) return new Mesh(new SphereGeometry(shape.sphere.radius, 32, 20), paint.fill);
  if (shape.disc) return withEdges(new CircleGeometry(shape.disc.radius, 48), paint);
  if (shape.box) return withEdges(new BoxGeometry(...shape.box.size), paint);
  if (shape.capsule || shape.cylinder) {
    const {from, to, radius} = shape.capsule ?? shape.cylinder;
    const a = vector(from), b = vector(to), length = a.distanceTo(b);
    if (shape.capsule) return between(new Mesh(new CapsuleGeometry(radius, length, 6, 20), paint.fill), a, b);
    return between(withEdges(new CylinderGeometry(radius, radius, length, 32), paint), a, b);
  }
  if (shape.polygon) return withEdges(new ShapeGeometry(outlineOf(shape.polygon.points)), paint);
  if (shape.line) {
    const group = new Group(), points = shape.line.points.map(vector), radius = (shape.line.width ?? 0.004 * extent) / 2;
    for (let i = 0; i + 1 < points.length; ++i) {
      group.add(between(new Mesh(new CylinderGeometry(radius, radius, points[i].distanceTo(points[i + 1]), 8), paint.fill), points[i], points[i + 1]));
    }
    return group;
  }
  return plate(shape["half-space"], paint, extent);
}

/// A shape of scenery: {kind: {...}, at, axis, angle, color}. `extent` is the size of the scene, m; `role` the colour it has of itself.
export function makeShape(shape, planar, extent, role, theme) {
  const paint = new Paint(theme, shape["half-space"] ? "ground" : shape.color ?? role, planar);
  return place(shape, planar ? planarShape(shape, paint, extent) : spatialShape(shape, paint, extent));
}

/// What a shape is drawn as, put where it stands in its body.
export function place(shape, drawn) {
  if (shape.at === undefined && shape.angle === undefined) return drawn;
  const placed = new Group();
  placed.add(drawn);
  placed.position.copy(vector(shape.at));
  if (shape.angle !== undefined) placed.quaternion.copy(turn(shape.axis, shape.angle));
  return placed;
}

/// The turn by an angle about an axis, z where none is given.
export function turn(axis, angle, out = new Quaternion()) {
  return out.setFromAxisAngle(axis ? vector(axis).normalize() : kZ, angle);
}

