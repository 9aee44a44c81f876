#include "io/bv.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>

#include "error.h"
#include "patches/bezier_triangle.h"
#include "patches/tensor_bezier.h"
#include "piecewise_bezier.h"

namespace isoparm {

namespace {

class BvReader {
public:
    BvReader(const std::string& text, const std::string& path) : text_(text), path_(path), group_(std::filesystem::path(path).stem().string()) {}

    Composite run() {
        for (read(); !token_.empty(); read()) {
            if (token_ == "Group" || token_ == "group" || token_ == "GROUP") read_group();
            else read_record();
        }
        if (result_.empty()) fail("at least one patch");
        return std::move(result_);
    }

private:
    // ---- tokens
    void read() {
        at_ = std::min(text_.find_first_not_of(" \t\r\n\f\v", end_), text_.size());
        end_ = std::min(text_.find_first_of(" \t\r\n\f\v", at_), text_.size());
        token_ = std::string_view(text_).substr(at_, end_ - at_);
    }
    [[noreturn]] void fail(const std::string& expected) const {
        std::size_t line = 1, start = 0;
        for (std::size_t i = 0; i < at_; ++i)
            if (text_[i] == '\n') ++line, start = i + 1;
        std::string found = token_.empty() ? "the end of the file" : "'" + std::string(token_.substr(0, 40)) + "'";
        for (char& c : found)
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
        throw_input(path_ + ":" + std::to_string(line) + ":" + std::to_string(at_ - start + 1) + ": found " + found + ", expected " + expected);
    }
    // What it is for is put into words only when it is missing: most of a file is numbers.
    template <class What> double number(What what) {
        read();
        std::string_view t = token_;
        if (t.size() > 1 && t[0] == '+' && t[1] != '-') t.remove_prefix(1);
        double x = 0;
        const auto [end, error] = std::from_chars(t.data(), t.data() + t.size(), x);
        if (t.empty() || error != std::errc() || end != t.data() + t.size() || !std::isfinite(x)) fail(what() + ", a finite number");
        return x;
    }
    int degree(const std::string& what) {
        const std::string expected = what + " of patch " + std::to_string(result_.size()) + ", a whole number from 1 to " + std::to_string(max_degree);
        read();
        int n = 0;
        const auto [end, error] = std::from_chars(token_.data(), token_.data() + token_.size(), n);
        if (token_.empty() || error != std::errc() || end != token_.data() + token_.size() || n < 1 || n > max_degree) fail(expected);
        return n;
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
        read();
        int colour = 0;
        const auto [end, error] = std::from_chars(token_.data(), token_.data() + token_.size(), colour);
        if (token_.empty() || error != std::errc() || end != token_.data() + token_.size()) fail("the colour of the group, a whole number");
        read();
        if (token_.empty()) fail("the name of the group");
        group_ = std::string(token_);
    }
    void read_record() {
        const std::string kinds = "the kind of a patch (3, 4, 5 or 8) or Group";
        if (token_ == "3") return triangle();
        if (token_ == "4") {
            const int d = degree("the degree");
            return tensor(d, d, false);
        }
        if (token_ == "5" || token_ == "8") {
            const bool rational = token_ == "8";
            const int du = degree("the degree in u"), dv = degree("the degree in v");
            return tensor(du, dv, rational);
        }
        static constexpr std::pair<const char*, const char*> refused[] = {
            {"1", "a polyhedron has no curved surface"}, {"6", "kind 6, trimmed patches, is not supported"},
            {"7", "kind 7, B-splines, is not supported"}, {"9", "kind 9, PN triangles, is not supported"},
            {"10", "kind 10, PN quads, is not supported"}};
        for (const auto& [kind, why] : refused)
            if (token_ == kind) fail(kinds + "; " + why);
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

    const std::string& text_;
    const std::string& path_;
    std::string group_;
    std::map<std::string, int> in_group_;
    std::size_t at_ = 0, end_ = 0;
    std::string_view token_;
    Composite result_;
};

}  // namespace

Composite read_bv(const std::string& text, const std::string& path) { return BvReader(text, path).run(); }

}  // namespace isoparm
