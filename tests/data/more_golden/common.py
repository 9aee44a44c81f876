"""Curves, boolean sums and the file of make_more_golden.py."""
import json
import re

from mpmath import cos, exp, mp, mpf, nstr, pi, sin, sqrt  # noqa: F401 (texts use them)

mp.dps = 160
STEP = mpf(10) ** -30
H = [lambda t: 2 * t**3 - 3 * t**2 + 1, lambda t: t**3 - 2 * t**2 + t, lambda t: t**3 - t**2, lambda t: 3 * t**2 - 2 * t**3]


class Vec(tuple):
    def __add__(self, o): return Vec(a + b for a, b in zip(self, o))
    def __sub__(self, o): return Vec(a - b for a, b in zip(self, o))
    def __mul__(self, s): return Vec(a * s for a in self)
    __rmul__ = __mul__
    def __truediv__(self, s): return self * (1 / mpf(s))
    def __neg__(self): return self * -1
    def dot(self, o): return sum(a * b for a, b in zip(self, o))
    def cross(self, o): return Vec(self[i - 2] * o[i - 1] - self[i - 1] * o[i - 2] for i in range(3))


def vec(p): return Vec(mpf(str(x)) for x in p)
def total(terms): return sum(terms, Vec((mpf(0),) * 3))
def digits(x, n=20): return nstr(mpf(x), n)
def slope(f): return lambda t: (f(t + STEP) - f(t - STEP)) / (2 * STEP)


# ---- curves -----------------------------------------------------------------------------------------------------------
class Curve:
    def __init__(self, scene, f, begin=0, end=1):
        self.scene, self.f, self.begin, self.end = scene, f, mpf(begin), mpf(end)

    def __call__(self, t): return self.f(t)

    def over(self, begin=0, end=1):
        """The same curve over another range."""
        scale = (self.end - self.begin) / (end - begin)
        return lambda t: self.f(self.begin + (t - begin) * scale)


def function(text):
    python = re.sub(r"(?<![\w.])(\d+\.?\d*(e-?\d+)?)", r"mpf('\1')", text).replace("^", "**")
    code = compile(python, text, "eval")
    return lambda t: mpf(eval(code, globals(), {"t": t}))


def formula(texts, begin=0, end=1):
    parts = [function(t) for t in texts]
    return Curve({"type": "formula", "xyz": list(texts), "domain": [begin, end]}, lambda t: Vec(p(t) for p in parts), begin, end)


def de_boor(degree, knots, points, weights, t):
    k = degree
    while k + 1 < len(points) and knots[k + 1] <= t:
        k += 1
    d = [(*(x * w for x in p), w) for p, w in list(zip(points, weights))[k - degree:k + 1]]
    for r in range(1, degree + 1):
        for j in range(degree, r - 1, -1):
            low, high = knots[j + k - degree], knots[j + 1 + k - r]
            a = (t - low) / (high - low)
            d[j] = tuple((1 - a) * x + a * y for x, y in zip(d[j - 1], d[j]))
    return Vec(x / d[degree][3] for x in d[degree][:3])


def bspline(degree, knots, points, weights=None):
    scene = {"type": "bspline", "degree": degree, "knots": knots, "points": [[digits(x) for x in p] for p in points]}
    if weights:
        scene["weights"] = weights
    p, k, w = [vec(x) for x in points], [mpf(str(x)) for x in knots], [mpf(str(x)) for x in weights or [1] * len(points)]
    return Curve(scene, lambda t: de_boor(degree, k, p, w, t), k[degree], k[len(p)])


def bezier(points, weights=None):
    n = len(points) - 1
    c = bspline(n, [0] * (n + 1) + [1] * (n + 1), points, weights)
    c.scene = {k: v for k, v in c.scene.items() if k in ("points", "weights")} | {"type": "bezier"}
    return c


def hermite_values(points, tangents, t):
    i = min(int(t), len(points) - 2)
    s = t - i
    return points[i] * H[0](s) + tangents[i] * H[1](s) + tangents[i + 1] * H[2](s) + points[i + 1] * H[3](s)


def hermite(points, tangents):
    p, m = [vec(x) for x in points], [vec(x) for x in tangents]
    return Curve({"type": "hermite", "points": points, "tangents": tangents}, lambda t: hermite_values(p, m, t), 0, len(p) - 1)


