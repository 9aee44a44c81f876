"""Surfaces on a triangle, spanned over rational edges and over formulas."""
from .common import Curve, H, Vec, bezier, case, digits, formula, function, mpf, slope, sqrt, total, vec

POINTS = [(0.25, 0.5), (0.125, 0.25), (0.625, 0.25), (0.0625, 0.875), (0, 0.375), (0.375, 0), (0.5, 0.5)]
VERTICES = [[2, 0, 0.5], [0.2, 2.1, 0], [-1, -0.5, 1]]  # A, B, C


def turn(k, x): return x[k % 3], x[(k + 1) % 3], x[(k + 2) % 3]


def of_triangle(f):
    """f(u, v, w) of u and v."""
    return lambda u, v: f(u, v, 1 - u - v)


# ---- edges ------------------------------------------------------------------------------------------------------------------
def rational_edges():
    A, B, C = VERTICES
    return [bezier([B, [-0.5, 2, 1.2], [-1.5, 0.5, 0.3], C], [1, 0.6, 1.7, 1.2]), bezier([C, [0.5, -1.5, 2], A], [0.8, 1.5, 2]),
            bezier([A, [2.1, 1, 1], [1.5, 2.2, -0.5], [0.5, 2.4, 1], B], [1, 2, 0.7, 1.3, 0.5])]


def heavy_edges(weights):
    """The same points under weights that differ by orders of magnitude."""
    return [bezier([[digits(x) for x in p] for p in e.scene["points"]], w) for e, w in zip(rational_edges(), weights)]


def between(p, q, bump):
    """(1 - t) p + t q + t (1 - t) bump, in coordinates."""
    return ["(1 - t)*(%s) + t*(%s) + t*(1 - t)*(%s)" % (digits(a), digits(b), c) for a, b, c in zip(p, q, bump)]


def formula_edges():
    A, B, C = [vec(p) for p in VERTICES]
    return [formula(between(B, C, ["sin(2*t)", "exp(-t)", "cos(3*t) - t"])), formula(between(C, A, ["exp(t) - 1", "-sin(4*t)", "0.5*exp(-2*t)"])),
            formula(between(A, B, ["0.3*cos(5*t)", "exp(0.7*t)", "-sin(t)*exp(t)"]))]


def cross_ends(E, k):
    """What the tangents of the neighbours ask of D_k at its ends."""
    zero, one = mpf(0), mpf(1)
    return (-slope(E[(k + 2) % 3])(one) - slope(E[k])(zero) / 2, slope(E[(k + 1) % 3])(zero) + slope(E[k])(one) / 2)


def rational_cross(E):
    inner = [[[0.5, -1, 2]], [[0.3, 1, 0.5], [-1, 2, 1]], [[-1, -1, 0.2]]]
    weights = [[1, 1.5, 0.6], [1, 0.7, 2, 1.1], [1.4, 1, 0.8]]
    return [bezier([p, *inner[k], q], weights[k]) for k, (p, q) in enumerate(cross_ends(E, k) for k in range(3))]


def formula_cross(E):
    bumps = [["sin(3*t)", "exp(-t)", "1 + t"], ["exp(t)", "-cos(2*t)", "sin(t)"], ["t^3", "exp(-2*t)", "0.5*sin(5*t)"]]
    return [formula(between(*cross_ends(E, k), bumps[k])) for k in range(3)]


# ---- formulas -------------------------------------------------------------------------------------------------------------------
def boundary(E):
    """x on the boundary."""
    def x(u, v, w):
        return E[0](w) if u == 0 else E[1](u) if v == 0 else E[2](v)
    return x


def along(k, x):
    """P_k x: linear between the ends of the line on which the k-th coordinate is constant."""
    def at(*c):
        a, b, d = turn(k, c)
        r = b / (b + d) if b + d != 0 else mpf(0)  # at a vertex both ends are it
        back = lambda *y: x(*turn(3 - k, y))
        return (1 - r) * back(a, mpf(0), 1 - a) + r * back(a, 1 - a, mpf(0))
    return at


def bbg(E, kind):
    x = boundary(E)
    P = [along(k, x) for k in range(3)]
    plane = lambda *c: total(c[k] * vec(VERTICES[k]) for k in range(3))
    if kind == "convex":
        return lambda *c: total(c[k] * P[k](*c) for k in range(3))
    if kind == "symmetric":
        return lambda *c: (P[0](*c) + P[1](*c) + P[2](*c) - plane(*c)) / 2
    if len(kind) == 1:
        return P[int(kind) - 1]
    i, j = int(kind[0]) - 1, int(kind[1]) - 1
    return lambda *c: P[i](*c) + P[j](*c) - along(i, P[j])(*c)


