#include <algorithm>
#include <cmath>
#include <cstdio>

#include "drawing/paper.h"
#include "drawing/text_cairo.h"
#include "isoparm_version.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

std::string color_of(const Color& c) {
    const auto byte = [](double x) { return std::to_string(srgb_byte(x)); };
    return "{rgb,255:red," + byte(c.x) + ";green," + byte(c.y) + ";blue," + byte(c.z) + "}";
}

class Writer {
public:
    explicit Writer(const PaperFigure& figure) : figure_(figure) {}

    std::string run(const std::string& raster) {
        const int width = figure_.raster.width, height = figure_.raster.height;
        out_ = "% Made by isoparm " ISOPARM_VERSION ". \\input it where the packages tikz and amsmath are loaded; " + raster + " lies beside it.\n";
        out_ += "\\begin{tikzpicture}[x=1bp,y=-1bp,line cap=round,line join=round]\n";
        out_ += "\\useasboundingbox (0,0) rectangle " + at({double(width), double(height)}) + ";\n";
        out_ += "\\node[inner sep=0pt,outer sep=0pt,anchor=north west] at (0,0) {\\includegraphics[width=" + in_points(width) + ",height=" + in_points(height) + "]{" + raster + "}};\n";
        for (const DrawnPart& part : figure_.parts) add(part);
        return out_ + "\\end{tikzpicture}%\n";
    }

private:
    std::string in_points(double pixels) const { return decimal(pixels / figure_.pixels_per_point) + "bp"; }
    /// In points: numbers of TeX end at 16383.
    std::string at(const Vec2& p) const { return "(" + decimal(p.x / figure_.pixels_per_point) + "," + decimal(p.y / figure_.pixels_per_point) + ")"; }
    static std::string opacity(const DrawingItem& item) { return item.opacity < 1 ? ",opacity=" + decimal(item.opacity) : ""; }

    /// A rectangle, to the right first or downward first.
    std::string corners(double x, double y, double w, double h, bool right) const {
        return at({x, y}) + " -- " + at(right ? Vec2{x + w, y} : Vec2{x, y + h}) + " -- " + at({x + w, y + h}) + " -- " + at(right ? Vec2{x, y + h} : Vec2{x + w, y}) + " -- cycle";
    }
    void add(const DrawnPart& part) {
        if (part.drawing.empty()) return;
        out_ += "\\begin{scope}[shift={" + at({double(part.x), double(part.y)}) + "}]\n\\clip " + corners(0, 0, part.width, part.height, true);
        // The other way round: not seen there.
        for (const auto& [x, y, w, h] : part.holes) out_ += " " + corners(x, y, w, h, false);
        out_ += ";\n";
        for (const DrawingItem& item : part.drawing)
            std::visit([&](const auto& shape) { add(shape, item); }, item.shape);
        out_ += "\\end{scope}\n";
    }
    void path(const std::vector<Vec2>& points) {
        for (std::size_t i = 0; i < points.size(); ++i) out_ += (i == 0 ? " " : i % 8 == 0 ? "\n  -- " : " -- ") + at(points[i]);
    }
    void add(const Polyline& line, const DrawingItem& item) {
        out_ += "\\draw[line width=" + in_points(line.width) + ",draw=" + color_of(item.color) + opacity(item) + (line.round ? "" : ",line cap=butt");
        if (!line.dash.empty()) {
            out_ += ",dash pattern=";
            for (std::size_t k = 0; k < line.dash.size() * (1 + line.dash.size() % 2); ++k)
                out_ += std::string(k > 0 ? " " : "") + (k % 2 == 0 ? "on " : "off ") + in_points(line.dash[k % line.dash.size()]);
        }
        out_ += "]";
        path(line.points);
        for (const auto& other : line.more) path(other);
        out_ += ";\n";
    }
    void add(const Filled& area, const DrawingItem& item) {
        out_ += "\\fill[fill=" + color_of(item.color) + opacity(item) + "]";
        path(area.outline);
        out_ += " -- cycle;\n";
    }
    /// Where isoparm's own letters would be.
    void add(const Text& text, const DrawingItem& item) {
        const TextBox box = text_box(text.text, text.size);
        // A label keeps the side that faces what it names: the document's letters may be wider.
        const double left = text.at.x + box.left, right = text.at.x + box.right;
        const bool beside = text.anchor && !text.turned;
        const char* anchor = beside && left >= text.anchor->x ? "base west" : beside && right <= text.anchor->x ? "base east" : "base";
        const double middle = anchor[4] == 0 ? 0.5 * (box.left + box.right) : anchor[5] == 'w' ? box.left : box.right;
        const Vec2 base = text.turned ? Vec2{text.at.x, text.at.y - middle} : Vec2{text.at.x + middle, text.at.y};
        const double points = text.size / figure_.pixels_per_point;
        out_ += "\\node[inner sep=0pt,outer sep=0pt,anchor=" + std::string(anchor) + std::string(text.turned ? ",rotate=90" : "") + ",text=" + color_of(item.color) + opacity(item) + ",font=\\fontsize{" +
                decimal(points, "%.2f") + "bp}{" + decimal(1.2 * points, "%.2f") + "bp}\\selectfont] at " + at(base) + " {" + tex_of(text.text) + "};\n";
    }

    const PaperFigure& figure_;
    std::string out_;
};

}  // namespace

std::string tikz_text(const PaperFigure& figure, const std::string& raster) { return Writer(figure).run(raster); }

}  // namespace isoparm
