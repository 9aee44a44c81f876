#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

#include "drawing/paper.h"
#include "drawing/text_cairo.h"
#include "html_text.h"
#include "picture/palette.h"

namespace isoparm {
namespace {

constexpr const char* kFamilies = "STIXGeneral, 'STIX Two Text', 'Times New Roman', 'Liberation Serif', serif";

std::string formatted(const char* format, ...) {
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    return text;
}

std::string color_of(const Color& c) {
    return formatted("#%02x%02x%02x", srgb_byte(c.x), srgb_byte(c.y), srgb_byte(c.z));
}
std::string with_opacity(const char* what, double opacity) { return opacity >= 1 ? "" : formatted(" %s=\"%s\"", what, decimal(opacity).c_str()); }
std::string path_of(const std::vector<Vec2>& points) {
    std::string d;
    for (const Vec2& p : points) d += (d.empty() ? "M" : "L") + decimal(p.x, "%.2f") + " " + decimal(p.y, "%.2f");
    return d;
}

void add(const Polyline& line, const DrawingItem& item, bool, std::string& out) {
    std::string dash;
    for (const double d : line.dash) dash += (dash.empty() ? "" : " ") + decimal(d);
    std::string d = path_of(line.points);
    for (const auto& other : line.more) d += path_of(other);
    out += "<path d=\"" + d + "\" fill=\"none\" stroke=\"" + color_of(item.color) + "\" stroke-width=\"" + decimal(line.width) + "\" stroke-linecap=\"" +
           (line.round ? "round" : "butt") + "\" stroke-linejoin=\"round\"" + (dash.empty() ? "" : " stroke-dasharray=\"" + dash + "\"") +
           with_opacity("stroke-opacity", item.opacity) + "/>\n";
}
void add(const Filled& area, const DrawingItem& item, bool, std::string& out) {
    out += "<path d=\"" + path_of(area.outline) + "Z\" fill=\"" + color_of(item.color) + "\"" + with_opacity("fill-opacity", item.opacity) + "/>\n";
}

std::string halo_of(const Text& text, double opacity) {
    if (!(text.halo > 0)) return "";
    return " stroke=\"" + color_of(text.rim) + "\" stroke-width=\"" + decimal(2 * text.halo) + "\" stroke-linejoin=\"round\" paint-order=\"stroke\"" + with_opacity("stroke-opacity", printed_halo(opacity));
}
std::string anchor_of(const Text& text) {
    return text.anchor ? " data-anchor=\"" + decimal(text.anchor->x) + " " + decimal(text.anchor->y) + "\"" : "";
}
void add(const Text& text, const DrawingItem& item, bool outlines, std::string& out) {
    const std::string look = anchor_of(text) + " fill=\"" + color_of(item.color) + "\"" + with_opacity("fill-opacity", item.opacity) + halo_of(text, item.opacity);
    if (outlines) {
        std::string plain;
        for (const TextRun& run : text.text) plain += run.text;
        out += "<path aria-label=\"" + escaped(plain) + "\"" + look + " d=\"" + outline_path(text) + "\"/>\n";
        return;
    }
    const std::string place = decimal(text.at.x) + (text.turned ? " " : ",") + decimal(text.at.y);
    out += "<text transform=\"translate(" + place + ")" + (text.turned ? " rotate(-90)" : "") + "\"" + look + ">";
    const PlacedText placed = placed_text(text.text, text.size);
    for (const PlacedRun& r : placed.runs) {
        out += "<tspan x=\"" + decimal(r.x) + "\" y=\"" + decimal(r.y) + "\" font-size=\"" + decimal(text.size * r.scale) + "\"" + (r.run->italic ? " font-style=\"italic\"" : "") +
               (r.run->bold ? " font-weight=\"bold\"" : "") + ">" + escaped(r.run->text) + "</tspan>";
    }
    out += "</text>\n";
    for (const TextBox& b : placed.bars)
        out += "<path transform=\"translate(" + place + ")" + (text.turned ? " rotate(-90)" : "") + "\" fill=\"" + color_of(item.color) + "\"" + with_opacity("fill-opacity", item.opacity) + " d=\"" +
               path_of({{b.left, b.top}, {b.right, b.top}, {b.right, b.bottom}, {b.left, b.bottom}}) + "Z\"/>\n";
}

}  // namespace

std::string svg_text(const PaperFigure& figure) {
    const int width = figure.raster.width, height = figure.raster.height;
    const double millimetres = 25.4 / 72 / figure.pixels_per_point;
    std::string out = formatted(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" xmlns:xlink=\"http://www.w3.org/1999/xlink\" width=\"%smm\" height=\"%smm\" "
        "viewBox=\"0 0 %d %d\">\n",
        decimal(width * millimetres).c_str(), decimal(height * millimetres).c_str(), width, height);
    out += "<title>" + escaped(figure.title) + "</title>\n";
    out += formatted("<image width=\"%d\" height=\"%d\" preserveAspectRatio=\"none\" xlink:href=\"data:image/png;base64,", width, height) + base64(png_bytes(figure.raster)) + "\"/>\n";
    for (std::size_t i = 0; i < figure.parts.size(); ++i) {
        const DrawnPart& part = figure.parts[i];
        if (part.drawing.empty()) continue;
        const int n = static_cast<int>(i);
        std::string clip = formatted("M0 0H%dV%dH0Z", part.width, part.height);
        for (const auto& [x, y, w, h] : part.holes) clip += formatted("M%d %dv%dh%dv%dZ", x, y, h, w, -h);  // the other way round
        out += part.holes.empty() ? formatted("<clipPath id=\"part%d\"><rect width=\"%d\" height=\"%d\"/></clipPath>\n", n, part.width, part.height)
                                  : formatted("<clipPath id=\"part%d\"><path d=\"", n) + clip + "\"/></clipPath>\n";
        out += formatted("<g transform=\"translate(%d,%d)\"><g clip-path=\"url(#part%d)\" font-family=\"%s\" xml:space=\"preserve\">\n", part.x, part.y, n, kFamilies);
        for (const DrawingItem& item : part.drawing)
            std::visit([&](const auto& shape) { add(shape, item, figure.outlines, out); }, item.shape);
        out += "</g></g>\n";
    }
    return out + "</svg>\n";
}

}  // namespace isoparm
