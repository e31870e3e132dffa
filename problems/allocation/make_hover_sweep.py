#!/usr/bin/env python3
"""Writes hover_sweep.csv beside itself: 60 s of hovering in all orientations at 240 Hz, a wrench log for `tenon allocate momav`.

The wrench never changes in world axes: the weight, 2.5 kg * 9.80665 m/s^2, upward, and no torque. The attitude (body to world) does: the
direction of gravity in the body

  - runs once round each of the three great circles through the arm axes +-x_i. Gravity along an arm axis is where that arm's thrust no
    longer matters and its angle is undefined; all six such directions are crossed at speed, twice each, and every crossing is a row;
  - winds over the whole sphere in a spiral about the body's vertical, from upside down to level, with near misses of the same directions.

It starts and ends level and at rest. Attitudes are a C2 cubic spline of quaternions through the knots below, normalised; from knot to knot
the body takes the shortest turn, and a slow yaw spread over the minute undoes the heading that these turns add up to.
"""
import math
import pathlib

RATE = 240            # Hz
DURATION = 60         # s
WEIGHT = 2.5 * 9.80665

# Arm axes of momav in the body, as in its table; arms 4, 5 and 6 have the opposite ones. They are orthogonal.
ARM_AXES = [(0.816496, 0, 0.577352), (0.408248, 0.707106, -0.577352), (-0.408248, 0.707106, 0.577352)]
UP = (0.0, 0.0, 1.0)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def unit(a):
    norm = math.sqrt(dot(a, a))
    return tuple(x / norm for x in a)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def angle(a, b):
    n = cross(a, b)
    return math.atan2(math.sqrt(dot(n, n)), dot(a, b))


def multiply(p, q):
    """Quaternions as (w, x, y, z)."""
    w = p[0] * q[0] - dot(p[1:], q[1:])
    v = cross(p[1:], q[1:])
    return (w,) + tuple(p[0] * q[k] + q[0] * p[k] + v[k - 1] for k in (1, 2, 3))


def up_in_body(q):
    """The last row of the rotation matrix: the body's image of the world's vertical."""
    w, x, y, z = q
    return (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))


def of_arms(a, b, c):
    """The direction a x_1 + b x_2 + c x_3."""
    axes = [unit(axis) for axis in ARM_AXES]
    return unit(tuple(a * axes[0][k] + b * axes[1][k] + c * axes[2][k] for k in range(3)))


def knots():
    """Directions of the world's vertical in the body, 20 to 55 degrees from one to the next."""
    level_to_first = [UP, of_arms(2, -1, 1)]
    first = [(1, 0, 0), (1, 1, 0), (0, 1, 0), (-1, 1, 0), (-1, 0, 0), (-1, -1, 0), (0, -1, 0), (1, -1, 0), (1, 0, 0)]
    second = [(1, 0, 1), (0, 0, 1), (-1, 0, 1), (-1, 0, 0), (-1, 0, -1), (0, 0, -1), (1, 0, -1)]
    bend = [(1, 1, -1)]
    third = [(0, 1, 0), (0, 1, 1), (0, 0, 1), (0, -1, 1), (0, -1, 0), (0, -1, -1), (0, 0, -1)]
    circles = [of_arms(*direction) for direction in first + second + bend + third]

    turns, step = 9, 0.7                                               # rad from knot to knot along the spiral
    spiral, theta = [], math.pi                                         # angle to the body's vertical
    while theta > step / 2:
        azimuth = 2 * turns * (math.pi - theta)
        spiral.append((math.sin(theta) * math.cos(azimuth), math.sin(theta) * math.sin(azimuth), math.cos(theta)))
        theta -= step / math.hypot(1, 2 * turns * max(math.sin(theta), 0.07))
    return level_to_first + circles + spiral + [UP]


def knot_attitudes(directions):
    """q_{k+1} = q_k r, where r undoes the shortest turn from one direction to the next in the body."""
    attitudes = [(1.0, 0.0, 0.0, 0.0)]
    for here, there in zip(directions, directions[1:]):
        turn = unit((1 + dot(here, there),) + cross(there, here))
        attitudes.append(unit(multiply(attitudes[-1], turn)))
    return attitudes


def knot_rows(directions):
    """Even speed, half of it in the first and last piece; whole rows, so that every knot is one."""
    spans = [angle(here, there) for here, there in zip(directions, directions[1:])]
    spans[0] *= 2
    spans[-1] *= 2
    rows, total = [0], 0.0
    for span in spans:
        total += span
        rows.append(round((RATE * DURATION - 1) * total / sum(spans)))
    return rows


