#include "io/cage_obj.h"

#include <algorithm>
#include <set>
#include <string_view>

#include "error.h"
#include "io/obj_statements.h"
#include "text/printable_text.h"

namespace isoparm {
namespace {

constexpr int max_face_size = 65535;      // OpenSubdiv's own limit
constexpr std::size_t max_elements = 100'000'000;

using Place = ObjStatements::Place;
using Token = ObjStatements::Token;

class Reader : ObjStatements {
public:
    using ObjStatements::ObjStatements;

    Cage read() {
        while (advance()) statement();
        finish();
        return std::move(cage_);
    }

private:
    void statement() {
        const std::string_view word = keyword().text;
        static const std::set<std::string_view> passed_over = {
            "vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "usemap", "maplib", "l", "p",
            "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "mg"};
        if (word == "v") vertex();
        else if (word == "f") face();
        else if (word == "t") tag();
        else if (!passed_over.contains(word))
            fail(keyword().place, in_quotes(word), "an OBJ statement of a polygon mesh: v, vt, vn, f, g, o, s, usemtl, mtllib, l, p; or a tag t");
    }

    void vertex() {
        Point p;
        for (int k = 0; k < 3; ++k) p[k] = number("a coordinate");
        const std::size_t extra = left();
        if (extra == 1) {
            const Place at = place();
            if (const double w = number("the weight 1"); w != 1) fail(at, in_quotes(to_text(w)), "the weight 1: rational cages have no subdivision surface");
        } else if (extra == 3) {
            for (int k = 0; k < 3; ++k) number("a colour");  // as some programs append
        }
        nothing_more("x y z (and a weight of 1, or a colour)");
        if (cage_.positions.size() == max_elements) fail(keyword().place, "one more vertex", "at most 100000000");
        cage_.positions.push_back(p);
    }

    void face() {
        std::vector<int> corners;
        std::vector<Place> places;
        while (more()) {
            const Token t = token("a vertex");
            corners.push_back(face_vertex(t));
            places.push_back(t.place);
        }
        if (corners.size() < 3) fail(end(), "a face of " + std::to_string(corners.size()) + " vertices", "at least 3");
        if (corners.size() > max_face_size) fail(places[max_face_size], "a face of " + std::to_string(corners.size()) + " vertices", "at most 65535");
        refuse_repetition(corners, places);
        if (cage_.faces.size() == max_elements) fail(keyword().place, "one more face", "at most 100000000");
        cage_.faces.push_back(std::move(corners));
        cage_.face_lines.push_back(line());
    }

    int face_vertex(const Token& t) {
        static constexpr const char* form = "a vertex index as in v, v/vt, v//vn or v/vt/vn";
        std::string_view rest = t.text;
        int parts[3] = {};
        for (int part = 0;; ++part) {
            const std::size_t end = std::min(rest.find('/'), rest.size());
            if (part > 2) fail(t.place, in_quotes(t.text), form);
            if (end > 0 || part != 1 || end == rest.size()) parts[part] = integer(rest.substr(0, end), t, form);
            if (end == rest.size()) break;
            rest.remove_prefix(end + 1);
        }
        const int count = static_cast<int>(cage_.positions.size());
        const int i = parts[0] < 0 ? count + parts[0] : parts[0] - 1;
        if (i < 0 || parts[0] == 0)
            fail(t.place, "the vertex index " + std::to_string(parts[0]),
                 "1 or more, or -1 to -" + std::to_string(count) + " counted back from the last vertex");
        if (i >= count && (last_.index < i)) last_ = {i, t.place};  // may still follow
        return i;
    }

    void refuse_repetition(const std::vector<int>& corners, const std::vector<Place>& places) const {
        std::vector<std::size_t> order(corners.size());
        for (std::size_t k = 0; k < order.size(); ++k) order[k] = k;
        std::sort(order.begin(), order.end(), [&](auto a, auto b) { return std::pair(corners[a], a) < std::pair(corners[b], b); });
        for (std::size_t k = 1; k < order.size(); ++k)
            if (corners[order[k]] == corners[order[k - 1]])
                fail(places[order[k]], "the vertex " + std::to_string(corners[order[k]] + 1) + " a second time in a degenerate face",
                     "vertices that are all different");
    }

    // t NAME INTEGERS/FLOATS/STRINGS values
    void tag() {
        const Token name = token("the name of a tag");
        const auto [ints, floats] = counts();
        if (name.text == "crease") crease(ints, floats, name.place);
        else if (name.text == "corner") corner(ints, floats, name.place);
        else if (name.text == "hole") holes(ints);
        else if (name.text == "interpolateboundary") boundary();
        else if (name.text.starts_with("facevarying")) return;  // textures only
        else fail(name.place, "the tag " + in_quotes(name.text), "crease, corner, hole or interpolateboundary");
        nothing_more("the values of the tag");
    }

    std::pair<int, int> counts() {
        static constexpr const char* form = "the numbers of integers, floats and strings, as in 2/1/0";
        const Token t = token(form);
        const std::size_t a = t.text.find('/'), b = a == t.text.npos ? a : t.text.find('/', a + 1);
        if (b == t.text.npos) fail(t.place, in_quotes(t.text), form);
        const int ints = integer(t.text.substr(0, a), t, form), floats = integer(t.text.substr(a + 1, b - a - 1), t, form);
        const int strings = integer(t.text.substr(b + 1), t, form);
        const auto values = static_cast<long long>(left());
        if (ints < 0 || floats < 0 || strings < 0 || static_cast<long long>(ints) + floats + strings != values)
            fail(t.place, in_quotes(t.text) + " before " + std::to_string(values) + " values", "numbers that add up to them");
        return {ints, floats};
    }

    struct Index {
        int index = -1;
        Place place;
    };
    Index tag_index(const char* expected) {
        const Place place = this->place();
        const int i = integer(expected);
        if (i < 0) fail(place, std::to_string(i), std::string(expected) + ", counted from 0");
        return {i, place};
    }
    double sharpness() {
        const Place place = this->place();
        const double s = number("a sharpness");
        if (s < 0) fail(place, to_text(s), "a sharpness of 0 or more");
        return s;
    }
    /// One sharpness for all, or one each.
    std::vector<double> sharpnesses(int n, int floats, Place place) {
        if (n < 1 || (floats != 1 && floats != n))
            fail(place, std::to_string(n) + " items and " + std::to_string(floats) + " sharpnesses", "one sharpness, or one for each");
        std::vector<double> s(n);
        for (int k = 0; k < n; ++k) s[k] = k < floats ? sharpness() : s[0];
        return s;
    }

    void crease(int ints, int floats, Place place) {
        if (ints % 2) fail(place, "a crease of " + std::to_string(ints) + " vertices", "pairs: the two ends of each edge");
        std::vector<Index> ends;
        for (int k = 0; k < ints; ++k) vertices_.push_back(ends.emplace_back(tag_index("a vertex")));
        const auto s = sharpnesses(ints / 2, floats, place);
        for (int k = 0; k < ints / 2; ++k) {
            cage_.creases.push_back({ends[2 * k].index, ends[2 * k + 1].index, s[k]});
            crease_places_.push_back(ends[2 * k].place);
        }
    }
    void corner(int ints, int floats, Place place) {
        std::vector<Index> at;
        for (int k = 0; k < ints; ++k) vertices_.push_back(at.emplace_back(tag_index("a vertex")));
        const auto s = sharpnesses(ints, floats, place);
        for (int k = 0; k < ints; ++k) cage_.corners.push_back({at[k].index, s[k]});
    }
    void holes(int ints) {
        for (int k = 0; k < ints; ++k) cage_.holes.push_back(holes_.emplace_back(tag_index("a face")).index);
    }
    void boundary() {
        const Place place = this->place();
        static constexpr Cage::Boundary kinds[] = {Cage::Boundary::none, Cage::Boundary::edge_and_corner, Cage::Boundary::edge_only};
        const int n = integer("0, 1 or 2");
        if (n < 0 || n > 2) fail(place, std::to_string(n), "0 (none), 1 (edge and corner) or 2 (edge only)");
        cage_.boundary = kinds[n];
    }

    // What could only be known once everything was read.
    void finish() const {
        const int vertices = static_cast<int>(cage_.positions.size()), faces = static_cast<int>(cage_.faces.size());
        const Place end{std::max(line(), 1), 1};
        if (vertices == 0) fail(end, "the end of the file without a vertex", "v statements");
        if (last_.index >= vertices)
            fail(last_.place, "the vertex index " + std::to_string(last_.index + 1), "1 to " + std::to_string(vertices));
        if (faces == 0) fail(end, "the end of the file without a face", "f statements");
        refuse_beyond(vertices_, vertices, "vertex");
        refuse_beyond(holes_, faces, "face");
        refuse_creases_off_edges();
    }
    void refuse_beyond(const std::vector<Index>& indices, int count, const std::string& what) const {
        for (const auto& [i, place] : indices)
            if (i >= count) fail(place, "the " + what + " " + std::to_string(i) + " in a tag", "0 to " + std::to_string(count - 1));
    }
    void refuse_creases_off_edges() const {
        if (cage_.creases.empty()) return;
        std::vector<std::pair<int, int>> edges;
        for (const auto& f : cage_.faces)
            for (std::size_t k = 0; k < f.size(); ++k) edges.push_back(std::minmax(f[k], f[(k + 1) % f.size()]));
        std::sort(edges.begin(), edges.end());
        for (std::size_t k = 0; k < cage_.creases.size(); ++k) {
            const auto& c = cage_.creases[k];
            if (!std::binary_search(edges.begin(), edges.end(), std::pair<int, int>(std::minmax(c.a, c.b))))
                fail(crease_places_[k], "a crease from vertex " + std::to_string(c.a) + " to " + std::to_string(c.b), "the ends of an edge of a face");
        }
    }

    Cage cage_;
    Index last_;                 // the largest vertex that a face named before it was read
    std::vector<Index> vertices_, holes_;
    std::vector<Place> crease_places_;
};

}  // namespace

Cage read_cage_obj(const std::string& text, const std::string& path) { return Reader(text, path).read(); }

}  // namespace isoparm
