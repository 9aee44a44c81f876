#include <algorithm>
#include <iterator>

#include "io/mesh_scanner.h"

namespace isoparm {
namespace {

class ObjReader {
public:
    ObjReader(const std::string& bytes, const std::string& path) : in_(bytes, path) { file_.format = "OBJ"; }

    MeshFile run() {
        do {
            const std::string_view word = in_.word_on_line();
            if (word == "v") vertex();
            else if (word == "f") face();
            else if (!word.empty() && !passed_over(word)) in_.fail_word(word, "a statement of a polygon mesh: v, vt, vn, f, g, o, s, usemtl, mtllib, l, p");
        } while (in_.next_line());
        return std::move(file_);
    }

private:
    static bool passed_over(std::string_view word) {
        static constexpr std::string_view kWords[] = {"vt", "vn", "vp", "g", "o", "s", "usemtl", "mtllib", "usemap", "maplib", "l", "p", "t",
                                                      "lod", "bevel", "c_interp", "d_interp", "shadow_obj", "trace_obj", "mg"};
        return std::find(std::begin(kWords), std::end(kWords), word) != std::end(kWords);
    }
    /// x y z; a weight or a colour behind them tells nothing about where the vertex is.
    void vertex() {
        double x[3];
        for (double& c : x) c = in_.number(in_.word_on_line(), "a coordinate");
        if (file_.mesh.points.size() == kMostElements) in_.fail("one more vertex", "at most " + std::to_string(kMostElements));
        file_.mesh.points.push_back({x[0], x[1], x[2]});
    }
    void face() {
        corners_.clear();
        for (std::string_view word = in_.word_on_line(); !word.empty(); word = in_.word_on_line()) corners_.push_back(index(word));
        if (corners_.size() < 3) in_.fail("a face of " + std::to_string(corners_.size()) + " vertices", "at least 3");
        add_polygon(file_, corners_);
    }
    /// v, v/vt, v//vn or v/vt/vn; negative ones count back from the last vertex.
    std::uint32_t index(std::string_view word) const {
        const auto count = static_cast<long long>(file_.mesh.points.size());
        const std::string_view digits = word.substr(0, word.find('/'));
        if (word.find_first_not_of("0123456789/+-") != word.npos || digits.empty()) in_.fail_word(word, "a vertex index as in v, v/vt, v//vn or v/vt/vn");
        const long long i = in_.integer(digits, "a vertex index as in v, v/vt, v//vn or v/vt/vn");
        if (i == 0 || i > count || i < -count)
            in_.fail("the vertex index " + std::to_string(i),
                     count == 0 ? "vertices before the first face" : "1 to " + std::to_string(count) + ", or -1 to -" + std::to_string(count) + " counted back from the last vertex");
        return static_cast<std::uint32_t>(i < 0 ? count + i : i - 1);
    }

    TextScanner in_;
    MeshFile file_;
    std::vector<std::uint32_t> corners_;
};

}  // namespace

MeshFile read_obj(const std::string& bytes, const std::string& path) { return ObjReader(bytes, path).run(); }

}  // namespace isoparm