def clamped_spline(s, values):
    """Slopes at the knots of the C2 cubic spline that starts and ends at rest (Thomas algorithm)."""
    n = len(s)
    h = [s[k + 1] - s[k] for k in range(n - 1)]
    upper, right = [0.0], [[0.0] * 4]
    for k in range(1, n - 1):
        lower = h[k]
        pivot = 2 * (h[k - 1] + h[k]) - lower * upper[k - 1]
        secants = [3 * (h[k] * (values[k][i] - values[k - 1][i]) / h[k - 1] + h[k - 1] * (values[k + 1][i] - values[k][i]) / h[k])
                   for i in range(4)]
        upper.append(h[k - 1] / pivot)
        right.append([(secants[i] - lower * right[k - 1][i]) / pivot for i in range(4)])
    slopes = [[0.0] * 4 for _ in range(n)]
    for k in range(n - 2, 0, -1):
        slopes[k] = [right[k][i] - upper[k] * slopes[k + 1][i] for i in range(4)]
    return slopes


def attitudes():
    """One unit quaternion for each row."""
    directions = knots()
    values, rows = knot_attitudes(directions), knot_rows(directions)
    slopes = clamped_spline(rows, values)
    heading = 2 * math.atan2(values[-1][3], values[-1][0])
    result, k = [], 0
    for row in range(rows[-1] + 1):
        while row > rows[k + 1]:
            k += 1
        h = rows[k + 1] - rows[k]
        s = (row - rows[k]) / h
        q = [(1 + 2 * s) * (1 - s) ** 2 * values[k][i] + s * s * (3 - 2 * s) * values[k + 1][i]
             + h * s * (1 - s) * ((1 - s) * slopes[k][i] - s * slopes[k + 1][i]) for i in range(4)]
        s = row / rows[-1]
        yaw = -heading * s * s * (3 - 2 * s)
        result.append(multiply((math.cos(yaw / 2), 0.0, 0.0, math.sin(yaw / 2)), unit(q)))
    return result


def write(path, log):
    with open(path, "w", encoding="ascii", newline="\n") as file:
        file.write("t,Fx,Fy,Fz,Mx,My,Mz,qw,qx,qy,qz\n")
        for row, q in enumerate(log):
            numbers = [row / RATE, 0, 0, WEIGHT, 0, 0, 0, *(round(x, 12) + 0.0 for x in q)]
            file.write(",".join(f"{x:.12g}" for x in numbers) + "\n")


def report(log):
    ups = [up_in_body(q) for q in log]
    rates = [2 * RATE * math.atan2(math.sqrt(dot(d[1:], d[1:])), abs(d[0]))
             for d in (multiply((p[0], -p[1], -p[2], -p[3]), q) for p, q in zip(log, log[1:]))]
    print(f"{len(log)} rows; peak rate {max(rates):.3f} rad/s, mean {sum(rates) / len(rates):.3f}, "
          f"first {rates[0]:.1e}, last {rates[-1]:.1e}")
    for i, axis in enumerate(ARM_AXES * 2):
        singular = unit(axis if i < 3 else tuple(-x for x in axis))
        angles = [angle(up, singular) for up in ups]
        nearest = min(range(len(log)), key=angles.__getitem__)
        minima = [math.degrees(b) for a, b, c in zip(angles, angles[1:], angles[2:]) if b <= a and b < c and b < math.radians(15)]
        print(f"arm axis {i + 1}: least angle {angles[nearest]:.1e} rad in row {nearest}; passes below 15 deg: "
              + ", ".join(f"{x:.2f}" for x in minima))
    golden = math.pi * (3 - math.sqrt(5))
    gaps = []
    for k in range(500):
        height = 1 - (2 * k + 1) / 500
        radius = math.sqrt(1 - height * height)
        point = (radius * math.cos(golden * k), radius * math.sin(golden * k), height)
        gaps.append(math.acos(min(1.0, max(dot(point, up) for up in ups[::12]))))
    print(f"no direction is further than {math.degrees(max(gaps)):.1f} deg from the log")


if __name__ == "__main__":
    log = attitudes()
    write(pathlib.Path(__file__).with_name("hover_sweep.csv"), log)
    report(log)
