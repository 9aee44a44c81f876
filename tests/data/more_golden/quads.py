"""Surfaces on a rectangle."""
from .common import (FUN, H, TERMS, Vec, bezier, boolean, bspline, case, de_boor, digits, formula, function, hermite, hermite_values, line, mpf,
                     slope, total, vec)

INSIDE = [(0.25, 0.375), (0.8, 0.3), (0.4, 0.95)]
UNIT = INSIDE + [(0, 0.4), (0.7, 1), (1, 0)]
LINEAR = [lambda t: 1 - t, lambda t: t]
PARTS = ("sum", "P1", "P2", "P1P2")


def product(nodes, t="t"): return "*".join("(%s - (%s))" % (t, x) for x in nodes)


def lagrange(nodes):
    nodes = [mpf(str(x)) for x in nodes]

    def polynomial(i):
        def at(t):
            y = mpf(1)
            for k, n in enumerate(nodes):
                if k != i:
                    y *= (t - n) / (nodes[i] - n)
            return y
        return at
    return [polynomial(i) for i in range(len(nodes))]


def hats(nodes):
    """C1 hats over any nodes; at a node the cell to the right."""
    nodes = [mpf(str(x)) for x in nodes]

    def hat(i):
        def at(t):
            cell = max(k for k in range(len(nodes) - 1) if k == 0 or nodes[k] <= t)
            s = (t - nodes[cell]) / (nodes[cell + 1] - nodes[cell])
            return H[0](s) if i == cell else H[3](s) if i == cell + 1 else mpf(0)
        return at
    return [hat(i) for i in range(len(nodes))]


def gordon():
    un, vn = [0, 0.3, 1], [-1, 0.2, 0.5, 2]
    g = [line("u", v, bump=(product(un), (0.5, 1 - j, j))) for j, v in enumerate(vn)]
    f = [line("v", u, bump=(product(vn), (0.3 * i, 0.2, -0.3)), domain=(-1, 2)) for i, u in enumerate(un)]
    inside = [(0.25, 0.375), (0.8, -0.3), (0.4, 1.4), (0.1, 0.1), (0.3, 0), (0.65, 2)]
    surface = {"type": "gordon", "u_curves": g, "v_nodes": vn, "v_curves": f, "u_nodes": un}
    for name, blends in (("lagrange", lagrange), ("hermite", hats)):
        # no second derivatives of hats on the line u = 0.3, where they jump
        points = [p for p in inside if name == "lagrange" or p[0] != 0.3]
        for part in PARTS:
            x = boolean(part, blends(un), blends(vn), f, g, lambda i, j, u, v: f[i](mpf(str(vn[j]))))
            case("gordon_%s_%s" % (name, part), surface | {"blend": name, "part": part}, x, points)


def lagrange_surface():
    nodes = [0, 0.5, 2, 3]
    curves = [formula(["t", "sin(t) + 1", "t^2/4"], 0, 2), bezier([[0, 1, 0], [1, 2, 2], [2, 1, 1]], [1, 2, 0.5]),
              bspline(2, [0, 0, 0, 0.3, 1, 1, 1], [[0, 2, 1], [1, 2, 0], [1.5, 3, 0], [2, 2, 0]]), formula(["2*t", "3", "exp(-t)"], -1, 1)]
    over = [c.over(0, 2) for c in curves]  # u runs over the domain of the first
    blends = lagrange(nodes)
    case("lagrange", {"type": "lagrange", "curves": curves, "nodes": nodes}, lambda u, v: total(b(v) * c(u) for b, c in zip(blends, over)),
         [(0.3, 0.25), (1.7, 1), (0.9, 2.75), (1.25, 0), (2, 3)])


