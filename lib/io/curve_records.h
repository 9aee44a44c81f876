// io/curve_records.h -- what readers of curve files share: counts that a hostile file cannot make large, knots, poles.
#pragma once
#include "curves/bspline.h"
#include "curves/piecewise_bezier.h"
#include "io/curve_file.h"
#include "io/token_reader.h"

namespace isoparm {

class CurveRecords {
public:
    CurveRecords(const std::string& text, const std::string& path) : in(text, path) {}

protected:
    static constexpr int kMostCurves = 10'000, kMostPoles = 10'000, kMostPolesOfAll = 100'000;

    /// "the degree of curve 3"
    std::string of_curve(const char* what) const { return std::string(what) + " of curve " + std::to_string(curves.size()); }
    int integer(const char* what, int low, int high) {
        return in.integer([&] { return of_curve(what); }, low, high);
    }
    double number(const char* what) {
        return in.number([&] { return of_curve(what); });
    }
    Point point(const char* what) {
        return in.point([&] { return of_curve(what); });
    }
    int pole_count(int least) {
        const int n = integer("the number of poles", least, kMostPoles);
        if ((poles_ += n) > kMostPolesOfAll) in.fail("at most " + std::to_string(kMostPolesOfAll) + " poles in one file");
        return n;
    }
    /// What the library finds wrong with a curve gets the place where its record begins.
    template <class Make> Curve made(std::size_t place, Make make) const {
        try {
            return make();
        } catch (const Error& e) {
            in.fail_at(place, "curve " + std::to_string(curves.size()) + ", which is none", std::string("other data: ") + e.what());
        }
    }

    TokenReader in;
    std::vector<FileCurve> curves;

private:
    int poles_ = 0;
};

}  // namespace isoparm