def bbg_c1(E, D, part):
    def P(k, c):
        a, b, d = turn(k, c)
        i, j = (k + 1) % 3, (k + 2) % 3
        r, back = b / (b + d), 1 - a
        return (H[0](r) * E[i](a) + H[1](r) * back * (D[i](a) + slope(E[i])(a) / 2) +
                H[2](r) * back * (-D[j](back) + slope(E[j])(back) / 2) + H[3](r) * E[j](back))

    def weight(k, c):
        a, b, d = turn(k, c)
        return a * a * (3 - 2 * a + 6 * b * d)
    if part:
        return lambda *c: P(part - 1, c)
    return lambda *c: total(weight(k, c) * P(k, c) for k in range(3))


def ray_weights(c):
    p = [turn(k, c)[1] ** 2 * turn(k, c)[2] ** 2 for k in range(3)]
    return [x / sum(p) for x in p]


def nielson(T, part):
    if part:
        return lambda *c: T(part - 1, c)
    return lambda *c: total(w * T(k, c) for k, w in enumerate(ray_weights(c)))


def nielson_c1(E, D, part):
    def T(k, c):
        a, b, d = turn(k, c)
        i, j = (k + 1) % 3, (k + 2) % 3
        t, rho = d / (b + d), 1 - a
        arriving = (t - mpf(1) / 2) * slope(E[k])(t) - D[k](t)
        return (H[0](rho) * E[j](mpf(0)) + a * a * b * slope(E[j])(mpf(0)) - a * a * d * slope(E[i])(mpf(1)) + H[2](rho) * arriving + H[3](rho) * E[k](t))
    return nielson(T, part)


def nielson_g1(E, N, part):
    def into_plane(n, x): return x - n * (n.dot(x) / n.dot(n))

    def T(k, c):
        a, b, d = turn(k, c)
        t, rho = d / (b + d), 1 - a
        vertex = E[(k + 2) % 3](mpf(0))
        chord = E[k](t) - vertex
        return H[0](rho) * vertex + H[1](rho) * into_plane(N[(k + 2) % 3](mpf(0)), chord) + H[2](rho) * into_plane(N[k](t), chord) + H[3](rho) * E[k](t)
    return nielson(T, part)


def three_curves(E):
    """(6.28) with r_k(t) = E_k(1 - t)."""
    r = [lambda t, e=e: e(1 - t) for e in E]
    A, B, C = E[2](mpf(0)), E[0](mpf(0)), E[1](mpf(0))
    return lambda a, b, c: (a * (r[2](1 - b) + r[1](c) - A) + b * (r[0](1 - c) + r[2](a) - B) + c * (r[1](1 - a) + r[0](b) - C))


def side_vertex(E, h, form, part):
    vertex = [E[(k + 2) % 3](mpf(0)) for k in range(3)]

    def ray(k, c):
        """The point of E_k that the ray from its vertex meets; in the delta form, how far from the chord."""
        a, b, d = turn(k, c)
        t = d / (b + d)
        return E[k](t) - (((1 - t) * vertex[(k + 1) % 3] + t * vertex[(k + 2) % 3]) if form == "delta" else 0 * vertex[0])
    flat = (lambda t: t) if form == "delta" else h
    plane = lambda c: total(flat(c[k]) * vertex[k] for k in range(3))

    def term(k, c):
        bent = h(1 - c[k]) * ray(k, c)
        return plane(c) + bent if form == "delta" else bent + h(c[k]) * vertex[k]
    if part == "s4":
        return lambda *c: plane(c)
    if part != "sum":
        return lambda *c: term({"s1": 1, "s2": 2, "s3": 0}[part], c)
    return lambda *c: term(0, c) + term(1, c) + term(2, c) - 2 * plane(c)


# ---- tangent planes ---------------------------------------------------------------------------------------------------------------
def on_sphere():
    """Great circles run at uneven speed (weights w_i 1.3^i); the surface normal is the position."""
    V = [Vec(mpf(x) / 3 for x in p) for p in ([2, 1, 2], [-1, 2, 2], [1, -2, 2])]

    def arc(p, q):
        cosine = p.dot(q)
        s = mpf("1.3")
        return bezier([p, (p + q) / (1 + cosine), q], [1, digits(s * sqrt((1 + cosine) / 2)), digits(s * s)])
    E = [arc(V[(k + 1) % 3], V[(k + 2) % 3]) for k in range(3)]
    return E, E