def generalized():
    """u: value at 0, derivative at 0, value at 1; v: value at 0, value and derivative at 1."""
    hu = ["cos(pi*t/2)^2", "t*(1 - t)*exp(-t)", "sin(pi*t/2)^2"]
    hv = ["1 - sin(pi*t/2)", "sin(pi*t/2)", "t*(t - 1)*exp(t - 1)"]
    in_u, in_v = "t^2*(1 - t)", "t*(1 - t)^2"  # what the functionals of u and of v do not see
    f = [line("v", 0, bump=(in_v, (1, 2, 0))), line("v", 0, 1, bump=(in_v, (0, 1, -2))), line("v", 1, bump=(in_v, (1, 0, 2)))]
    g = [line("u", 0, bump=(in_u, (0, 2, 1))), line("u", 1, bump=(in_u, (1, -1, 1))), line("u", 1, 1, bump=(in_u, (2, 0, 3)))]
    m = [[f[i](mpf(0)), f[i](mpf(1)), slope(f[i])(mpf(1))] for i in range(3)]
    surface = {"type": "generalized_coons", "f": f, "g": g,
               "u": {"functionals": [{"value": 0}, {"derivative": 0}, {"value": 1}], "blends": hu},
               "v": {"functionals": [{"value": 0}, {"value": 1}, {"derivative": 1}], "blends": hv}}
    for part in PARTS:
        x = boolean(part, [function(t) for t in hu], [function(t) for t in hv], f, g, lambda i, j, u, v: m[i][j])
        case("generalized_" + part, surface | {"part": part}, x, UNIT)


# ---- frames ---------------------------------------------------------------------------------------------------------------
def coons(part, blend, c0, c1, d0, d1):
    return boolean(part, blend, blend, [d0, d1], [c0, c1], lambda i, j, u, v: (d0, d1)[i](mpf(j)))


def frames():
    corner = [[0, 0, 0], [2, 0, 1], [0.3, 2, 1], [2, 2.5, 0]]  # (0,0) (1,0) (0,1) (1,1)
    c0 = bezier([corner[0], [1, -1, 2], corner[1]], [1, 2, 0.7])
    c1 = formula(["0.3 + 1.7*t", "2 + 0.5*t + 0.4*sin(pi*t)", "1 - t + t*(1 - t)*exp(t)"])
    d0 = formula(["0.3*t^2", "2*t + sin(pi*t)/3", "t*exp(t - 1)"])
    d1 = bezier([corner[1], [3, 1, 0], [1, 2, -1], corner[3]], [2, 0.5, 1, 1.5])
    surface = {"c0": c0, "c1": c1, "d0": d0, "d1": d1}
    other = function("(exp(t) - 1)/(exp(1) - 1)")
    for name, text, blend in (("linear", "linear", LINEAR), ("cubic", "cubic", [H[0], H[3]]),
                              ("exp", "(exp(t) - 1)/(exp(1) - 1)", [lambda t: 1 - other(t), other])):
        for part in PARTS if name == "exp" else ("sum",):
            case("coons_%s_%s" % (name, part), surface | {"type": "coons", "blend": text, "part": part}, coons(part, blend, c0, c1, d0, d1), UNIT)
    case("translational_blend", surface | {"type": "translational_blend"}, coons("sum", LINEAR, c0, c1, d0, d1), UNIT)
    case("ruled", {"type": "ruled", "c0": c0, "c1": c1}, lambda u, v: (1 - v) * c0(u) + v * c1(u), UNIT)
    spline = bspline(3, [0, 0, 0, 0, 1, 3, 4, 4, 4, 4], [[0, 0, 0], [1, 2, 0], [2, -1, 1], [3, 1, 0], [4, 0, 2], [5, 1, 1]], [1, 0.5, 2, 1, 1.5, 1])
    s = spline.over()
    apex = [1, 2, 5]
    case("cone", {"type": "cone", "curve": spline, "apex": apex}, lambda u, v: (1 - v) * s(u) + v * vec(apex), [(0.3, 0.5), (0.8, 0.125), (0.6, 0), (0.9, 0.9)])
    turn = hermite([[0, 0, 0], [0, 1, 1], [1, 2, 1], [0, 3, 0]], [[1, 1, 0], [0, 1, 1], [0.5, 1, -1], [-1, 0, 1]])
    t = turn.over()
    case("translational", {"type": "translational", "c": spline, "d": turn}, lambda u, v: s(u) + t(v) - s(mpf(0)), [(0.2, 0.5), (0.9, 0.1), (0.6, 0.8), (0, 0.2), (0.5, 1)])


