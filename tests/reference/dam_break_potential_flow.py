"""Collapse of a column of water on a smooth dry bed without friction, as flow with a potential.

Boundary elements on the free surface alone: walls at x = 0 and y = 0 by images, linear elements with exact integrals; the
surface moves with the water and carries its potential (Longuet-Higgins & Cokelet 1976), Runge-Kutta steps of fourth order,
even spacing anew and a five-point filter after each. Where the film at the toe is thinner than the elements can follow it is
cut. Nothing is shared with Polder: no grid, no points, no pressure solver.

Units: width of the column a = 1, gravity g = 1. Writes dam_break_potential_flow_2.csv (height 2 a),
dam_break_potential_flow_05.csv (height a / 2) and a profile of a long column (height a / 5), each with the mean of two spacings and half of
their difference.
Needs numpy and scipy; takes some minutes:  python3 dam_break_potential_flow.py
"""
import os

import numpy as np
from scipy.interpolate import CubicSpline

HERE = os.path.dirname(os.path.abspath(__file__))


def influence(x, y):
    """Matrices of the logarithm and of its normal derivative over linear elements and their images, at each node."""
    n = len(x)
    single, double = np.zeros((n, n)), np.zeros((n, n))
    xa, ya = x[:-1], y[:-1]
    length = np.hypot(np.diff(x), np.diff(y))
    tx, ty = np.diff(x) / length, np.diff(y) / length
    nx, ny = ty, -tx
    for sx, sy in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        dx, dy = sx * x[:, None] - xa, sy * y[:, None] - ya
        foot, height = dx * tx + dy * ty, dx * nx + dy * ny   # along the element, and off its line
        s1, s2 = -foot, length - foot
        r1, r2 = s1**2 + height**2, s2**2 + height**2
        l1, l2 = np.log(np.maximum(r1, 1e-300)), np.log(np.maximum(r2, 1e-300))
        on_line = np.abs(height) < 1e-14
        angle = np.where(on_line, 0, np.arctan2((s2 - s1) * height, height**2 + s1 * s2))
        log0 = 0.5 * (s2 * l2 - s1 * l1) - length + height * angle
        log1 = 0.25 * (r2 * l2 - r1 * l1) - 0.25 * (r2 - r1)
        slope0 = -angle
        slope1 = np.where(on_line, 0, -0.5 * height * (l2 - l1))
        for matrix, i0, i1 in ((single, log0, log1), (double, slope0, slope1)):
            far = (i1 + foot * i0) / length
            matrix[:, :-1] += i0 - far
            matrix[:, 1:] += far
    return single, double