def on_graph():
    """Curves on z = sin(x) exp(y/2) over conics of the plane, with the normals (-z_x, -z_y, 1)."""
    E, N = [], []
    for k, (bx, by) in enumerate([("1 + t", "-0.5"), ("0.4*t", "-1"), ("0.7", "1.2 - t")]):
        p, q = vec(VERTICES[(k + 1) % 3]), vec(VERTICES[(k + 2) % 3])
        x, y = ["(%s)" % s for s in between(p, q, [bx, by, "0"])[:2]]
        E.append(formula([x, y, "sin%s*exp(0.5*%s)" % (x, y)]))
        N.append(formula(["-cos%s*exp(0.5*%s)" % (x, y), "-0.5*sin%s*exp(0.5*%s)" % (x, y), "1"]))
    return E, N


def add():
    mixed = [rational_edges()[0], formula_edges()[1], rational_edges()[2]]
    for name, E, D in (("rational", rational_edges(), rational_cross), ("formula", formula_edges(), formula_cross), ("mixed", mixed, formula_cross)):
        def add_case(method, keys, f, E=E, name=name):
            suffix = "".join("_" + "".join(v if isinstance(v, list) else [v]) for k, v in keys.items() if k in ("part", "projectors", "form"))
            case("%s_%s%s" % (method, name, suffix), {"type": "coons_triangle", "method": method, "edges": E} | keys, of_triangle(f), POINTS)
        add_case("three_curves", {}, three_curves(E))
        add_case("bbg_convex", {}, bbg(E, "convex"))
        add_case("bbg_symmetric", {}, bbg(E, "symmetric"))
        add_case("bbg_boolean", {"projectors": ["P3", "P1"]}, bbg(E, "31"))
        add_case("bbg_boolean", {"projectors": ["P2", "P3"]}, bbg(E, "23"))
        cross = D(E)
        c1 = {"cross": cross}
        add_case("bbg_c1", c1, bbg_c1(E, cross, 0))
        add_case("nielson_c1", c1, nielson_c1(E, cross, 0))
        for text, form in (("t^2", "delta"), ("3*t^2 - 2*t^3", "delta"), ("2*t^3 - t^4", "seed")):
            if name == "rational" or text == "t^2":
                suffix = {"t^2": "_square", "3*t^2 - 2*t^3": "_smooth", "2*t^3 - t^4": "_quartic"}[text]
                case("side_vertex_%s%s_%s" % (name, suffix, form), {"type": "coons_triangle", "method": "side_vertex", "edges": E, "H": text, "form": form},
                     of_triangle(side_vertex(E, function(text), form, "sum")), POINTS)
        if name == "mixed":
            continue
        for k in (1, 2, 3):
            add_case("bbg_convex", {"part": "P%d" % k}, bbg(E, str(k)))
            add_case("bbg_c1", c1 | {"part": "P%d" % k}, bbg_c1(E, cross, k))
            add_case("nielson_c1", c1 | {"part": "T%d" % k}, nielson_c1(E, cross, k))
        for part in ("s1", "s2", "s3", "s4"):
            for form in ("delta", "seed"):
                if (name == "rational") == (form == "seed"):
                    add_case("side_vertex", {"H": "sin(pi*t/2)^2", "form": form, "part": part}, side_vertex(E, function("sin(pi*t/2)^2"), form, part))
    for name, weights in (("weights_20", ([1, 0.05, 20, 1], [0.05, 20, 0.05], [1, 20, 0.05, 5, 1])),
                          ("weights_1000", ([1, 1e3, 1e-3, 1], [1e-3, 1, 1e3], [1, 1e3, 1e-3, 10, 1]))):
        E = heavy_edges(weights)
        cross = rational_cross(E)
        for method, keys, f in (("three_curves", {}, three_curves(E)), ("bbg_convex", {}, bbg(E, "convex")), ("bbg_symmetric", {}, bbg(E, "symmetric")),
                                ("bbg_boolean", {}, bbg(E, "12")), ("bbg_c1", {"cross": cross}, bbg_c1(E, cross, 0)),
                                ("side_vertex", {}, side_vertex(E, function("t^2"), "delta", "sum"))):
            case(method + "_" + name, {"type": "coons_triangle", "method": method, "edges": E} | keys, of_triangle(f), POINTS)
    for name, (E, N) in (("sphere", on_sphere()), ("graph", on_graph())):
        for part in (0, 1, 2, 3):
            key = {"part": "T%d" % part} if part else {}
            case("nielson_g1_%s%s" % (name, "_T%d" % part if part else ""), {"type": "coons_triangle", "method": "nielson_g1", "edges": E, "normals": N} | key,
                 of_triangle(nielson_g1(E, N, part)), POINTS)