def spline_from(degree, knots, points, begin, end):
    """The spline with these points, the first and the last moved so that it begins and ends where it should."""
    p, k = [vec(x) for x in points], [mpf(str(x)) for x in knots]
    n = len(p)
    value = lambda points, t: de_boor(degree, k, points, [mpf(1)] * n, t)
    for index, t, target in ((0, k[degree], begin), (n - 1, k[n], end)):
        one = [Vec([mpf(i == index)] * 3) for i in range(n)]
        p[index] += (target - value(p, t)) / value(one, t)[0]
    return bspline(degree, knots, p)


def control_nets():
    corner = [vec(p) for p in ([0, 0, 0], [4, 0, 1], [0.5, 3, 1], [4, 3.5, 0])]
    cubic = [[[0, 0, 0], [1, -0.5, 1], [1.5, 0.3, -1], [2.5, 0, 0.5], [3.2, 0.2, 1], [4, 0, 1]], [[0, 3, 1], [1, 3.5, 0], [1.8, 3, 2], [2.4, 2.7, 1], [3, 3.3, 0], [4, 3, 0]]]
    quadratic = [[[0, 0, 0], [-0.4, 0.8, 1], [0.3, 1.5, 0.5], [0.2, 2.4, 2], [0.5, 3, 1]], [[4, 0, 1], [4.5, 1, 0], [3.8, 1.5, -1], [4.2, 2.6, 0], [4, 3.5, 0]]]
    for name, ku, kv in (("clamped", [0, 0, 0, 0, 1, 1.5, 4, 4, 4, 4], [-1, -1, -1, 0, 0.25, 2, 2, 2]),
                         ("unclamped", [-2, -1, -0.5, 0, 1, 1.5, 4, 5, 5.5, 7], [-3, -2, -1, 0, 0.25, 2, 2.5, 4])):
        c = [spline_from(3, ku, p, corner[2 * i], corner[2 * i + 1]) for i, p in enumerate(cubic)]
        d = [spline_from(2, kv, p, corner[i], corner[2 + i]) for i, p in enumerate(quadratic)]
        case("control_net_" + name, {"type": "control_net", "c0": c[0], "c1": c[1], "d0": d[0], "d1": d[1]},
             coons("sum", LINEAR, c[0].over(), c[1].over(), d[0].over(), d[1].over()), [(0.125, 0.2), (0.3, 0.375), (0.8, 0.9), (0, 0.6), (0.9, 1)])


# ---- networks: blends, data and corner data by cell ---------------------------------------------------------------------------
def hermite_blends(m):
    """Value at 0, slope at 0, value at 1, slope at 1, ... over [0,m]; at a node the cell to the right."""
    def blend(k):
        def at(t):
            cell = min(int(t), m - 1)
            place = {2 * cell: 0, 2 * cell + 1: 1, 2 * cell + 3: 2, 2 * cell + 2: 3}.get(k)
            return H[place](t - cell) if place is not None else mpf(0)
        return at
    return [blend(k) for k in range(2 * m + 2)]


def network(part, twist, a, A, b, B):
    """A[i] = x_u(i, .), B[j] = x_v(., j); the corner data are theirs, the twists as `twist` says."""
    m, n = len(a) - 1, len(b) - 1
    f = [c for pair in zip(a, A) for c in pair]
    g = [c for pair in zip(b, B) for c in pair]
    derivative_A, derivative_B = {}, {}
    for i in range(m + 1):
        for j in range(n + 1):
            derivative_A[i, j], derivative_B[i, j] = slope(A[i])(mpf(j)), slope(B[j])(mpf(i))

    def corner(k, l, u, v):
        i, j = k // 2, l // 2
        if k % 2 == 0:
            return f[k](mpf(j)) if l % 2 == 0 else g[l](mpf(i))
        if l % 2 == 0:
            return f[k](mpf(j))
        x, y = derivative_A[i, j], derivative_B[i, j]
        if twist == "gregory":  # the weight of d/dv x_u is the distance to u = const
            near = lambda t, k, last: t - k if k == min(int(t), last - 1) else k - t
            p, q = near(u, i, m), near(v, j, n)
            return (p * x + q * y) / (p + q)
        return {"average": (x + y) / 2, "zero": x * 0, "compatible": x}[twist]
    return boolean(part, hermite_blends(m), hermite_blends(n), f, g, corner)


