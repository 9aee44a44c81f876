#include "subdivision/subdivision_ring.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scalar/elementary.h"

namespace isoparm {
namespace {

/// 2 p - q: q mirrored at p.
template <class T> Vec3<T> mirrored(const Vec3<T>& p, const Vec3<T>& q) { return T(2.0) * p - q; }
/// The fourth corner of the parallelogram on the other side of a and b.
template <class T> Vec3<T> opposite(const Vec3<T>& a, const Vec3<T>& b, const Vec3<T>& apex) { return a + b - apex; }
template <class T> Vec3<T> blend(float weight, const Vec3<T>& p, const Vec3<T>& q) {
    const T w = double(weight);
    return w * p + (T(1.0) - w) * q;
}

float finer(float s) { return s >= kInfiniteSharpness ? s : std::max(s - 1, 0.0f); }

/// cos(2 pi / n)
template <class T> T cosine(int n);
template <> double cosine(int n) { return n == 3 ? -0.5 : n == 4 ? 0 : n == 6 ? 0.5 : std::cos(2 * std::numbers::pi / n); }
template <> Interval cosine(int n) {
    if (n == 3 || n == 4 || n == 6) return cosine<double>(n);
    return cos(Interval(2) * Interval(std::numbers::pi, std::nextafter(std::numbers::pi, 4)) / Interval(n));
}

}  // namespace

template <class T> Subdivider<T>::Subdivider(const Ring<T>& ring, Scheme scheme) : ring_(ring), scheme_(scheme) {
    std::vector<std::vector<int>> at(ring.points.size());  // edges by their smaller vertex
    face_edges_.resize(ring.faces.size());
    for (int f = 0; f < static_cast<int>(ring.faces.size()); ++f) {
        const auto& corner = ring.faces[f];
        for (std::size_t k = 0; k < corner.size(); ++k) {
            const int a = corner[k], b = corner[(k + 1) % corner.size()];
            auto& list = at[std::min(a, b)];
            const auto found = std::find_if(list.begin(), list.end(), [&](int e) { return edges_[e].has(std::max(a, b)); });
            const int e = found == list.end() ? static_cast<int>(edges_.size()) : *found;
            if (found == list.end()) {
                list.push_back(e);
                edges_.push_back({a, b});
            }
            edges_[e].face[edges_[e].face[0] >= 0] = f;
            face_edges_[f].push_back(e);
        }
    }
    for (const auto& c : ring.creases)
        for (const int e : at[std::min(c.a, c.b)])
            if (edges_[e].has(std::max(c.a, c.b))) edges_[e].sharpness = c.sharpness;
    if (scheme == Scheme::loop) return;
    for (const auto& f : ring.faces) {
        Vec3<T> sum{T(0.0), T(0.0), T(0.0)};
        for (const int v : f) sum = sum + ring.points[v];
        face_points_.push_back(sum / T(double(f.size())));
    }
}

template <class T> const typename Subdivider<T>::Edge& Subdivider<T>::other_edge(int f, int v, const Edge& e) const {
    const auto& list = face_edges_[f];
    return edges_[*std::find_if(list.begin(), list.end(), [&](int o) { return &edges_[o] != &e && edges_[o].has(v); })];
}

template <class T> Vec3<T> Subdivider<T>::edge_point(const Edge& e) const {
    const Vec3<T> ends = ring_.points[e.a] + ring_.points[e.b], middle = T(0.5) * ends;
    if (e.sharpness >= 1 || scheme_ == Scheme::bilinear) return middle;
    Vec3<T> smooth;
    if (scheme_ == Scheme::loop) {
        smooth = T(0.375) * ends;
        for (const int f : e.face)
            for (const int v : ring_.faces[f])
                if (!e.has(v)) smooth = smooth + T(0.125) * ring_.points[v];
    } else {
        smooth = T(0.25) * (ends + (face_points_[e.face[0]] + face_points_[e.face[1]]));
    }
    return e.sharpness > 0 ? blend(e.sharpness, middle, smooth) : smooth;
}

template <class T> Vec3<T> Subdivider<T>::smooth_vertex(int v) const {
    Vec3<T> sum{T(0.0), T(0.0), T(0.0)};
    int n = 0;
    for (const Edge& e : edges_)
        if (e.has(v)) sum = sum + ring_.points[e.other(v)], ++n;
    if (scheme_ == Scheme::loop) {
        const T b = T(0.25) * cosine<T>(n) + T(0.375), beta = T(0.625) - b * b;
        return (T(1.0) - beta) * ring_.points[v] + beta / T(double(n)) * sum;
    }
    for (std::size_t f = 0; f < ring_.faces.size(); ++f)
        if (std::find(ring_.faces[f].begin(), ring_.faces[f].end(), v) != ring_.faces[f].end()) sum = sum + face_points_[f];
    return (T(n - 2.0) * ring_.points[v] + T(1.0) / T(double(n)) * sum) / T(double(n));
}

/// The refined corner k of the face, and its sharpness.
template <class T> Vec3<T> Subdivider<T>::vertex_point(int k, float& sharpness) const {
    const int v = face()[k];
    const Vec3<T>& p = ring_.points[v];
    const float s = ring_.sharpness[v];
    sharpness = finer(s);
    if (scheme_ == Scheme::bilinear) return p;
    // Sharp edges before and after this step, and how sharp what ceases to be was.
    std::vector<int> before, after;
    float decayed = 0, sum = 0;
    if (s > 0 && sharpness == 0) decayed = 1, sum = s;
    for (const Edge& e : edges_) {
        if (!e.has(v) || !(e.sharpness > 0)) continue;
        before.push_back(e.other(v));
        if (finer(e.sharpness) > 0) after.push_back(e.other(v));
        else decayed += 1, sum += e.sharpness;
    }
    enum class Rule { smooth, crease, corner };
    const auto rule = [](float vertex, std::size_t sharp) { return vertex > 0 || sharp > 2 ? Rule::corner : sharp == 2 ? Rule::crease : Rule::smooth; };
    const auto apply = [&](Rule r, const std::vector<int>& ends) {
        if (r == Rule::corner) return p;
        if (r == Rule::smooth) return smooth_vertex(v);
        return T(0.75) * p + T(0.125) * (ring_.points[ends[0]] + ring_.points[ends[1]]);
    };
    const Rule now = rule(s, before.size()), next = rule(sharpness, after.size());
    const Vec3<T> result = apply(now, before);
    if (now == Rule::smooth || now == next) return result;
    const float weight = decayed > 0 ? std::min(sum / decayed, 1.0f) : 0;
    return blend(weight, result, apply(next, after));
}

template <class T> Ring<T> Subdivider<T>::child(int k) const {
    // Vertices of the refined mesh by what they come from: the vertices, edges and faces of this one.
    const int vertices = static_cast<int>(ring_.points.size()), edges = static_cast<int>(edges_.size()), n = corners();
    const bool loop = scheme_ == Scheme::loop;
    const auto of_edge = [&](int f, int i) { return vertices + face_edges_[f][i]; };
    const auto of_face = [&](int f) { return vertices + edges + f; };
    const auto corner_child = [&](int f, int i) {
        const int size = static_cast<int>(ring_.faces[f].size()), last = of_edge(f, (i + size - 1) % size);
        return loop ? std::vector<int>{ring_.faces[f][i], of_edge(f, i), last} : std::vector<int>{ring_.faces[f][i], of_edge(f, i), of_face(f), last};
    };
    std::vector<int> chosen = loop && k == 3 ? std::vector<int>{of_edge(0, 1), of_edge(0, 2), of_edge(0, 0)} : corner_child(0, k);
    if (n == (loop ? 3 : 4) && k > 0 && k < n) std::rotate(chosen.begin(), chosen.end() - k, chosen.end());  // the axes of the face

    Ring<T> r;
    std::vector<int> number(vertices + edges + ring_.faces.size(), -1);
    const auto add = [&](int id) {
        if (number[id] < 0) {
            number[id] = static_cast<int>(r.points.size());
            float sharpness = 0;
            if (id < vertices) r.points.push_back(vertex_point(static_cast<int>(std::find(face().begin(), face().end(), id) - face().begin()), sharpness));
            else r.points.push_back(id < vertices + edges ? edge_point(edges_[id - vertices]) : face_points_[id - vertices - edges]);
            r.sharpness.push_back(sharpness);
        }
        return number[id];
    };
    std::vector<std::vector<int>> around{chosen};
    const auto take = [&](const std::vector<int>& f) {
        if (std::any_of(f.begin(), f.end(), [&](int id) { return std::find(chosen.begin(), chosen.end(), id) != chosen.end(); })) around.push_back(f);
    };
    for (int f = 0; f < static_cast<int>(ring_.faces.size()); ++f) {
        const auto& c = ring_.faces[f];
        for (int i = 0; i < static_cast<int>(c.size()); ++i)
            if ((f != 0 || i != k) && std::find(face().begin(), face().end(), c[i]) != face().end()) take(corner_child(f, i));
        if (loop && (f != 0 || k != 3)) take({of_edge(f, 1), of_edge(f, 2), of_edge(f, 0)});
    }
    for (const auto& f : around) {
        r.faces.emplace_back();
        for (const int id : f) r.faces.back().push_back(add(id));
    }
    for (int e = 0; e < edges; ++e) {
        const float s = finer(edges_[e].sharpness);
        if (!(s > 0) || number[vertices + e] < 0) continue;
        for (const int v : {edges_[e].a, edges_[e].b})
            if (number[v] >= 0) r.creases.push_back({number[v], number[vertices + e], s});
    }
    return r;
}

/// Faces around v from face 0 across e to the next wall.
template <class T> int Subdivider<T>::faces_to_wall(int v, const Edge* e) const {
    int count = 0;
    for (int f = 0; !e->wall() && count < 3; ++count) {
        f = across(*e, f);
        e = &other_edge(f, v, *e);
    }
    return count;
}

template <class T> bool Subdivider<T>::regular_at(int k) const {
    const int v = face()[k], n = corners(), size = scheme_ == Scheme::loop ? 3 : 4;
    const float s = ring_.sharpness[v];
    if (s > 0 && s < kInfiniteSharpness) return false;
    int walls = 0, faces = 0;
    for (const Edge& e : edges_) {
        if (!e.has(v)) continue;
        if (e.sharpness > 0 && !e.wall()) return false;
        walls += e.wall();
    }
    for (const auto& f : ring_.faces)
        if (std::find(f.begin(), f.end(), v) != f.end()) {
            if (static_cast<int>(f.size()) != size) return false;
            ++faces;
        }
    const Edge &next = side(k), &last = side((k + n - 1) % n);
    if (s > 0 || walls > 2) return next.wall() && last.wall();
    if (walls == 0) return faces == (size == 4 ? 4 : 6);
    return walls == 2 && 1 + faces_to_wall(v, &next) + faces_to_wall(v, &last) == (size == 4 ? 2 : 3);
}

template <class T> std::optional<std::vector<Vec3<T>>> Subdivider<T>::regular() const {
    if (corners() != (scheme_ == Scheme::loop ? 3 : 4)) return {};
    for (int k = 0; k < corners(); ++k)
        if (!regular_at(k)) return {};
    return scheme_ == Scheme::loop ? twelve() : grid();
}

/// Beyond a wall the rows of control points go on linearly: that makes its curve the cubic B-spline of its points alone.
template <class T> std::vector<Vec3<T>> Subdivider<T>::grid() const {
    const auto& p = ring_.points;
    // beyond[k][i]: across side k, beside its first or last corner.
    std::array<std::array<Vec3<T>, 2>, 4> beyond;
    for (int k = 0; k < 4; ++k)
        for (int i = 0; i < 2; ++i) {
            const int v = face()[(k + i) % 4], inner = face()[(k + 3 * (1 - i) + 2 * i) % 4];
            const Edge& e = side(k);
            beyond[k][i] = e.wall() ? mirrored(p[v], p[inner]) : p[other_edge(across(e, 0), v, e).other(v)];
        }
    std::array<Vec3<T>, 4> diagonal;
    for (int k = 0; k < 4; ++k) {
        const int last = (k + 3) % 4, v = face()[k];
        if (side(k).wall()) diagonal[k] = mirrored(beyond[last][1], beyond[last][0]);
        else if (side(last).wall()) diagonal[k] = mirrored(beyond[k][0], beyond[k][1]);
        else
            for (int f = 1; f < static_cast<int>(ring_.faces.size()); ++f) {
                const auto& c = ring_.faces[f];
                const auto at = std::find(c.begin(), c.end(), v);
                if (at != c.end() && f != across(side(k), 0) && f != across(side(last), 0)) diagonal[k] = p[c[(at - c.begin() + 2) % 4]];
            }
    }
    return {diagonal[0],  beyond[3][1], beyond[3][0], diagonal[3],    // i = 0: beyond side 3, from corner 0 to corner 3
            beyond[0][0], p[face()[0]], p[face()[3]], beyond[2][1],   //
            beyond[0][1], p[face()[1]], p[face()[2]], beyond[2][0],   //
            diagonal[1],  beyond[1][0], beyond[1][1], diagonal[2]};
}

/// Beyond a wall each triangle is continued to a parallelogram, beyond a sharp corner the edges go on straight.
template <class T> std::vector<Vec3<T>> Subdivider<T>::twelve() const {
    const auto& p = ring_.points;
    const auto apex = [&](int f, const Edge& e) { return p[*std::find_if(ring_.faces[f].begin(), ring_.faces[f].end(), [&](int v) { return !e.has(v); })]; };
    std::vector<Vec3<T>> result;
    for (const int v : face()) result.push_back(p[v]);
    for (int k = 0; k < 3; ++k) result.push_back(side(k).wall() ? opposite(result[k], result[(k + 1) % 3], result[(k + 2) % 3]) : apex(across(side(k), 0), side(k)));
    for (int k = 0; k < 3; ++k) {
        const int v = face()[k], last = (k + 2) % 3;
        // n[i]: the i-th neighbour of v, counted from the next corner over the last one.
        const Vec3<T> &n0 = result[(k + 1) % 3], &n1 = result[last], &n2 = result[3 + last], &n5 = result[3 + k];
        /// The next neighbour beyond a side that is no wall.
        const auto further = [&](const Edge& e, const Vec3<T>& outer, const Vec3<T>& inner) {
            const int f = across(e, 0);
            const Edge& o = other_edge(f, v, e);
            return o.wall() ? opposite(p[v], outer, inner) : apex(across(o, f), o);
        };
        const bool wall_k = side(k).wall(), wall_last = side(last).wall();
        Vec3<T> n3, n4;
        if (wall_k && wall_last) {
            n3 = mirrored(p[v], n0), n4 = mirrored(p[v], n1);
        } else if (wall_last) {
            n4 = further(side(k), n5, n0), n3 = opposite(p[v], n4, n5);
        } else if (wall_k) {
            n3 = further(side(last), n2, n1), n4 = opposite(p[v], n3, n2);
        } else {
            n3 = further(side(last), n2, n1), n4 = further(side(k), n5, n0);
        }
        result.push_back(n4), result.push_back(n3);
    }
    return result;
}

template class Subdivider<Interval>;
template class Subdivider<double>;

}  // namespace isoparm
