#!/usr/bin/env python3
"""Writes delta_poses.csv beside itself: what a delta robot's kinematics and statics are at a few poses, in 50-digit arithmetic.

Independent of the library: the inverse kinematics is bisection on the distal link's length, Jacobians are differences of psi, and everything
else is the full 9-coordinate system (M, H, B, G) solved as it stands, without any of the closed forms. Needs mpmath.
"""
import pathlib

from mpmath import acos, atan2, cos, diff, lu_solve, matrix, mp, mpf, pi, sin, sqrt

mp.dps = 50

ROBOTS = {
    # l0, l1, l2, l3, lc1, lc2, M1, M2, M3, J1, J2
    "delta": [mpf(x) for x in (".1", ".2", ".45", ".05", ".08", ".225", ".15", ".06", ".1", ".002", ".0010125")],
    "delta-demo": [mpf(x) for x in ("1", "1.5", "2", ".5", ".75", "1", ".1", ".1", ".3", ".4", ".4")],
}
G0 = mpf("9.81")
POSES = [
    ("delta", ("0", "0", ".35")),
    ("delta", (".12", "-.05", ".42")),
    ("delta", ("-.08", ".15", ".30")),
    ("delta", (".03", ".17", ".50")),
    ("delta-demo", ("0", "0", "2")),
    ("delta-demo", (".7", "-.4", "1.6")),
    ("delta-demo", ("-.3", ".9", "2.3")),
]


def rotation(i):
    a = (0, 2 * pi / 3, -2 * pi / 3)[i]
    return matrix([[cos(a), -sin(a), 0], [sin(a), cos(a), 0], [0, 0, 1]])


def psi(p, q):
    l0, l1, l2, l3 = p[:4]
    return matrix([l2 * sin(q[1]) * sin(q[2]),
                   l0 - l3 + l1 * cos(q[0]) + l2 * cos(q[1]),
                   l1 * sin(q[0]) + l2 * sin(q[1]) * cos(q[2])])


def jacobian(p, q):
    columns = matrix(3, 3)
    for row in range(3):
        for k in range(3):
            columns[row, k] = diff(lambda x: psi(p, [x if j == k else q[j] for j in range(3)])[row], q[k])
    return columns


def inverse(p, z):
    l0, l1, l2, l3 = p[:4]
    q = []
    for i in range(3):
        w = rotation(i).T * z - matrix([0, l0 - l3, 0])
        length = lambda a: sqrt(w[0]**2 + (w[1] - l1 * cos(a))**2 + (w[2] - l1 * sin(a))**2) - l2
        near = atan2(w[2], w[1])           # the elbow nearest to the wrist; the outer elbow lies within half a turn before it
        low, high = near - pi, near
        assert length(low) > 0 > length(high)
        for _ in range(200):
            middle = (low + high) / 2
            low, high = (middle, high) if length(middle) > 0 else (low, middle)
        a = low
        d = (w - l1 * matrix([0, cos(a), sin(a)])) / l2
        q.append([a, acos(d[1]), atan2(d[0], d[2])])
    return q


def arm_inertia(p, q):
    _, l1, l2, _, lc1, lc2, m1, m2, m3, j1, j2 = p
    a = j1 + lc1**2 * m1 + l1**2 * (m2 + m3)
    b = l1 * (lc2 * m2 + l2 * m3)
    i = j2 + lc2**2 * m2 + l2**2 * m3
    c1, s1, c2, s2, c3, s3 = cos(q[0]), sin(q[0]), cos(q[1]), sin(q[1]), cos(q[2]), sin(q[2])
    m12, m13 = b * (c1 * c2 * c3 + s1 * s2), -b * c1 * s2 * s3
    return matrix([[a, m12, m13], [m12, i, 0], [m13, 0, i * s2**2]])


def potential(p, q):
    _, l1, l2, _, lc1, lc2, m1, m2, m3 = p[:9]
    height = lambda x: -G0 * x
    elbow = l1 * sin(q[0])
    direction = sin(q[1]) * cos(q[2])
    return height(m1 * lc1 * sin(q[0]) + m2 * (elbow + lc2 * direction) + m3 * (elbow + l2 * direction))


def row(name, z):
    p = ROBOTS[name]
    q = inverse(p, z)
    turned = [rotation(i) * jacobian(p, q[i]) for i in range(3)]
    h = matrix(6, 9)
    m = matrix(9, 9)
    g = matrix(9, 1)
    for i in range(3):
        inertia = arm_inertia(p, q[i])
        for a in range(3):
            g[3 * i + a] = diff(lambda x: potential(p, [x if j == a else q[i][j] for j in range(3)]), q[i][a])
            for b in range(3):
                m[3 * i + a, 3 * i + b] = inertia[a, b]
                for block in range(2):
                    if i == 0:
                        h[3 * block + a, b] = turned[0][a, b]
                    elif i == block + 1:
                        h[3 * block + a, 3 * i + b] = -turned[i][a, b]
    measured, others = [0, 3, 6], [1, 2, 4, 5, 7, 8]
    h_x = matrix([[h[a, b] for b in others] for a in range(6)])
    h_y = matrix([[h[a, b] for b in measured] for a in range(6)])
    gamma = matrix(9, 3)
    for k in range(3):
        gamma[measured[k], k] = 1
        x = lu_solve(h_x, -h_y[:, k])
        for a in range(6):
            gamma[others[a], k] = x[a]
    j_v = matrix(3, 9)
    for i in range(3):
        j_v[:, 3 * i:3 * i + 3] = turned[i] / 3
    system = matrix(9, 9)
    for k in range(3):
        system[measured[k], k] = 1
    system[:, 3:9] = h.T
    torque = lu_solve(system, g)
    exact = gamma.T * m * gamma
    left = matrix([[(m * gamma)[measured[a], b] for b in range(3)] for a in range(3)])
    out = [x for arm in q for x in arm]
    for table in (j_v * gamma, j_v, torque.T, exact, left):
        out += [table[a, b] for a in range(table.rows) for b in range(table.cols)]
    return out


def names():
    grid = lambda name, rows, cols: [f"{name}{a}{b}" for a in range(1, rows + 1) for b in range(1, cols + 1)]
    return (["robot", "zx", "zy", "zz"] + grid("q", 3, 3) + grid("Jc", 3, 3) + grid("Jv", 3, 9) +
            [f"tau{i}" for i in range(1, 4)] + [f"lambda{i}" for i in range(1, 7)] + grid("My", 3, 3) + grid("Left", 3, 3))


def main():
    lines = [",".join(names())]
    for name, z in POSES:
        values = row(name, matrix([mpf(x) for x in z]))
        robot = list(ROBOTS).index(name)
        lines.append(",".join([str(robot), *z] + [mp.nstr(x, 20, min_fixed=1, max_fixed=0) for x in values]))
    pathlib.Path(__file__).with_name("delta_poses.csv").write_text("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
