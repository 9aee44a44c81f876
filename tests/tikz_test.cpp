// tikz_test.cpp -- figures as TikZ: what is in them, and that TeX sets them as the PDF has them.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

#include "drawing/paper.h"
#include "printed.h"

namespace isoparm {
namespace {

using namespace test;

TEST(Tikz, HasNodesLinesAndTheRasterBesideIt) {
    const Printed p;
    const std::string tex = p.file("a.tex");
    EXPECT_NE(tex.find("\\includegraphics[width=57.6bp,height=43.2bp]{a-raster.png}"), std::string::npos);
    EXPECT_NE(tex.find("{$P_{00}$};"), std::string::npos);
    EXPECT_NE(tex.find("\\draw[line width=1bp,draw={rgb,255:red,255;green,0;blue,0}"), std::string::npos);
    EXPECT_EQ(std::count(tex.begin(), tex.end(), '{'), std::count(tex.begin(), tex.end(), '}'));
    EXPECT_TRUE(std::filesystem::exists(p.folder / "a-raster.png"));
}

TEST(Paper, MathTextBecomesTex) {
    for (const auto& [from, to] : {std::pair<std::string, std::string>{"P_{00}", "$P_{00}$"}, {"H_i^{(3)}(t)", "$H_{i}^{(3)}(t)$"}, {"Triangle $T_1$", "Triangle $T_{1}$"},
                                   {"\\alpha-\\Delta", "$\\alpha -\\Delta $"}, {"50% of $x_{i_j}$", "50\\% of $x_{i_{j}}$"}, {"\\mathbf{S}_u", "$\\mathbf{S}_{u}$"},
                                   {"\\hat{n}\\in\\mathbb{R}^3", "$\\hat{n}\\in \\mathbb{R}^{3}$"}, {"\\frac{u+1}{\\vec{x}}", "$(u+1)/\\vec{x}$"}, {"\\sqrt{2}", "$\\sqrt{2}$"}})
        EXPECT_EQ(tex_of(parse_math_text(from)), to);
}

/// Does a shell command succeed there?
bool works(const std::string& command, const std::string& folder) { return std::system(("cd '" + folder + "' && " + command + " > /dev/null 2>&1 < /dev/null").c_str()) == 0; }

struct Page {
    int width = 0, height = 0;
    std::string bytes;  // RGB
};
Page page_of(const TemporaryFolder& folder, const std::string& pdf) {
    EXPECT_TRUE(works("pdftoppm -r 150 -singlefile " + pdf + " page", folder.path()));
    std::istringstream in(read_all(folder / "page.ppm"));
    Page page;
    std::string magic;
    int most = 0;
    in >> magic >> page.width >> page.height >> most;
    in.get();
    page.bytes.assign(std::istreambuf_iterator<char>(in), {});
    return page;
}
/// Mean difference of the bytes; pages may be a pixel apart in size.
double difference(const Page& a, const Page& b) {
    EXPECT_LE(std::abs(a.width - b.width), 1);
    EXPECT_LE(std::abs(a.height - b.height), 1);
    const int width = std::min(a.width, b.width), height = std::min(a.height, b.height);
    double sum = 0;
    for (int y = 0; y < height; ++y)
        for (int k = 0; k < 3 * width; ++k) {
            const auto at = [&](const Page& p) { return static_cast<unsigned char>(p.bytes.at(static_cast<std::size_t>(3 * p.width * y + k))); };
            sum += std::abs(at(a) - at(b));
        }
    return sum / (3.0 * width * height);
}

TEST(Tikz, IsSetByTexAsThePdfHasIt) {
    if (!works("pdflatex --version && pdftoppm -v && kpsewhich tikz.sty", "/")) GTEST_SKIP() << "pdflatex with TikZ and pdftoppm are not installed";
    // An inset, an arrow, dashes, opacities, a title in prose; a name that TeX would take for commands.
    const Printed p(R"json({ "isoparm": 1, "surfaces": { "s": { "type": "bilinear", "points": [[[-1,-1,0],[-1,1,0]],[[1,-1,0],[1,1,0.8]]] } },
        "panels": [ { "title": "100% of $P_1 \\oplus P_2$", "objects": [ { "surface": "s", "color_by": "gaussian", "isolines": { "u": 5, "v": 5 }, "outline": { "dash": [4, 3] } },
                      { "arrow": { "surface": "s", "at": [0.5, 0.5], "along": "normal" }, "label": "n" }, { "point": [1,1,0.8], "dot": 6, "label": { "text": "P_{11}", "leader": true } } ],
                    "insets": [ { "around": [1,1,0.8], "place": "above left" }, { "camera": { "eye": [0,0,5], "target": [0,9,0], "fov": 5 }, "place": "center", "size": 0.3 } ] } ], "image": { "width": 600, "height": 450, "samples": 1 } })json");
    const std::string name = "50% #1_a b";
    ASSERT_EQ(p.refused("--quiet --threads 1 --width 50mm -o '" + name + ".tex'").code, 0);
    p.file("b.pdf", "--width 50mm");
    write_all(p.folder / "figure.tex", read_all(p.folder / (name + ".tex")));
    write_all(p.folder / "a.tex", "\\documentclass{article}\\usepackage{tikz,amsmath}\\begin{document}\\hoffset=-1in\\voffset=-1in\\setbox0\\hbox{\\input{figure}}"
                                  "\\pdfpagewidth=\\wd0\\pdfpageheight=\\ht0\\shipout\\box0\\end{document}");
    ASSERT_TRUE(works("pdflatex -interaction=batchmode -halt-on-error a.tex", p.folder.path())) << read_all(p.folder / "a.log");
    const Page set = page_of(p.folder, "a.pdf"), ours = page_of(p.folder, "b.pdf");
    Page turned = ours;
    std::reverse(turned.bytes.begin(), turned.bytes.end());
    const auto middle = [](const Page& page) {  // of the empty inset that lies over all lines, all but its frame
        double dark = 0;
        for (int y = page.height * 35 / 100; y < page.height * 55 / 100; ++y)
            for (int x = page.width * 2 / 5; x < page.width * 3 / 5; ++x) dark += 255 - static_cast<unsigned char>(page.bytes.at(static_cast<std::size_t>(3 * (page.width * y + x))));
        return dark;
    };
    EXPECT_EQ(middle(ours), 0);
    EXPECT_EQ(middle(set), 0) << "what is under a frame is not seen";
    EXPECT_LT(difference(set, ours), 4) << "only the letters are of another font";
    EXPECT_GT(difference(set, turned), 15) << "which is much less than between other pictures";
}

}  // namespace
}  // namespace isoparm
