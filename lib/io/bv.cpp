#include "io/bv.h"

#include <filesystem>
#include <limits>
#include <map>

#include "curves/piecewise_bezier.h"
#include "io/token_reader.h"
#include "patches/bezier_triangle.h"
#include "patches/tensor_bezier.h"

namespace isoparm {

namespace {

class BvReader {
public:
    BvReader(const std::string& text, const std::string& path) : in_(text, path), group_(std::filesystem::path(path).stem().string()) {}

    Composite run() {
        while (!in_.read().empty()) {
            const std::string_view word = in_.token();
            if (word == "Group" || word == "group" || word == "GROUP") read_group();
            else read_record();
        }
        if (result_.empty()) fail("at least one patch");
        return std::move(result_);
    }

private:
    template <class What> double number(What what) { return in_.number(what); }
    [[noreturn]] void fail(const std::string& expected) const { in_.fail(expected); }
    int degree(const std::string& what) {
        return in_.integer([&] { return what + " of patch " + std::to_string(result_.size()); }, 1, max_degree);
    }
    Point point(int k, double* weight = nullptr) {
        static constexpr const char* names[] = {"x", "y", "z", "weight"};
        static constexpr const char* weighted[] = {"weight times x", "weight times y", "weight times z", "weight"};
        const auto coordinate = [&](int i) {
            return number([&] {
                return std::string("the ") + (weight ? weighted : names)[i] + " of control point " + std::to_string(k) + " of patch " + std::to_string(result_.size());
            });
        };
        Point p;
        for (int i = 0; i < 3; ++i) p[i] = coordinate(i);
        if (!weight) return p;
        *weight = coordinate(3);
        if (!(*weight > 0)) fail("a positive weight of control point " + std::to_string(k) + " of patch " + std::to_string(result_.size()));
        p = p / *weight;
        if (!finite(p)) fail("a weight that is not tiny beside its point, of control point " + std::to_string(k) + " of patch " + std::to_string(result_.size()));
        return p;
    }

    // ---- records
    void read_group() {
        constexpr int most = std::numeric_limits<int>::max();
        in_.integer([] { return std::string("the colour of the group"); }, -most - 1, most);
        if (in_.read().empty()) fail("the name of the group");
        group_ = std::string(in_.token());
    }
    void read_record() {
        const std::string_view word = in_.token();
        const std::string kinds = "the kind of a patch (3, 4, 5 or 8) or Group";
        if (word == "3") return triangle();
        if (word == "4") {
            const int d = degree("the degree");
            return tensor(d, d, false);
        }
        if (word == "5" || word == "8") {
            const bool rational = word == "8";
            const int du = degree("the degree in u"), dv = degree("the degree in v");
            return tensor(du, dv, rational);
        }
        static constexpr std::pair<const char*, const char*> refused[] = {
            {"1", "a polyhedron has no curved surface"}, {"6", "kind 6, trimmed patches, is not supported"},
            {"7", "kind 7, B-splines, is not supported"}, {"9", "kind 9, PN triangles, is not supported"},
            {"10", "kind 10, PN quads, is not supported"}};
        for (const auto& [kind, why] : refused)
            if (word == kind) fail(kinds + "; " + why);
        fail(kinds);
    }
    void tensor(int du, int dv, bool rational) {
        Grid<Point> points(du + 1, std::vector<Point>(dv + 1));
        Grid<double> weights;
        if (rational) weights.assign(du + 1, std::vector<double>(dv + 1));
        for (int i = 0, k = 0; i <= du; ++i)
            for (int j = 0; j <= dv; ++j, ++k) points[i][j] = point(k, rational ? &weights[i][j] : nullptr);
        add(make_bezier_patch(points, weights));
    }
    void triangle() {
        const int d = degree("the degree");
        std::vector<Point> points;
        for (int k = 0; k < (d + 1) * (d + 2) / 2; ++k) points.push_back(point(k));
        add(make_bezier_triangle(d, points));
    }
    void add(Patch patch) { result_.push_back({group_ + "#" + std::to_string(in_group_[group_]++), std::move(patch)}); }

    TokenReader in_;
    std::string group_;
    std::map<std::string, int> in_group_;
    Composite result_;
};

}  // namespace

Composite read_bv(const std::string& text, const std::string& path) { return BvReader(text, path).run(); }

}  // namespace isoparm