def differences(r):
    m = len(r) - 1
    inner = [None] + [(lambda t, i=i: (r[i + 1](t) - r[i - 1](t)) / 2) for i in range(1, m)]
    return [lambda t: 2 * r[1](t) - 2 * r[0](t) - inner[1](t)] + inner[1:] + [lambda t: 2 * r[m](t) - 2 * r[m - 1](t) - inner[m - 1](t)]


def networks():
    m, n = 2, 3
    points = [(0.25, 0.375), (0.8, 1.3), (1.4, 2.95), (1.125, 0.5), (0, 1.4), (1.7, 3), (2, 2.25)]
    flat = "sin(pi*t)^2"  # value and slope vanish at the whole numbers; of sin(pi t) the value alone does
    a = [line("v", i, bump=(flat, (0.2, 0.1 * i, 0.3)), domain=(0, n)) for i in range(m + 1)]
    b = [line("u", j, bump=(flat, (0.1, -0.2, 0.1 * j)), domain=(0, m)) for j in range(n + 1)]
    surface = {"type": "network", "a": a, "b": b}
    for twist, part in (("average", "sum"), ("gregory", "sum"), ("zero", "sum"), ("average", "P1"), ("average", "P2"), ("average", "P1P2"), ("gregory", "P1P2")):
        case("network_differences_%s_%s" % (twist, part), surface | {"twist": twist, "part": part}, network(part, twist, a, differences(a), b, differences(b)), points)
    A = [line("v", i, 1, bump=("sin(pi*t)", (0.2 * i, 0.3, -0.2)), domain=(0, n)) for i in range(m + 1)]
    B = [line("u", j, 1, bump=("sin(pi*t)", (-0.3, 0.1 * j, 0.25)), domain=(0, m)) for j in range(n + 1)]
    for twist in ("average", "gregory", "zero"):
        case("network_given_" + twist, surface | {"twist": twist, "cross": {"A": A, "B": B}}, network("sum", twist, a, A, b, B), points)
    twists = [[[0.1 * i, 0.2 * j - 0.3, 0.5 - 0.1 * i * j] for j in range(n + 1)] for i in range(m + 1)]
    spline = lambda values, tangents: lambda t: hermite_values(values, tangents, t)
    A = [spline([slope(c)(mpf(i)) for c in b], [vec(d) for d in twists[i]]) for i in range(m + 1)]
    B = [spline([slope(c)(mpf(j)) for c in a], [vec(row[j]) for row in twists]) for j in range(n + 1)]
    case("network_twists", surface | {"cross": {"twists": twists}}, network("sum", "compatible", a, A, b, B), points)


def hermite_squares():
    a = [line("v", i, bump=("sin(pi*t)^2", (0.2, 0.1 * i, 0.3))) for i in (0, 1)]
    b = [line("u", j, bump=("sin(pi*t)^2", (0.1, -0.2, 0.1 * j))) for j in (0, 1)]
    A = [line("v", i, 1, bump=("sin(pi*t)", (0.3, 0.3 - i, -0.2))) for i in (0, 1)]
    B = [line("u", j, 1, bump=("sin(pi*t)", (-0.3, 0.1 + j, 0.25))) for j in (0, 1)]
    surface = {"type": "coons_hermite", "f": [a[0], A[0], A[1], a[1]], "g": [b[0], B[0], B[1], b[1]]}
    points = INSIDE + [(0, 0.4), (0.7, 1)]
    for twist, part in [(t, "sum") for t in ("gregory", "average", "zero")] + [("gregory", "P1"), ("average", "P2"), ("gregory", "P1P2")]:
        case("coons_hermite_%s_%s" % (twist, part), surface | {"twist": twist, "part": part}, network(part, twist, a, A, b, B), points)


def add():
    gordon()
    lagrange_surface()
    generalized()
    frames()
    control_nets()
    networks()
    hermite_squares()
