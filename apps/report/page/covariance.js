// Covariance matrices of two quantities, [aa, ab, bb], and their ellipses.

/// Half axes of the ellipse of one standard deviation, and the angle of the longer one.
export function principalAxes([aa, ab, bb]) {
  const middle = (aa + bb) / 2, half = (aa - bb) / 2, radius = Math.hypot(half, ab);
  return {major: Math.sqrt(Math.max(0, middle + radius)), minor: Math.sqrt(Math.max(0, middle - radius)), angle: Math.atan2(ab, half) / 2};
}

/// Of a point that is at `lever` from the origin of a body, given that of the body's x, y and angle (a lower triangle, column by column):
/// J C J' with dp = (dx, dy) + (-lever_y, lever_x) dangle.
export function propagated([xx, yx, tx, yy, ty, tt], lever) {
  const jx = -lever.y, jy = lever.x;
  return [xx + 2 * jx * tx + jx * jx * tt, yx + jx * ty + jy * tx + jx * jy * tt, yy + 2 * jy * ty + jy * jy * tt];
}