# ---- what surfaces are made of: x = sum of vectors times p(u) q(v), and bumps that vanish where curves meet --------------
FUN = [("1", "0"), ("t", "1"), ("sin(0.9*t)", "0.9*cos(0.9*t)"), ("exp(-0.4*t)", "-0.4*exp(-0.4*t)"), ("1/(3+t)", "-1/(3+t)^2")]
TERMS = [((1, 0.2, 0.1), 1, 0), ((-0.1, 1.1, 0.3), 0, 1), ((0.3, -0.2, 0.8), 2, 3), ((0.1, 0.4, 1.5), 4, 2), ((-0.2, 0.1, 0.5), 3, 4), ((0.2, 0.3, -0.4), 2, 2)]


def line(along, at, derivative=0, bump=("0", (0, 0, 0)), domain=(0, 1)):
    """x or its derivative across, along u at v = at, or along v at u = at; plus a bump."""
    def coordinate(k):
        parts = ["%s*(%s)" % (bump[1][k], bump[0])]
        for a, i, j in TERMS:
            run, fixed = (i, j) if along == "u" else (j, i)
            parts.append("%s*(%s)" % (digits(mpf(str(a[k])) * function(FUN[fixed][derivative])(mpf(at))), FUN[run][0]))
        return " + ".join(parts)
    return formula([coordinate(k) for k in range(3)], *domain)


def boolean(part, hu, hv, f, g, m):
    """P1 + P2 - P1 P2 at (u,v) of blends, curves and corner data m(i, j)."""
    def x(u, v):
        p1 = lambda: total(h(u) * c(v) for h, c in zip(hu, f))
        p2 = lambda: total(h(v) * c(u) for h, c in zip(hv, g))
        p12 = lambda: total(hu[i](u) * hv[j](v) * m(i, j, u, v) for i in range(len(hu)) for j in range(len(hv)))
        return {"P1": p1, "P2": p2, "P1P2": p12, "sum": lambda: p1() + p2() - p12()}[part]()
    return x


# ---- the file -----------------------------------------------------------------------------------------------------------
CASES = {}


def plain(x, curves):
    if isinstance(x, Curve):
        curves.append(x)
        return x.scene
    if isinstance(x, dict):
        return {k: plain(v, curves) for k, v in x.items()}
    return [plain(y, curves) for y in x] if isinstance(x, (list, tuple)) else x


def case(name, surface, x, points):
    curves = []
    scene = {"isoparm": 1, "surfaces": {"S": plain(surface, curves)}}
    size = max(abs(a) for c in curves for k in range(9) for a in c(c.begin + (c.end - c.begin) * k / 8))
    rows = []
    for u, v in points:
        p, h = (mpf(str(u)), mpf(str(v))), STEP
        at = {(i, j): x(p[0] + i * h, p[1] + j * h) for i in (-1, 0, 1) for j in (-1, 0, 1)}
        row = {"S": at[0, 0], "Su": (at[1, 0] - at[-1, 0]) / (2 * h), "Sv": (at[0, 1] - at[0, -1]) / (2 * h),
               "Suu": (at[1, 0] - 2 * at[0, 0] + at[-1, 0]) / h**2, "Svv": (at[0, 1] - 2 * at[0, 0] + at[0, -1]) / h**2,
               "Suv": (at[1, 1] - at[1, -1] - at[-1, 1] + at[-1, -1]) / (4 * h**2)}
        n = row["Su"].cross(row["Sv"])
        if n.dot(n) > mpf(10) ** -50:
            row["n"] = n / sqrt(n.dot(n))
        clean = lambda a: digits(0 if abs(a) < mpf(10) ** -45 else a)
        rows.append({"u": str(u), "v": str(v)} | {k: [clean(a) for a in y] for k, y in row.items()})
    CASES[name] = {"scene": scene, "size": float(size), "points": rows}


def write(path):
    with open(path, "w") as file:
        file.write("{\n" + ",\n".join('"%s": {"size": %r, "scene":\n  %s,\n "points": [\n  %s]}' % (
            name, c["size"], json.dumps(c["scene"]), ",\n  ".join(json.dumps(p) for p in c["points"])) for name, c in CASES.items()) + "\n}\n")

