// more_golden_test.cpp -- `eval --json` on the scenes of tests/data/more_golden.json against values computed from the formulas with 160
// digits by tests/data/make_more_golden.py: rational edges, formulas, splines, uneven nodes, parts.
#include "golden.h"

namespace isoparm::test {
namespace {

const Json::Value& more() {
    static const Json::Value root = read_golden("more_golden.json");
    return root;
}

class MoreGolden : public ::testing::TestWithParam<std::string> {};

TEST_P(MoreGolden, EvalTellsTheNumbersOfTheFormula) {
    const Json::Value& e = more()[GetParam()];
    std::vector<GoldenPoint> points;
    for (const auto& p : e["points"]) points.push_back({number(p["u"]), number(p["v"]), p});
    Json::StreamWriterBuilder b;
    b["precision"] = 17;
    expect_eval(Json::writeString(b, e["scene"]), points, e["size"].asDouble());
}

INSTANTIATE_TEST_SUITE_P(Surface, MoreGolden, ::testing::ValuesIn(more().getMemberNames()), [](const auto& info) { return info.param; });

}  // namespace
}  // namespace isoparm::test