def arc(x, y):
    return np.concatenate([[0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])


def rates(state):
    """d/dt of x, y and the potential at the nodes; the last node is the toe, the first the top at the wall."""
    x, y, phi = state
    single, double = influence(x, y)
    double[np.diag_indices_from(double)] -= double.sum(1)     # an even potential has no flow
    normal = np.linalg.solve(single, double @ phi)
    s = arc(x, y)
    dx, dy, dphi = (CubicSpline(s, a)(s, 1) for a in (x, y, phi))
    m = np.hypot(dx, dy)
    tx, ty, along = dx / m, dy / m, dphi / m
    u, v = along * tx + normal * ty, along * ty - normal * tx
    u[0], v[-1] = 0, 0
    # The toe's velocity has a logarithm in it: from the two nodes before it.
    u[-1] = u[-2] + (u[-2] - u[-3]) * (s[-1] - s[-2]) / (s[-2] - s[-3])
    return np.array([u, v, 0.5 * (u**2 + v**2) - y]), np.hypot(u, v)


def spread(state, n, ratio=0.5):
    """Nodes anew along the surface; elements at the toe are `ratio` times as long as at the wall."""
    s = arc(state[0], state[1])
    at = (1 - ratio ** np.linspace(0, 1, n)) / (1 - ratio) * s[-1]
    out = np.array([CubicSpline(s, a)(at) for a in state])
    for a in out:
        a[2:-2] = (-a[:-4] + 4 * a[1:-3] + 10 * a[2:-2] + 4 * a[3:-1] - a[4:]) / 16
    out[0, 0], out[1, -1] = 0, 0
    return out


def collapse(height, n, end):
    """Rows of time, front and depth at the wall; the surface at the end."""
    round_off = 0.02 * height                                   # radius of the upper edge
    quarter = np.linspace(0, np.pi / 2, 100)[1:]
    x = np.concatenate([np.linspace(0, 1 - round_off, 400), 1 - round_off * (1 - np.sin(quarter)), np.ones(800)])
    y = np.concatenate([np.full(400, height), height - round_off * (1 - np.cos(quarter)),
                        np.linspace(height - round_off, 0, 801)[1:]])
    s = arc(x, y)
    at = (1 - 0.5 ** np.linspace(0, 1, n)) / 0.5 * s[-1]
    state = np.array([np.interp(at, s, x), np.interp(at, s, y), np.zeros(n)])
    time, rows = 0.0, []
    while time < end:
        rows.append((time, state[0, -1], state[1, 0]))
        k1, speed = rates(state)
        ds = np.hypot(np.diff(state[0]), np.diff(state[1]))
        step = min(0.01, 0.3 * np.min(ds / np.maximum(1e-9, np.maximum(speed[1:], speed[:-1]))), 0.3 * np.sqrt(ds.min()))
        k2 = rates(state + 0.5 * step * k1)[0]
        k3 = rates(state + 0.5 * step * k2)[0]
        k4 = rates(state + step * k3)[0]
        state = state + step / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        state[0, 0], state[1, -1] = 0, 0
        time += step
        film = max(1e-3 * height, 0.2 * np.hypot(*(state[:2, -2] - state[:2, -3])))
        keep = np.ones(state.shape[1], bool)
        keep[-10:-1] = state[1, -10:-1] > film
        state = spread(state[:, keep], n)
    return np.array(rows), state


def write(name, height, end):
    times = np.linspace(0, end, 49)
    both = [collapse(height, n, 1.02 * end)[0] for n in (120, 160)]
    runs = [np.array([np.interp(times, r[:, 0], r[:, k]) for k in (1, 2)]) for r in both]
    mean, spread_of = 0.5 * (runs[0] + runs[1]), 0.5 * np.abs(runs[0] - runs[1])
    with open(os.path.join(HERE, name), "w") as out:
        out.write(f"# COMPUTED potential flow, column of water a wide and {height} a high on a bed without friction: front and depth at "
                  "the wall, boundary elements, see dam_break_potential_flow.py; h_over_a=%g\n" % height)
        out.write("t_sqrt_g_over_a[-],front_over_a[-],wall_depth_over_a[-],front_uncertainty[-],depth_uncertainty[-]\n")
        for i, t in enumerate(times):
            out.write("%.5g,%.4f,%.4f,%.4f,%.4f\n" % (t, mean[0, i], mean[1, i], spread_of[0, i], spread_of[1, i]))


def write_profile(name, height, end):
    """Depth over the column's height against the distance from its edge over its height."""
    at = np.linspace(-3.5, 4.5, 41)
    both = []
    for n in (160, 220):
        x, y, _ = collapse(height, n, end)[1]
        both.append(np.interp(at, (x - 1) / height, y / height, right=0))
    with open(os.path.join(HERE, name), "w") as out:
        out.write("# COMPUTED potential flow, column of water a wide and %g a high at t sqrt(g/h) = %g: its surface, see "
                  "dam_break_potential_flow.py\n" % (height, end / np.sqrt(height)))
        out.write("x_over_h[-],depth_over_h[-],uncertainty[-]\n")
        for k, x in enumerate(at):
            out.write("%.4g,%.4f,%.4f\n" % (x, 0.5 * (both[0][k] + both[1][k]), 0.5 * abs(both[0][k] - both[1][k])))


if __name__ == "__main__":
    write("dam_break_potential_flow_2.csv", 2.0, 2.4)
    write("dam_break_potential_flow_05.csv", 0.5, 1.68)
    write_profile("dam_break_potential_flow_02_profile.csv", 0.2, np.sqrt(9.81 / 5))
